#include "foam/weak_pairs.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "foam/ball_checks.h"
#include "foam/cell_hash.h"
#include "foam/convex_cell.h"
#include "foam/disc_clipper.h"
#include "foam/radical_plane.h"

namespace spume::foam {

namespace {

using Eigen::Vector3d;

/// Cells per range: few enough that an empty neighbourhood is quick to walk, enough that the near ones come
/// first.
constexpr double kCellsPerRange = 6;

/// Cells of the box around all sites, for each site, up to which they stand in a table: beyond, far outliers
/// would make it mostly empty, and a hash finds them.
constexpr double kCellsPerSite = 64;

/// Nearness of a site at the bubble's own place: before all others.
constexpr double kFirst = -1e300;

/// All bubbles, sorted by grid cell.
class SiteGrid {
 public:
  struct Site {
    Vector3d position;
    TieBrokenBall ball;
    std::int32_t index;
  };
  using Cell = std::array<std::int64_t, 3>;

  SiteGrid(const std::vector<Vector3d>& position, const std::vector<double>& radius,
           const std::vector<std::uint64_t>& id, double cellSize)
      : cellSize_(cellSize) {
    std::vector<std::pair<std::uint64_t, std::int32_t>> keys(position.size());
    low_.fill(std::numeric_limits<std::int64_t>::max()), high_.fill(std::numeric_limits<std::int64_t>::min());
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Cell cell = cellOf(position[i]);
      keys[i] = {keyOf(cell), static_cast<std::int32_t>(i)};
      for (int axis = 0; axis < 3; ++axis)
        low_[axis] = std::min(low_[axis], cell[axis]), high_[axis] = std::max(high_[axis], cell[axis]);
      maxRadius_ = std::max(maxRadius_, radius[i]);
    }
    tbb::parallel_sort(keys.begin(), keys.end());
    const double cells = width(0) * width(1) * width(2);
    constexpr double kWrap = 1 << kCellAxisBits;  // beyond, cells may share a key and their sites mix
    if (cells <= kCellsPerSite * static_cast<double>(position.size()) &&
        std::max({width(0), width(1), width(2)}) < kWrap)
      table_.resize(static_cast<std::size_t>(cells));
    else
      cells_ = CellHash(keys);
    for (const auto& [key, i] : keys) {
      if (sites_.empty() || cellOf(position[i]) != cellOf(sites_.back().position))
        runStart_.push_back(static_cast<std::int32_t>(sites_.size()));
      sites_.push_back({position[i], {radius[i], id[i]}, i});
      for (int axis = 0; axis < 3; ++axis) columns_[axis].push_back(position[i][axis]);
      columns_[3].push_back(sites_.back().ball.radius);
    }
    runStart_.push_back(static_cast<std::int32_t>(sites_.size()));
    if (!table_.empty()) fillTable();
  }

  double cellSize() const { return cellSize_; }
  double maxRadius() const { return maxRadius_; }
  const std::vector<Site>& sites() const { return sites_; }
  /// First site of each cell that is not empty, then the number of sites.
  const std::vector<std::int32_t>& runStart() const { return runStart_; }

  /// Coordinates and radii of the sites, in their order [m].
  const std::array<std::vector<double>, 4>& columns() const { return columns_; }

  /// Calls visit(begin, end) for runs of the sites whose cell is `ring` cells from that of x, in the largest
  /// coordinate.
  template <typename Visit>
  void visitRing(const Vector3d& x, std::int64_t ring, const Visit& visit) const {
    const Cell centre = cellOf(x);
    Cell cell;
    for (cell[2] = from(centre, 2, ring); cell[2] <= to(centre, 2, ring); ++cell[2])
      for (cell[1] = from(centre, 1, ring); cell[1] <= to(centre, 1, ring); ++cell[1]) {
        const bool face =
            std::abs(cell[2] - centre[2]) == ring || std::abs(cell[1] - centre[1]) == ring || ring == 0;
        if (face)
          for (cell[0] = from(centre, 0, ring); cell[0] <= to(centre, 0, ring); ++cell[0])
            visitCell(cell, visit);
        else
          for (cell[0] = centre[0] - ring; cell[0] <= centre[0] + ring; cell[0] += 2 * ring)
            visitCell(cell, visit);
      }
  }
  /// Whether all sites lie within that many rings of the cell of x.
  bool endsWithin(const Vector3d& x, std::int64_t ring) const {
    const Cell centre = cellOf(x);
    for (int axis = 0; axis < 3; ++axis)
      if (centre[axis] - ring > low_[axis] || centre[axis] + ring < high_[axis]) return false;
    return true;
  }

