#include "foam/site_grid.h"

#include <tbb/parallel_sort.h>

#include <limits>
#include <numeric>

#include "foam/lane_math.h"

namespace spume::foam {

namespace {

/// Cells of the box around all sites, for each site, up to which they stand in a table: beyond, far outliers
/// would make it mostly empty, and a hash finds them.
constexpr double kCellsPerSite = 64;

}  // namespace

SiteGrid::SiteGrid(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                   const std::vector<std::uint64_t>& id, double cellSize)
    : cellSize_(cellSize) {
  const double far = std::numeric_limits<double>::max();
  lowest_.setConstant(far), highest_.setConstant(-far);
  for (const Eigen::Vector3d& x : position) lowest_ = lowest_.cwiseMin(x), highest_ = highest_.cwiseMax(x);
  low_ = cellOf(lowest_), high_ = cellOf(highest_);
  std::vector<std::pair<std::uint64_t, std::int32_t>> keys(position.size());
  for (std::size_t i = 0; i < position.size(); ++i)
    keys[i] = {keyOf(cellOf(position[i])), static_cast<std::int32_t>(i)};
  tbb::parallel_sort(keys.begin(), keys.end());
  sites_.reserve(keys.size());
  for (auto* column : {&column_.x, &column_.y, &column_.z, &column_.radius})
    column->reserve(keys.size() + kLanes);
  for (const auto& [key, i] : keys) {
    if (sites_.empty() || cellOf(position[i]) != cellOf(sites_.back().position))
      runStart_.push_back(static_cast<std::int32_t>(sites_.size()));
    sites_.push_back({position[i], {radius[i], id[i]}, i});
    maxRadius_ = std::max(maxRadius_, sites_.back().ball.radius);
    column_.x.push_back(position[i].x()), column_.y.push_back(position[i].y());
    column_.z.push_back(position[i].z()), column_.radius.push_back(sites_.back().ball.radius);
  }
  runStart_.push_back(static_cast<std::int32_t>(sites_.size()));
  for (auto* column : {&column_.x, &column_.y, &column_.z, &column_.radius})
    column->resize(sites_.size() + kLanes);
  if (fitsTable())
    fillTable();
  else
    cells_ = CellHash(keys);
}

/// Ascends with the place in the table, if there is one.
std::uint64_t SiteGrid::keyOf(const Cell& cell) const {
  std::uint64_t key = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const auto along = static_cast<std::uint64_t>(cell[axis]) - static_cast<std::uint64_t>(low_[axis]);
    key = key << kCellAxisBits | (along & ((1ull << kCellAxisBits) - 1));
  }
  return key;
}

bool SiteGrid::fitsTable() const {
  constexpr double kWrap = 1 << kCellAxisBits;  // beyond, cells may share a key and their sites mix
  return width(0) * width(1) * width(2) <= kCellsPerSite * static_cast<double>(sites_.size()) &&
         std::max({width(0), width(1), width(2)}) < kWrap;
}

void SiteGrid::fillTable() {
  start_.resize(static_cast<std::size_t>(width(0) * width(1) * width(2)) + 1);
  for (const Site& site : sites_) ++start_[placeOf(cellOf(site.position)) + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
}

SiteGrid::Run SiteGrid::hashed(const Cell& cell) const {
  const CellHash::Run& run = cells_[keyOf(cell)];
  return {run.begin, run.end};
}

bool SiteGrid::endsWithin(const Eigen::Vector3d& x, std::int64_t ring) const {
  const Cell centre = cellOf(x);
  for (int axis = 0; axis < 3; ++axis)
    if (centre[axis] - ring > low_[axis] || centre[axis] + ring < high_[axis]) return false;
  return true;
}

void Vicinity::moveTo(const SiteGrid& grid, const Eigen::Vector3d& centre) {
  grid_ = &grid, centre_ = centre;
  count_ = 0, nearest_ = 0;
}

std::size_t Vicinity::keepNearest() {
  if (nearest_ == 0) {
    static const SiteGrid::Worth all{{std::vector<double>(3), std::vector<double>(3), std::vector<double>(3)},
                                     -1};
    addRing(0, all);
    nearest_ = addRing(1, all);
  }
  count_ = nearest_;
  return count_;
}

std::size_t Vicinity::addRing(std::int64_t ring, const SiteGrid::Worth& worth) {
  grid_->visitRing(centre_, ring, worth, [this](const SiteGrid::Run& run) { add(run); });
  return count_;
}

void Vicinity::makeRoom(std::size_t sites) {
  for (auto* column : {&x, &y, &z, &radius}) column->resize(sites);
  site.resize(sites);
}

/// By whole lanes: most runs are short.
void Vicinity::add(const SiteGrid::Run& run) {
  const std::size_t n = count_, end = n + static_cast<std::size_t>(run.end - run.begin);
  if (x.size() < end + kLanes) makeRoom(2 * (end + kLanes));
  const SiteGrid::Columns& from = grid_->columns();
  for (std::size_t to = n, k = static_cast<std::size_t>(run.begin); to < end; to += kLanes, k += kLanes) {
    storeLanes(&x[to], loadLanes(&from.x[k])), storeLanes(&y[to], loadLanes(&from.y[k]));
    storeLanes(&z[to], loadLanes(&from.z[k])), storeLanes(&radius[to], loadLanes(&from.radius[k]));
    for (std::size_t lane = 0; lane < kLanes; ++lane) site[to + lane] = static_cast<std::int32_t>(k + lane);
  }
  count_ = end;
}

}  // namespace spume::foam
