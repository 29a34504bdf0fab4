#include "foam/power_diagram.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Fixed_alpha_shape_3.h>
#include <CGAL/Fixed_alpha_shape_cell_base_3.h>
#include <CGAL/Fixed_alpha_shape_vertex_base_3.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "foam/ball_checks.h"
#include "foam/cell_sums.h"
#include "foam/film_polygon.h"
#include "foam/overlap_pairs.h"

namespace spume::foam {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase =
    CGAL::Triangulation_vertex_base_with_info_3<std::int32_t, Kernel,
                                                CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
using AlphaVertex = CGAL::Fixed_alpha_shape_vertex_base_3<Kernel, VertexBase>;
using AlphaCell =
    CGAL::Fixed_alpha_shape_cell_base_3<Kernel, CGAL::Regular_triangulation_cell_base_3<Kernel>>;
using Triangulation =
    CGAL::Regular_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<AlphaVertex, AlphaCell>>;
using AlphaShape = CGAL::Fixed_alpha_shape_3<Triangulation>;
using Vertex = Triangulation::Vertex_handle;
using Real = FilmPolygon::Real;
using Point = FilmPolygon::Point;

/// Guard sites have indices below 0, each its own.
constexpr bool isGuard(std::int32_t index) { return index < 0; }

/// Distance of the guard sites in sizes of the inflated foam: their planes stay clear of every ball, the
/// numbers stay small.
constexpr double kGuardDistance = 16;

/// Sequential on purpose: parallel insertion of weighted points has a race in CGAL 5.5. Four far guard sites
/// keep the triangulation three-dimensional, where alpha shapes of fewer than 4 or of coplanar sites are
/// silently wrong.
Triangulation triangulate(const std::vector<Eigen::Vector3d>& position,
                          const std::vector<TieBrokenBall>& ball, double alpha) {
  std::vector<std::pair<Triangulation::Weighted_point, std::int32_t>> sites;
  Eigen::Vector3d low = position.front(), high = position.front();
  double largest = 0;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Eigen::Vector3d& x = position[i];
    sites.emplace_back(Triangulation::Weighted_point({x.x(), x.y(), x.z()}, ball[i].radius * ball[i].radius),
                       i);
    low = low.cwiseMin(x), high = high.cwiseMax(x);
    largest = std::max(largest, std::sqrt(ball[i].radius * ball[i].radius + alpha));
  }
  const Eigen::Vector3d centre = (low + high) / 2;
  const double far = kGuardDistance * ((high - low).norm() + 2 * largest);
  std::int32_t guard = 0;
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, -1, -1),
                                        Eigen::Vector3d(-1, 1, -1), Eigen::Vector3d(-1, -1, 1)}) {
    const Eigen::Vector3d x = centre + far * corner;
    sites.emplace_back(Triangulation::Weighted_point({x.x(), x.y(), x.z()}, 0), --guard);
  }
  return Triangulation(sites.begin(), sites.end());
}

std::vector<TieBrokenBall> tieBroken(const std::vector<double>& radius,
                                     const std::vector<std::uint64_t>& id) {
  std::vector<TieBrokenBall> ball;
  for (std::size_t i = 0; i < radius.size(); ++i) ball.emplace_back(radius[i], id[i]);
  return ball;
}

Point relative(const Triangulation::Weighted_point& to, const Triangulation::Weighted_point& from) {
  return {Real(to.x()) - Real(from.x()), Real(to.y()) - Real(from.y()), Real(to.z()) - Real(from.z())};
}

/// The corner of the power diagram dual to a cell, relative to `origin`'s site: the point of equal power to
/// all four sites.
Point dualCorner(Triangulation::Cell_handle cell, Vertex origin) {
  Eigen::Matrix<Real, 3, 3> planes;
  Point offset;
  std::array<Vertex, 3> others;
  for (int k = 0, row = 0; k < 4; ++k)
    if (cell->vertex(k) != origin) others[row++] = cell->vertex(k);
  std::sort(others.begin(), others.end(), [](Vertex a, Vertex b) { return a->info() < b->info(); });
  for (int row = 0; row < 3; ++row) {
    const Triangulation::Weighted_point& site = others[row]->point();
    const Point to = relative(site, origin->point());
    planes.row(row) = to;
    offset[row] = (to.squaredNorm() + Real(origin->point().weight()) - Real(site.weight())) / 2;
  }
  return planes.inverse() * offset;
}