 private:
  Cell cellOf(const Vector3d& x) const {
    return {cellCoordinate(x[0], cellSize_), cellCoordinate(x[1], cellSize_),
            cellCoordinate(x[2], cellSize_)};
  }
  static std::uint64_t keyOf(const Cell& cell) {
    return spreadCellBits(cell[0]) | spreadCellBits(cell[1]) << 1 | spreadCellBits(cell[2]) << 2;
  }
  std::int64_t from(const Cell& centre, int axis, std::int64_t ring) const {
    return std::max(centre[axis] - ring, low_[axis]);
  }
  std::int64_t to(const Cell& centre, int axis, std::int64_t ring) const {
    return std::min(centre[axis] + ring, high_[axis]);
  }
  template <typename Visit>
  void visitCell(const Cell& cell, const Visit& visit) const {
    if (cell[0] < low_[0] || cell[0] > high_[0]) return;
    const Run run = table_.empty() ? runOf(cells_[keyOf(cell)]) : table_[placeOf(cell)];
    if (run.begin < run.end) visit(run.begin, run.end);
  }

  struct Run {
    std::int32_t begin = 0, end = 0;
  };
  static Run runOf(const CellHash::Run& run) { return {run.begin, run.end}; }
  double width(int axis) const {
    return static_cast<double>(high_[axis]) - static_cast<double>(low_[axis]) + 1;
  }
  std::size_t placeOf(const Cell& cell) const {
    const std::int64_t row = (cell[2] - low_[2]) * (high_[1] - low_[1] + 1) + cell[1] - low_[1];
    return static_cast<std::size_t>(row * (high_[0] - low_[0] + 1) + cell[0] - low_[0]);
  }
  void fillTable() {
    for (std::size_t k = 0; k + 1 < runStart_.size(); ++k)
      table_[placeOf(cellOf(sites_[runStart_[k]].position))] = {runStart_[k], runStart_[k + 1]};
  }

  double cellSize_, maxRadius_ = 0;
  Cell low_, high_;         ///< of the cells that are not empty
  std::vector<Run> table_;  ///< of the cells in the box low_ .. high_, x fastest; empty if that is too large
  CellHash cells_;          ///< instead of it
  std::vector<Site> sites_;
  std::array<std::vector<double>, 4> columns_;
  std::vector<std::int32_t> runStart_;
};

/// The sites around one cell of the grid, nearest rings first, gathered as far as they are asked for: what is
/// near one bubble of the cell is near all. One per thread.
class Vicinity {
 public:
  std::vector<double> x, y, z, radius;  ///< [m], padded
  std::vector<const SiteGrid::Site*> site;

  void moveTo(const SiteGrid& grid, const Vector3d& centre) {
    grid_ = &grid, centre_ = centre;
    site.clear(), ringEnd_.clear();
  }
  /// One past the last site of the ring.
  std::size_t endOf(std::int64_t ring) {
    while (static_cast<std::int64_t>(ringEnd_.size()) <= ring) gatherRing();
    return ringEnd_[ring];
  }

 private:
  void gatherRing() {
    grid_->visitRing(centre_, static_cast<std::int64_t>(ringEnd_.size()),
                     [this](std::int32_t begin, std::int32_t end) { add(begin, end); });
    ringEnd_.push_back(site.size());
  }
  void add(std::int32_t begin, std::int32_t end) {
    const std::size_t first = site.size(), room = first + static_cast<std::size_t>(end - begin) + kLanes;
    std::vector<double>* const columns[4] = {&x, &y, &z, &radius};
    for (std::size_t c = 0; c < 4; ++c) {
      if (columns[c]->size() < room) columns[c]->resize(2 * room);
      const double* from = &grid_->columns()[c][static_cast<std::size_t>(begin)];
      std::copy(from, from + (end - begin), columns[c]->begin() + static_cast<std::ptrdiff_t>(first));
    }
    for (std::int32_t s = begin; s < end; ++s) site.push_back(&grid_->sites()[static_cast<std::size_t>(s)]);
  }

