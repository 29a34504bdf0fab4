#include "foam/weak_pairs.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

#include "foam/ball_checks.h"
#include "foam/cell_hash.h"
#include "foam/disc_clipper.h"
#include "foam/radical_plane.h"

namespace spume::foam {

namespace {

using Eigen::Vector3d;

/// Cells per range: few enough that an empty neighbourhood is quick to walk, enough that the near ones come
/// first.
constexpr double kCellsPerRange = 6;

struct Site {
  Vector3d position;
  TieBrokenBall ball;
  std::int32_t index;
};

/// All bubbles, sorted by grid cell.
class SiteGrid {
 public:
  SiteGrid(const std::vector<Vector3d>& position, const std::vector<double>& radius,
           const std::vector<std::uint64_t>& id, double cellSize)
      : cellSize_(cellSize) {
    std::vector<std::pair<std::uint64_t, std::int32_t>> keys(position.size());
    for (std::size_t i = 0; i < position.size(); ++i) {
      keys[i].second = static_cast<std::int32_t>(i);
      for (int axis = 0; axis < 3; ++axis)
        keys[i].first |= spreadCellBits(coordinate(position[i][axis])) << axis;
      maxRadius_ = std::max(maxRadius_, radius[i]);
    }
    tbb::parallel_sort(keys.begin(), keys.end());
    cells_ = CellHash(keys);
    for (const auto& [key, i] : keys) sites_.push_back({position[i], {radius[i], id[i]}, i});
  }

  double cellSize() const { return cellSize_; }
  double maxRadius() const { return maxRadius_; }
  const std::vector<Site>& sites() const { return sites_; }

  /// Calls visit(site) for all sites whose cell is `ring` cells from that of x, in the largest coordinate.
  template <typename Visit>
  void visitRing(const Vector3d& x, std::int64_t ring, const Visit& visit) const {
    const std::int64_t cx = coordinate(x.x()), cy = coordinate(x.y()), cz = coordinate(x.z());
    for (std::int64_t z = -ring; z <= ring; ++z)
      for (std::int64_t y = -ring; y <= ring; ++y) {
        const bool face = std::abs(z) == ring || std::abs(y) == ring;
        const std::uint64_t part = spreadCellBits(cy + y) << 1 | spreadCellBits(cz + z) << 2;
        for (std::int64_t k = -ring; k <= ring; k += face ? 1 : std::max<std::int64_t>(1, 2 * ring)) {
          const CellHash::Run& run = cells_[part | spreadCellBits(cx + k)];
          for (std::int32_t s = run.begin; s < run.end; ++s) visit(sites_[s]);
        }
      }
  }

 private:
  std::int64_t coordinate(double x) const { return cellCoordinate(x, cellSize_); }

  double cellSize_, maxRadius_ = 0;
  CellHash cells_;
  std::vector<Site> sites_;
};

/// Builds the inflated power cell of one bubble from the nearest sites outwards and keeps those that share a
/// face with it. A site whose plane misses the cell of the sites before it can never matter again. One per
/// thread.
class InflatedCell {
 public:
  struct Neighbour {
    const Site* site;
    double distance;  ///< [m]
  };

  /// The sites that share a face with `site` when every r^2 grows by `inflation` [m^2].
  const std::vector<Neighbour>& neighboursOf(const Site& site, double inflation, const SiteGrid& grid) {
    site_ = &site;
    reach_ = std::sqrt(site.ball.radius * site.ball.radius + inflation);
    neighbours_.clear();
    planes_.resize(0);
    covered_ = false;
    witness_.setZero();
    grow(grid);
    farthestPoint();
    if (covered_) neighbours_.clear();
    return neighbours_;
  }

 private:
  /// Adds all sites that can cut the cell.
  void grow(const SiteGrid& grid) {
    const double maxRadius = grid.maxRadius(), r = site_->ball.radius;
    for (std::int64_t ring = 0; !covered_; ++ring) {
      grid.visitRing(site_->position, ring, [this](const Site& other) { addSite(other); });
      // All sites nearer than `seen` have been visited; the planes of the others are no nearer than `height`.
      const double seen = static_cast<double>(ring) * grid.cellSize();
      const double height = seen > 0 ? (seen - (maxRadius * maxRadius - r * r) / seen) / 2 : 0;
      if (height >= reach_ || (height > 0 && height >= farthestPoint())) return;
    }
  }

