#include "foam/film_network.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_map>

namespace spume::foam {
namespace {

using Eigen::Vector3d;

constexpr double kArcSide = std::numbers::pi / 6;  ///< angle of an arc that counts as one side
/// Gap over the disc's radius below which two edges meet in a corner: round-off of where lines cross.
constexpr double kSameCorner = 1e-7;

template <std::size_t N>
struct HashOfBubbles {
  std::size_t operator()(const std::array<std::int32_t, N>& bubbles) const {
    std::size_t hash = 0;
    for (const std::int32_t b : bubbles)
      hash = (hash ^ static_cast<std::size_t>(b)) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
    return hash;
  }
};

template <typename... Bubbles>
auto sorted(Bubbles... bubbles) {
  std::array<std::int32_t, sizeof...(Bubbles)> all{bubbles...};
  std::sort(all.begin(), all.end());
  return all;
}

/// A side of a film's rim: an edge at a third bubble or a wall, or a piece of an arc.
struct Side {
  enum class Kind { border, wall, arc } kind;
  std::int32_t third = -1;                 ///< of a border
  Vector3d wallNormal = Vector3d::Zero();  ///< unit, of a wall
  Vector3d from, to;                       ///< [m]
};

/// Meshes one film after the other.
class Mesher {
 public:
  Mesher(const BubbleStore& bubbles, int segments) : bubbles_(bubbles), segments_(segments) {}

  void add(const Film& film, const FilmOutline& outline) {
    findSides(film, outline);
    if (sides_.size() < 2) return;
    const std::int32_t count = static_cast<std::int32_t>(sides_.size());
    corners_.resize(count);
    for (std::int32_t q = 0; q < count; ++q)
      corners_[q] = cornerOf(film, sides_[(q + count - 1) % count], sides_[q]);
    NetworkFilm face{film.i, film.j, count * segments_, size(network_.slots), 0, size(network_.triangles), 0};
    for (std::int32_t q = 0; q < count; ++q)
      addRimSide(film, outline, sides_[q], corners_[q], corners_[(q + 1) % count]);
    addInside(outline, count);
    addTriangles(count);
    face.endSlot = size(network_.slots), face.endTriangle = size(network_.triangles);
    network_.borderOfSlot.resize(network_.slots.size(), {-1, -1});
    network_.films.push_back(face);
  }

  FilmNetwork finish() {
    for (const FilmBorder& border : network_.borders)
      if (border.films != 3) tear(border);
    for (const auto& [bubbles, node] : pointNode_) network_.points.push_back({bubbles, node});
    std::sort(network_.points.begin(), network_.points.end(),
              [](const FilmPoint& a, const FilmPoint& b) { return a.node < b.node; });
    return std::move(network_);
  }

 private:
  template <typename Column>
  static std::int32_t size(const Column& column) {
    return static_cast<std::int32_t>(column.size());
  }

  void tear(const FilmBorder& border) {
    ++network_.torn;
    for (const std::int32_t node : border.nodes) network_.nodes[node].hold = NodeHold::fixed;
  }

  /// The rim as sides in order: edges by the direction they face, arcs where they leave gaps.
  void findSides(const Film& film, const FilmOutline& outline) {
    sides_.clear(), edges_ = outline.edges;
    const Vector3d across = outline.normal.unitOrthogonal(), upward = outline.normal.cross(across);
    const auto facing = [&](const FilmEdge& edge) {
      const Vector3d out = (edge.to - edge.from).cross(outline.normal);
      return std::atan2(out.dot(upward), out.dot(across));
    };
    std::sort(edges_.begin(), edges_.end(),
              [&](const FilmEdge& a, const FilmEdge& b) { return facing(a) < facing(b); });
    if (edges_.empty() && outline.arc > 0) addArc(outline, outline.centre + outline.discRadius * across, {});
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const FilmEdge &edge = edges_[e], &next = edges_[(e + 1) % edges_.size()];
      Side side{edge.third >= 0 ? Side::Kind::border : Side::Kind::wall, edge.third, Vector3d::Zero(),
                edge.from, edge.to};
      if (edge.third < 0) {
        const Vector3d out = (edge.to - edge.from).cross(outline.normal).normalized();
        side.wallNormal = (edge.lean * film.distance * outline.normal + edge.reach * out).normalized();
      }
      sides_.push_back(side);
      if (edges_.size() == 1 || (next.from - edge.to).norm() > kSameCorner * outline.discRadius)
        addArc(outline, edge.to, next.from);
    }
  }