  const SiteGrid* grid_ = nullptr;
  Vector3d centre_;
  std::vector<std::size_t> ringEnd_;
};

/// Builds the inflated power cell of one bubble from the nearest sites outwards: a polyhedron first, which
/// most sites are seen to miss, then the discs of those that have a face of it. One per thread.
class InflatedCell {
 public:
  struct Neighbour {
    const SiteGrid::Site* site;
    double distance;  ///< [m]
  };

  /// Finds the cell of `site` when every r^2 grows by `inflation` [m^2]; false if it has none.
  bool build(const SiteGrid::Site& site, double inflation, const SiteGrid& grid, Vicinity& vicinity) {
    site_ = &site;
    reach_ = std::sqrt(site.ball.radius * site.ball.radius + inflation);
    face_.clear(), unsure_.clear();
    cell_.reset(reach_);
    if (!grow(grid, vicinity)) return false;
    collectPlanes();
    return true;
  }
  /// Sites that may share a face with it.
  const std::vector<Neighbour>& neighbours() const { return neighbours_; }
  /// Whether neighbour k does.
  bool sharesFace(std::size_t k) { return clipper_.leavesAny(planes_, k, reach_); }

 private:
  struct Candidate {
    double nearness;  ///< height of its plane over the distance of its centre [-]
    const SiteGrid::Site* site;
    bool operator<(const Candidate& other) const {
      return std::make_pair(nearness, site->index) < std::make_pair(other.nearness, other.site->index);
    }
  };

  /// Cuts the polyhedron by all sites that can; false if one takes all of it.
  bool grow(const SiteGrid& grid, Vicinity& vicinity) {
    const double maxRadius = grid.maxRadius(), r = site_->ball.radius;
    std::size_t begin = 0;
    for (std::int64_t ring = 1;; ++ring) {
      const std::size_t end = vicinity.endOf(ring);
      if (!cutByNearest(vicinity, begin, end)) return false;
      begin = end;
      // All sites nearer than `seen` have been visited; the planes of the others are no nearer than `height`.
      const double seen = static_cast<double>(ring) * grid.cellSize();
      const double height = (seen - (maxRadius * maxRadius - r * r) / seen) / 2;
      if (height >= std::min(reach_, cell_.farthest()) || grid.endsWithin(site_->position, ring)) return true;
    }
  }

  /// Cuts by sites begin .. end - 1 of the vicinity, from the nearest plane on.
  bool cutByNearest(const Vicinity& vicinity, std::size_t begin, std::size_t end) {
    candidates_.clear();
    for (std::size_t k = begin; k < end; k += kLanes) addCandidates(vicinity, k, std::min(end, k + kLanes));
    std::sort(candidates_.begin(), candidates_.end());
    for (const Candidate& candidate : candidates_)
      if (!cutBy(*candidate.site)) return false;
    return true;
  }

  /// Those of a block of sites whose plane meets the box around the polyhedron.
  void addCandidates(const Vicinity& vicinity, std::size_t k, std::size_t end) {
    const Lanes dx = loadLanes(&vicinity.x[k]) - site_->position.x(),
                dy = loadLanes(&vicinity.y[k]) - site_->position.y(),
                dz = loadLanes(&vicinity.z[k]) - site_->position.z(), radius = loadLanes(&vicinity.radius[k]);
    const double r = site_->ball.radius;
    const Lanes d2 = dx * dx + dy * dy + dz * dz, offset = (d2 + (r - radius) * (r + radius)) / 2;
    const auto most = [&](const Lanes& d, int axis) {
      return d > 0 ? d * cell_.high()[axis] : d * cell_.low()[axis];
    };
    const LaneMask meets = (most(dx, 0) + most(dy, 1) + most(dz, 2) > offset) | (d2 == 0);
    std::uint32_t bits = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      bits |= static_cast<std::uint32_t>(meets[lane] & (1 << lane));
    for (; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      if (k + lane < end)
        candidates_.push_back({d2[lane] > 0 ? offset[lane] / d2[lane] : kFirst, vicinity.site[k + lane]});
    }
  }