  void addSite(const Site& other) {
    if (other.index == site_->index || covered_) return;
    const Vector3d to = other.position - site_->position;
    const double d = to.norm();
    if (d == 0) {
      covered_ =
          std::make_pair(other.ball.radius, site_->index) > std::make_pair(site_->ball.radius, other.index);
      return;
    }
    const double height = radicalHeight(site_->ball, other.ball, d);
    if (height >= reach_) return;
    const std::size_t last = planes_.count;
    planes_.resize(last + 1);
    planes_.nx[last] = to.x() / d, planes_.ny[last] = to.y() / d, planes_.nz[last] = to.z() / d;
    planes_.height[last] = height;
    neighbours_.push_back({&other, d});
    cut(last, to / d);
  }

  /// A plane that meets the cell is kept. One that does not leaves the cell whole or takes all of it, as the
  /// witness tells.
  void cut(std::size_t plane, const Vector3d& normal) {
    const bool witnessLost = witness_.dot(normal) > planes_.height[plane];
    if (!discOf(plane).empty) {
      if (witnessLost) witness_ = clipper_.pointInside();
      return;
    }
    shrink(plane);
    covered_ = witnessLost;
  }

  FilmShape discOf(std::size_t k) {
    return clipper_.clip(planes_, k, {reach_, 0, reach_, neighbours_[k].distance - planes_.height[k]});
  }

  void shrink(std::size_t count) {
    neighbours_.resize(count);
    planes_.resize(count);
  }

  /// Drops neighbours whose discs later ones have covered. Returns how far the cell reaches from the centre:
  /// its farthest corner if films close it, otherwise the inflated ball.
  double farthestPoint() {
    double farthest2 = 0;
    bool closed = !neighbours_.empty();
    kept_.clear();
    for (std::size_t k = 0; k < neighbours_.size(); ++k) {
      const FilmShape disc = discOf(k);
      if (disc.empty) continue;
      kept_.push_back(k);
      closed = closed && disc.arc == 0;
      farthest2 = std::max(farthest2, clipper_.farthestCorner2());
    }
    for (std::size_t to = 0; to < kept_.size(); ++to) {
      neighbours_[to] = neighbours_[kept_[to]];
      for (auto* column : {&planes_.nx, &planes_.ny, &planes_.nz, &planes_.height})
        (*column)[to] = (*column)[kept_[to]];
    }
    shrink(kept_.size());
    return closed && !kept_.empty() ? std::sqrt(farthest2) : reach_;
  }

  const Site* site_ = nullptr;
  double reach_ = 0;      ///< radius of the inflated ball [m]
  bool covered_ = false;  ///< there is no cell
  Vector3d witness_;      ///< a point of the cell so far, from the bubble's centre [m]
  std::vector<Neighbour> neighbours_;
  std::vector<std::size_t> kept_;
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
  const std::vector<Site>& sites = grid.sites();
  std::vector<std::vector<WeakPair>> found(sites.size());
  tbb::enumerable_thread_specific<InflatedCell> cells;
  tbb::parallel_for(std::size_t{0}, sites.size(), [&](std::size_t s) {
    if (!surface[sites[s].index]) return;
    const std::int32_t i = sites[s].index;
    for (const auto& [other, distance] : cells.local().neighboursOf(sites[s], range * range / 4, grid)) {
      const std::int32_t j = other->index;
      if (i < j && surface[j] && distance <= range && !inContact(topology, i, j))
        found[s].push_back({i, j, distance});
    }
  });
  for (const auto& part : found) out.insert(out.end(), part.begin(), part.end());
  std::sort(out.begin(), out.end(), [](const WeakPair& a, const WeakPair& b) {
    return std::make_pair(a.i, a.j) < std::make_pair(b.i, b.j);
  });
}

}  // namespace spume::foam