/// The vertex that cell and its successor around the edge (a, b) share beside a and b.
Vertex thirdVertex(Triangulation::Cell_handle cell, Triangulation::Cell_handle next, Vertex a, Vertex b) {
  for (int k = 0; k < 4; ++k) {
    const Vertex v = cell->vertex(k);
    if (v != a && v != b && next->has_vertex(v)) return v;
  }
  return {};
}

/// An edge from its bubble with the lower index.
struct OrientedEdge {
  Vertex a, b;
  Triangulation::Cell_handle cell;

  explicit OrientedEdge(const Triangulation::Edge& edge)
      : a(edge.first->vertex(edge.second)), b(edge.first->vertex(edge.third)), cell(edge.first) {
    if (a->info() > b->info()) std::swap(a, b);
  }
  bool hasGuard() const { return isGuard(a->info()); }
  bool operator<(const OrientedEdge& other) const {
    return std::pair(a->info(), b->info()) < std::pair(other.a->info(), other.b->info());
  }
};

/// Those between bubbles, sorted: CGAL lists edges, and turns around them from a cell, as their addresses
/// have it, and sums would depend on those.
std::vector<OrientedEdge> edgesOf(const AlphaShape& shape) {
  std::vector<OrientedEdge> edges;
  for (auto edge = shape.finite_edges_begin(); edge != shape.finite_edges_end(); ++edge)
    if (const OrientedEdge oriented(*edge); !oriented.hasGuard()) edges.push_back(oriented);
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Goes along all edges of the triangulation and collects what touches the cells at their ends.
class DiagramMeasure {
 public:
  DiagramMeasure(const AlphaShape& shape, const std::vector<TieBrokenBall>& ball)
      : shape_(shape), ball_(ball) {
    for (const TieBrokenBall& each : ball) cells_.emplace_back(each);
  }

  void addEdge(const OrientedEdge& edge) {
    const std::int32_t i = edge.a->info(), j = edge.b->info();
    const double d = static_cast<double>(relative(edge.b->point(), edge.a->point()).norm());
    const double height = radicalHeight(ball_[i], ball_[j], d), other = radicalHeight(ball_[j], ball_[i], d);
    cells_[i].addPlane(height);
    cells_[j].addPlane(other);
    const int a = edge.cell->index(edge.a), b = edge.cell->index(edge.b);
    if (shape_.classify({edge.cell, a, b}) == AlphaShape::EXTERIOR) return;
    const FilmShape film = measure(edge.a, edge.b, shape_.incident_cells(edge.cell, a, b));
    const double shift = radicalHeightShift(ball_[i], ball_[j], d);
    cells_[i].addFilm(film, height, shift, film.solidNear);
    cells_[j].addFilm(film, other, -shift, film.solidFar);
    films_.push_back({i, j, d, height + shift, film.trueArea()});
  }

  void write(const Triangulation& diagram, FoamTopology& out) {
    const std::size_t n = ball_.size();
    out.volume.assign(n, 0), out.freeArea.assign(n, 0), out.filmArea.assign(n, 0), out.hidden.assign(n, 1);
    for (const auto& vertex : diagram.finite_vertex_handles()) {
      const std::int32_t i = vertex->info();
      if (isGuard(i) || cells_[i].hidden()) continue;
      out.hidden[i] = 0;
      out.volume[i] = cells_[i].volume();
      out.freeArea[i] = cells_[i].freeArea();
      out.filmArea[i] = cells_[i].filmArea();
    }
    std::sort(films_.begin(), films_.end(),
              [](const Film& a, const Film& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); });
    out.films = std::move(films_);
  }

 private:
  /// `cell` turns around the edge from a to b.
  FilmShape measure(Vertex a, Vertex b, Triangulation::Cell_circulator cell) const {
    const auto& ballA = ball_[a->info()];
    FilmPolygon polygon(ballA, ball_[b->info()], relative(b->point(), a->point()));
    const auto next = [](Triangulation::Cell_circulator of) { return ++of; };
    const auto indexAt = [&](Triangulation::Cell_circulator at) {
      return thirdVertex(at, next(at), a, b)->info();
    };
    auto first = cell;
    for (auto at = next(cell); at != cell; ++at)
      if (indexAt(at) < indexAt(first)) first = at;
    cell = first;
    do {
      const Vertex third = thirdVertex(cell, next(cell), a, b);
      const Point site = relative(third->point(), a->point());
      const double shift = isGuard(third->info()) ? 0
                                                  : radicalHeightShift(ballA, ball_[third->info()],
                                                                       static_cast<double>(site.norm()));
      polygon.addCorner(dualCorner(cell, a), site, shift);
    } while (++cell != first);
    return polygon.integrate();
  }

  const AlphaShape& shape_;
  const std::vector<TieBrokenBall>& ball_;
  std::vector<CellSums> cells_;
  std::vector<Film> films_;
};