  /// The arc from `from` counterclockwise to `to`, the whole circle without it.
  void addArc(const FilmOutline& outline, const Vector3d& from, std::optional<Vector3d> to) {
    const Vector3d start = from - outline.centre, square = outline.normal.cross(start);
    double angle = 2 * std::numbers::pi;
    if (to) {
      const Vector3d end = *to - outline.centre;
      angle = std::atan2(end.dot(square), end.dot(start));
      if (angle <= 0) angle += 2 * std::numbers::pi;
    }
    const int pieces = std::max(1, static_cast<int>(std::ceil(angle / kArcSide)));
    const auto at = [&](int p) -> Vector3d {
      if (p == pieces && to) return *to;
      return outline.centre + std::cos(angle * p / pieces) * start + std::sin(angle * p / pieces) * square;
    };
    for (int p = 0; p < pieces; ++p)
      sides_.push_back(
          {Side::Kind::arc, -1, Vector3d::Zero(), at(p), at((p + 1) % (to ? pieces + 1 : pieces))});
  }

  std::int32_t newNode(const Vector3d& x, NodeHold hold = NodeHold::none,
                       const Vector3d& axis = Vector3d::Zero()) {
    network_.nodes.push_back({x, hold, axis});
    return size(network_.nodes) - 1;
  }

  /// The node between two sides. Corners of borders belong to the other films as well.
  std::int32_t cornerOf(const Film& film, const Side& before, const Side& after) {
    using enum Side::Kind;
    const Vector3d& x = after.kind == border || before.kind != border ? after.from : before.to;
    if (before.kind == border && after.kind == border) {
      const auto [known, isNew] =
          pointNode_.try_emplace(sorted(film.i, film.j, before.third, after.third), size(network_.nodes));
      return isNew ? newNode(x) : known->second;
    }
    const FilmNode held = heldBetween(before, after, x);
    if (before.kind != border && after.kind != border) return newNode(x, held.hold, held.axis);
    const bool ends = before.kind == border;  // the border comes to its end in this film's sense
    const std::int32_t third = ends ? before.third : after.third;
    const int end = ends == runsForward(film, ends ? before : after);
    const auto bubbles = sorted(film.i, film.j, third);
    const auto [known, isNew] =
        endNode_.try_emplace({bubbles[0], bubbles[1], bubbles[2], end}, size(network_.nodes));
    if (isNew) return newNode(x, held.hold, held.axis);
    FilmNode& node = network_.nodes[known->second];
    if (held.hold == NodeHold::fixed) node.hold = held.hold;
    return known->second;
  }

  static FilmNode heldBetween(const Side& before, const Side& after, const Vector3d& x) {
    using enum Side::Kind;
    if (before.kind == arc || after.kind == arc) return {x, NodeHold::fixed, Vector3d::Zero()};
    if (before.kind == wall && after.kind == wall)
      return {x, NodeHold::line, before.wallNormal.cross(after.wallNormal).normalized()};
    return {x, NodeHold::plane, before.kind == wall ? before.wallNormal : after.wallNormal};
  }

  /// Whether the film goes along a border in the border's own direction.
  bool runsForward(const Film& film, const Side& side) const {
    const auto [a, b, c] = sorted(film.i, film.j, side.third);
    const Vector3d& x = bubbles_.position[a];
    return (bubbles_.position[b] - x).cross(bubbles_.position[c] - x).dot(side.to - side.from) > 0;
  }

  void addRimSide(const Film& film, const FilmOutline& outline, const Side& side, std::int32_t from,
                  std::int32_t to) {
    if (side.kind == Side::Kind::border) return addBorderSide(film, side, from, to);
    network_.slots.push_back(from);
    const bool isArc = side.kind == Side::Kind::arc;
    for (int s = 1; s < segments_; ++s) {
      Vector3d x = between(side.from, side.to, s);
      if (isArc) x = outline.centre + outline.discRadius * (x - outline.centre).normalized();
      network_.slots.push_back(newNode(x, isArc ? NodeHold::fixed : NodeHold::plane, side.wallNormal));
    }
  }