  bool cutBy(const SiteGrid::Site& other) {
    if (other.index == site_->index) return true;
    const Vector3d to = other.position - site_->position;
    const double d = to.norm();
    if (d == 0)
      return std::make_pair(other.ball.radius, site_->index) <=
             std::make_pair(site_->ball.radius, other.index);
    const double height = radicalHeight(site_->ball, other.ball, d);
    if (height >= reach_) return true;
    const auto number = static_cast<std::int32_t>(face_.size());
    const ConvexCell::Cut cut = cell_.cut(to / d, height, ConvexCell::kCubeFaces + number);
    if (cut == ConvexCell::Cut::done || cut == ConvexCell::Cut::unsure) face_.push_back({&other, d});
    if (cut == ConvexCell::Cut::unsure) unsure_.push_back(ConvexCell::kCubeFaces + number);
    return cut != ConvexCell::Cut::gone;
  }

  /// The planes that are left, for the discs.
  void collectPlanes() {
    cell_.listFaces(left_);
    left_.insert(left_.end(), unsure_.begin(), unsure_.end());
    neighbours_.clear();
    planes_.resize(left_.size());
    for (std::size_t k = 0; k < left_.size(); ++k) {
      neighbours_.push_back(face_[left_[k] - ConvexCell::kCubeFaces]);
      const auto& [other, d] = neighbours_.back();
      const Vector3d normal = (other->position - site_->position) / d;
      planes_.nx[k] = normal.x(), planes_.ny[k] = normal.y(), planes_.nz[k] = normal.z();
      planes_.height[k] = radicalHeight(site_->ball, other->ball, d), planes_.heightShift[k] = 0;
    }
  }

  const SiteGrid::Site* site_ = nullptr;
  double reach_ = 0;  ///< radius of the inflated ball [m]
  ConvexCell cell_;
  std::vector<Candidate> candidates_;
  std::vector<Neighbour> face_, neighbours_;  ///< behind each face the cell has had; of those that are left
  std::vector<std::int32_t> unsure_, left_;
  CuttingPlanes planes_;  ///< of the neighbours, in their order
  DiscClipper clipper_;
};

bool inContact(const FoamTopology& topology, std::int32_t i, std::int32_t j) {
  const auto before = [](const Film& film, const std::pair<std::int32_t, std::int32_t>& key) {
    return std::make_pair(film.i, film.j) < key;
  };
  const auto place =
      std::lower_bound(topology.films.begin(), topology.films.end(), std::make_pair(i, j), before);
  return place != topology.films.end() && place->i == i && place->j == j;
}

}  // namespace

void WeakPairs::find(const std::vector<Vector3d>& position, const std::vector<double>& radius,
                     const std::vector<std::uint64_t>& id, const std::vector<std::uint8_t>& surface,
                     const FoamTopology& topology, double range, std::vector<WeakPair>& out) {
  checkBalls("WeakPairs", position, radius, id);
  if (!(range > 0) || !std::isfinite(range) || surface.size() != position.size())
    throw InvalidParameter("WeakPairs: range " + std::to_string(range) + " m and " +
                           std::to_string(surface.size()) + " flags for " + std::to_string(position.size()) +
                           " bubbles; the range must be positive and finite, with one flag per bubble");
  out.clear();
  if (std::count_if(surface.begin(), surface.end(), [](std::uint8_t flag) { return flag != 0; }) < 2) return;
  const SiteGrid grid(position, radius, id, range / kCellsPerRange);
  struct Scratch {
    Vicinity vicinity;
    InflatedCell cell;
  };
  tbb::enumerable_thread_specific<Scratch> scratch;
  std::vector<std::vector<WeakPair>> found(grid.runStart().size() - 1);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t run) {
    auto& [vicinity, cell] = scratch.local();
    const std::vector<SiteGrid::Site>& sites = grid.sites();
    vicinity.moveTo(grid, sites[grid.runStart()[run]].position);
    for (std::int32_t s = grid.runStart()[run]; s < grid.runStart()[run + 1]; ++s) {
      const std::int32_t i = sites[s].index;
      if (!surface[i] || !cell.build(sites[s], range * range / 4, grid, vicinity)) continue;
      for (std::size_t k = 0; k < cell.neighbours().size(); ++k) {
        const auto& [other, distance] = cell.neighbours()[k];
        const std::int32_t j = other->index;
        if (i < j && surface[j] && distance <= range && !inContact(topology, i, j) && cell.sharesFace(k))
          found[run].push_back({i, j, distance});
      }
    }
  });
  for (const auto& part : found) out.insert(out.end(), part.begin(), part.end());
  std::sort(out.begin(), out.end(), [](const WeakPair& a, const WeakPair& b) {
    return std::make_pair(a.i, a.j) < std::make_pair(b.i, b.j);
  });
}

}  // namespace spume::foam