/// Lists the overlapping pairs and joins them with the films; both are sorted.
void listOverlaps(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                  const std::vector<TieBrokenBall>& ball, FoamTopology& out) {
  OverlapPairs near;
  near.update(position, radius);
  out.overlaps.clear();
  std::int32_t film = 0;
  for (std::int32_t i = 0; i < near.size(); ++i) {
    const std::int32_t s = near.rank()[i];
    for (std::int32_t slot = near.rowStart()[s]; slot < near.rowStart()[s + 1]; ++slot) {
      const std::int32_t j = near.order()[near.candidate()[slot]];
      const double d = (position[j] - position[i]).norm();
      if (j < i || d >= ball[i].radius + ball[j].radius) continue;
      const bool isFilm = film < static_cast<std::int32_t>(out.films.size()) && out.films[film].i == i &&
                          out.films[film].j == j;
      out.overlaps.push_back({i, j, d, isFilm ? film++ : -1});
    }
  }
}

}  // namespace

void PowerDiagram::compute(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                           const std::vector<std::uint64_t>& id, FoamTopology& out) {
  checkBalls("PowerDiagram", position, radius, id);
  out = {};
  if (position.empty()) return;
  const std::vector<TieBrokenBall> ball = tieBroken(radius, id);
  Triangulation diagram = triangulate(position, ball, 0);
  const AlphaShape shape(diagram, 0);  // takes the triangulation over
  DiagramMeasure measure(shape, ball);
  for (const OrientedEdge& edge : edgesOf(shape)) measure.addEdge(edge);
  measure.write(shape, out);
  listOverlaps(position, radius, ball, out);
}

std::vector<std::pair<std::int32_t, std::int32_t>> alphaComplexEdges(
    const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
    const std::vector<std::uint64_t>& id, double alpha) {
  checkBalls("alphaComplexEdges", position, radius, id);
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  if (position.empty()) return pairs;
  const bool all = std::isinf(alpha);
  Triangulation diagram = triangulate(position, tieBroken(radius, id), all ? 0 : alpha);
  const AlphaShape shape(diagram, all ? 0 : alpha);  // takes the triangulation over
  for (auto edge = shape.finite_edges_begin(); edge != shape.finite_edges_end(); ++edge) {
    const std::int32_t i = edge->first->vertex(edge->second)->info(),
                       j = edge->first->vertex(edge->third)->info();
    if (isGuard(i) || isGuard(j) || (!all && shape.classify(*edge) == AlphaShape::EXTERIOR)) continue;
    pairs.push_back(std::minmax(i, j));
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace spume::foam