  void addBorderSide(const Film& film, const Side& side, std::int32_t from, std::int32_t to) {
    const bool forward = runsForward(film, side);
    const auto bubbles = sorted(film.i, film.j, side.third);
    const auto [known, isNew] = borderOf_.try_emplace(bubbles, size(network_.borders));
    const std::int32_t first = forward ? from : to, last = forward ? to : from;
    if (isNew) {
      FilmBorder border{bubbles, {first}, 0};
      for (int s = 1; s < segments_; ++s)
        border.nodes.push_back(
            newNode(forward ? between(side.from, side.to, s) : between(side.to, side.from, s)));
      border.nodes.push_back(last);
      network_.borders.push_back(std::move(border));
    }
    FilmBorder& border = network_.borders[known->second];
    border.films += border.nodes.front() == first && border.nodes.back() == last;
    network_.borderOfSlot.resize(network_.slots.size(), {-1, -1});
    for (int s = 0; s < segments_; ++s) {
      network_.slots.push_back(s == 0 ? from : border.nodes[forward ? s : segments_ - s]);
      network_.borderOfSlot.push_back({known->second, forward ? s : segments_ - 1 - s});
    }
  }

  Vector3d between(const Vector3d& from, const Vector3d& to, int s) const {
    return from + (to - from) * (static_cast<double>(s) / segments_);
  }

  /// Rings of nodes towards the middle, each with a stretch less on every side, then the middle.
  void addInside(const FilmOutline& outline, std::int32_t count) {
    Vector3d middle = Vector3d::Zero();
    for (const Side& side : sides_) middle += side.from;
    middle /= count;
    middle -= outline.normal * outline.normal.dot(middle - outline.centre);
    for (int ring = 1; ring < segments_; ++ring)
      for (const Side& side : sides_)
        for (int s = 0; s < segments_ - ring; ++s) {
          const double inward = static_cast<double>(ring) / segments_,
                       along = static_cast<double>(s) / segments_;
          network_.slots.push_back(
              newNode(inward * middle + (1 - inward - along) * side.from + along * side.to));
        }
    network_.slots.push_back(newNode(middle));
  }

  void addTriangles(std::int32_t count) {
    auto& triangles = network_.triangles;
    const auto slot = [&](int ring, std::int32_t q, int s) {
      const std::int32_t length = segments_ - ring;  // stretches of a side in this ring
      std::int32_t start = 0;
      for (int r = 0; r < ring; ++r) start += count * (segments_ - r);
      return length == 0 ? start : start + (q * length + s) % (count * length);
    };
    for (int ring = 0; ring < segments_; ++ring)  // those along the rim come first
      for (std::int32_t q = 0; q < count; ++q)
        for (int s = 0; s < segments_ - ring; ++s)
          triangles.push_back({slot(ring, q, s), slot(ring, q, s + 1), slot(ring + 1, q, s)});
    for (int ring = 0; ring + 1 < segments_; ++ring)
      for (std::int32_t q = 0; q < count; ++q)
        for (int s = 0; s + 1 < segments_ - ring; ++s)
          triangles.push_back({slot(ring, q, s + 1), slot(ring + 1, q, s + 1), slot(ring + 1, q, s)});
  }

  const BubbleStore& bubbles_;
  int segments_;
  FilmNetwork network_;
  std::vector<FilmEdge> edges_;
  std::vector<Side> sides_;
  std::vector<std::int32_t> corners_;
  std::unordered_map<std::array<std::int32_t, 3>, std::int32_t, HashOfBubbles<3>> borderOf_;
  std::unordered_map<std::array<std::int32_t, 4>, std::int32_t, HashOfBubbles<4>> pointNode_, endNode_;
};

}  // namespace

double FilmNetwork::areaOf(const NetworkFilm& film) const {
  double area = 0;
  for (std::int32_t t = film.firstTriangle; t < film.endTriangle; ++t) {
    const auto& [a, b, c] = triangles[t];
    area += (at(film, b) - at(film, a)).cross(at(film, c) - at(film, a)).norm() / 2;
  }
  return area;
}

FilmNetwork meshFilms(const BubbleStore& bubbles, const FoamTopology& topology, const Neighbours& neighbours,
                      const std::vector<NearWalls>& walls, int segments) {
  Mesher mesher(bubbles, segments);
  FilmOutlines outlines(bubbles, topology, neighbours, walls);
  FilmOutline outline;
  for (const Film& film : topology.films) {
    outlines.trace(film, outline);
    mesher.add(film, outline);
  }
  return mesher.finish();
}

}  // namespace spume::foam
