#include "foam/pair_sweep.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "foam/lane_math.h"
#include "foam/parallel.h"

namespace spume::foam {

namespace {

constexpr int kLevels = 32;            ///< sizes told apart: 4^32 from smallest to largest
constexpr int kOctavesPerLevel = 2;    ///< fewer mean more rods to look at, more mean longer stretches
constexpr int kSectionBits = 29;       ///< of a rod's coordinate; rods farther out count as the outermost
constexpr std::size_t kRodGrain = 16;  ///< rods per parallel task

/// Spreads 29 bits to every second one.
std::uint64_t spreadBits(std::int64_t coordinate) {
  std::uint64_t v = static_cast<std::uint64_t>(coordinate);
  v = (v | v << 16) & 0x0000ffff0000ffffull;
  v = (v | v << 8) & 0x00ff00ff00ff00ffull;
  v = (v | v << 4) & 0x0f0f0f0f0f0f0f0full;
  v = (v | v << 2) & 0x3333333333333333ull;
  return (v | v << 1) & 0x5555555555555555ull;
}

/// What a ball is sorted by.
struct SortKey {
  std::uint64_t rod;
  double x;
  std::int32_t index;

  bool operator<(const SortKey& other) const {
    if (rod != other.rod) return rod < other.rod;
    return x != other.x ? x < other.x : index < other.index;
  }
};

double gapTo(double low, double high, double at) { return std::max({low - at, at - high, 0.0}); }

}  // namespace

PairSweep::PairSweep(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                     double reach)
    : reach_(reach) {
  if (radius.empty()) return;
  findLevels(radius);
  sort(position, radius);
}

int PairSweep::numberOf(double radius) const {
  return kLevels - 1 - std::min(kLevels - 1, (topOctave_ - std::ilogb(radius)) / kOctavesPerLevel);
}

void PairSweep::findLevels(const std::vector<double>& radius) {
  topOctave_ = std::ilogb(*std::max_element(radius.begin(), radius.end()));
  double maxRadius[kLevels] = {};
  for (double r : radius) maxRadius[numberOf(r)] = std::max(maxRadius[numberOf(r)], r);
  for (int number = 0; number < kLevels; ++number)
    if (maxRadius[number] > 0) level_.push_back({number, 2 * reach_ * maxRadius[number], maxRadius[number]});
}

PairSweep::Section PairSweep::sectionOf(const Level& level, double y, double z) const {
  constexpr std::int64_t kLast = (std::int64_t{1} << kSectionBits) - 1;
  const auto coordinate = [&](double from) {
    return std::clamp(cellCoordinate(from, level.side), std::int64_t{0}, kLast);
  };
  return {coordinate(y - lowY_), coordinate(z - lowZ_)};
}

/// Rods near each other have keys near each other.
std::uint64_t PairSweep::keyOf(const Level& level, const Section& section) const {
  return static_cast<std::uint64_t>(level.number) << (2 * kSectionBits) | spreadBits(section.y) |
         spreadBits(section.z) << 1;
}

void PairSweep::sort(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius) {
  const std::size_t n = radius.size();
  const auto lower = [](double a, double b) { return std::min(a, b); };
  lowY_ = reduceIndices(
      n, position[0].y(), [&](std::size_t i) { return position[i].y(); }, lower);
  lowZ_ = reduceIndices(
      n, position[0].z(), [&](std::size_t i) { return position[i].z(); }, lower);
  std::array<const Level*, kLevels> levelOf{};
  for (const Level& level : level_) levelOf[level.number] = &level;
  std::vector<SortKey> keys(n);
  forEachIndex(n, [&](std::size_t i) {
    const Level& level = *levelOf[numberOf(radius[i])];
    const Eigen::Vector3d& at = position[i];
    keys[i] = {keyOf(level, sectionOf(level, at.y(), at.z())), at.x(), static_cast<std::int32_t>(i)};
  });
  tbb::parallel_sort(keys.begin(), keys.end());

  constexpr double kNowhere = 1e200;  // its square is infinite: nothing reaches it
  index_.resize(n);
  for (auto* column : {&x_, &y_, &z_}) column->assign(n + kLanes, kNowhere);
  r_.assign(n + kLanes, 0.0);
  std::vector<std::uint64_t> rodKeys(n);
  forEachIndex(n, [&](std::size_t s) {
    const std::int32_t i = index_[s] = keys[s].index;
    x_[s] = position[i].x(), y_[s] = position[i].y(), z_[s] = position[i].z(), r_[s] = radius[i];
    rodKeys[s] = keys[s].rod;
  });
  cutRods(rodKeys);
}

void PairSweep::cutRods(const std::vector<std::uint64_t>& keys) {
  std::vector<std::pair<std::uint64_t, std::int32_t>> places;
  for (std::size_t s = 0; s < keys.size(); ++s) {
    const auto place = static_cast<std::int32_t>(s);
    if (s == 0 || keys[s] != keys[s - 1]) {
      std::int32_t level = rod_.empty() ? 0 : rod_.back().level;
      while (static_cast<std::uint64_t>(level_[level].number) != keys[s] >> (2 * kSectionBits)) ++level;
      places.emplace_back(keys[s], static_cast<std::int32_t>(rod_.size()));
      rod_.push_back({keys[s], place, place, level, {y_[s], z_[s]}, {y_[s], z_[s]}, 0});
    }
    Rod& rod = rod_.back();
    rod.end = place + 1;
    rod.low[0] = std::min(rod.low[0], y_[s]), rod.high[0] = std::max(rod.high[0], y_[s]);
    rod.low[1] = std::min(rod.low[1], z_[s]), rod.high[1] = std::max(rod.high[1], z_[s]);
    rod.maxRadius = std::max(rod.maxRadius, r_[s]);
  }
  rodAt_ = CellHash(places);
}

std::vector<PairSweep::Pairs> PairSweep::find() const {
  tbb::enumerable_thread_specific<Pairs> found;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rod_.size(), kRodGrain), [&](const auto& range) {
    Pairs& pairs = found.local();
    for (std::size_t rod = range.begin(); rod < range.end(); ++rod) sweepAround(rod_[rod], pairs);
  });
  std::vector<Pairs> lists;
  for (Pairs& pairs : found) lists.push_back(std::move(pairs));
  return lists;
}

/// Finds the pairs of the balls of one rod with those of rods that come no earlier: of its own level from its
/// own key on, and of all coarser levels.
void PairSweep::sweepAround(const Rod& rod, Pairs& pairs) const {
  for (std::size_t l = rod.level; l < level_.size(); ++l) {
    const Level& level = level_[l];
    const double far = reach_ * (rod.maxRadius + level.maxRadius);
    const Section first = sectionOf(level, rod.low[0] - far, rod.low[1] - far);
    const Section last = sectionOf(level, rod.high[0] + far, rod.high[1] + far);
    for (std::int64_t z = first.z; z <= last.z; ++z)
      for (std::int64_t y = first.y; y <= last.y; ++y) {
        const std::uint64_t key = keyOf(level, {y, z});
        if (key < rod.key) continue;
        const CellHash::Run& run = rodAt_[key];
        if (run.begin < run.end) sweep(rod, rod_[run.begin], pairs);
      }
  }
}

/// Walks along both rods at once.
void PairSweep::sweep(const Rod& rod, const Rod& other, Pairs& pairs) const {
  const bool toItself = &rod == &other;
  const double widest = reach_ * (rod.maxRadius + other.maxRadius);
  std::int32_t first = other.begin;
  for (std::int32_t s = rod.begin; s < rod.end; ++s) {
    const double x = x_[s], y = y_[s], z = z_[s], r = r_[s], far = reach_ * (r + other.maxRadius);
    while (first < other.end && x_[first] <= x - widest) ++first;
    const double gapY = gapTo(other.low[0], other.high[0], y), gapZ = gapTo(other.low[1], other.high[1], z);
    if (gapY * gapY + gapZ * gapZ >= far * far) continue;
    for (std::int32_t t = toItself ? s + 1 : first; t < other.end && x_[t] < x + far;
         t += static_cast<std::int32_t>(kLanes)) {
      const Lanes dx = loadLanes(&x_[t]) - x, dy = loadLanes(&y_[t]) - y, dz = loadLanes(&z_[t]) - z,
                  near = reach_ * (loadLanes(&r_[t]) + r);
      const LaneMask hit = dx * dx + dy * dy + dz * dz < near * near;
      const std::int32_t lanes = std::min(static_cast<std::int32_t>(kLanes), other.end - t);
      for (std::int32_t k = 0; k < lanes; ++k)
        if (hit[k]) pairs.emplace_back(index_[s], index_[t + k]);
    }
  }
}

}  // namespace spume::foam
