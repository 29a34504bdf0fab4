#include "foam/swept_system.h"

#include <algorithm>
#include <bit>

#include "foam/parallel.h"

namespace spume::foam {

void SweptSystem::copy(const BlockSystem& a, bool sweeps) {
  const std::size_t n = a.size();
  orderRows(cutBlocks(a));
  row.resize(n + 1), diagonal.resize(n);
  forEachIndex(n, [&](std::size_t k) { row[k] = countRow(a, k, sweeps); });
  std::int32_t inAhead = 0, inKnown = 0;
  row[n] = {};
  for (Row& r : row) {
    const Row count = r;
    r = {inAhead, inKnown, inKnown + count.behind};
    inAhead += count.ahead, inKnown += count.behind + count.beyond;
  }
  ahead.resize(inAhead, static_cast<std::int32_t>(n)), known.resize(inKnown, static_cast<std::int32_t>(n));
  forEachIndex(n, [&](std::size_t k) { copyRow(a, k, sweeps), sumDiagonal(a, k); });
}

/// Cuts the rows into blocks of equal work: a bubble among others costs several times one that is alone.
/// Returns where each block begins, kAbreast of them for each group; the last may be empty.
std::vector<std::size_t> SweptSystem::cutBlocks(const BlockSystem& a) {
  constexpr std::size_t kOwnWork = 6;  // of a row without couplings, in couplings
  const std::size_t n = a.size();
  std::size_t groups = std::max(kLeastGroups, (n + kAbreast * kBlockRows - 1) / (kAbreast * kBlockRows));
  groups = std::bit_ceil(groups);  // of which 2, 4, 8 threads get as many each
  groups = std::max<std::size_t>(1, std::min(groups, n / (kAbreast * kLeastRows)));
  const std::size_t blocks = std::min(kAbreast * groups, std::max<std::size_t>(1, n / kLeastRows));
  const std::size_t all = kOwnWork * n + a.other.size();
  std::vector<std::size_t> start(kAbreast * groups + 1, n);
  blockOf_.resize(n);
  std::size_t work = 0, block = 0;
  start[0] = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (work * blocks >= (block + 1) * all && block + 1 < blocks) start[++block] = i;
    blockOf_[i] = static_cast<std::uint32_t>(block);
    work += kOwnWork + static_cast<std::size_t>(a.start[i + 1] - a.start[i]);
  }
  return start;
}

/// Goes through the blocks of each group at speeds at which all end together.
void SweptSystem::orderRows(const std::vector<std::size_t>& start) {
  source.clear(), source.reserve(start.back());
  groupStart_ = {0};
  for (std::size_t first = 0; first + 1 < start.size(); first += kAbreast) {
    std::size_t longest = 0, next[kAbreast];
    for (std::size_t b = 0; b < kAbreast; ++b) {
      next[b] = start[first + b];
      longest = std::max(longest, start[first + b + 1] - next[b]);
    }
    for (std::size_t k = 1; k <= longest; ++k)
      for (std::size_t b = 0; b < kAbreast; ++b) {
        const std::size_t begin = start[first + b], rows = start[first + b + 1] - begin;
        if ((next[b] - begin) * longest < k * rows) source.push_back(static_cast<std::int32_t>(next[b]++));
      }
    groupStart_.push_back(source.size());
  }
  place_.resize(source.size());
  forEachIndex(source.size(), [&](std::size_t k) { place_[source[k]] = static_cast<std::int32_t>(k); });
}

/// Of a coupling between two rows of the BlockSystem.
SweptSystem::Kind SweptSystem::kindOf(std::int32_t source, std::int32_t other, bool sweeps) const {
  if (!sweeps || blockOf_[other] != blockOf_[source]) return Kind::beyond;
  return other > source ? Kind::ahead : Kind::behind;
}

/// How many couplings of each kind a row has.
SweptSystem::Row SweptSystem::countRow(const BlockSystem& a, std::size_t k, bool sweeps) const {
  const std::int32_t i = source[k];
  std::int32_t count[3] = {};
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e)
    ++count[static_cast<int>(kindOf(i, a.other[e], sweeps))];
  return {count[0], count[1], count[2]};
}

/// Couplings of one kind stay in the order of the BlockSystem.
void SweptSystem::copyRow(const BlockSystem& a, std::size_t k, bool sweeps) {
  const auto nobody = static_cast<std::int32_t>(a.size());
  const std::int32_t i = source[k];
  std::int32_t place[3] = {row[k].ahead, row[k].behind, row[k].beyond};
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
    const Kind kind = kindOf(i, a.other[e], sweeps);
    const std::int32_t to = place[static_cast<int>(kind)]++;
    Couplings& of = kind == Kind::ahead ? ahead : known;
    of.other[to] = place_[a.other[e]] + (kind == Kind::behind ? nobody + 1 : 0);
    of.block[to] << a.block[e].along.cast<float>(), static_cast<float>(a.block[e].across);
  }
}

void SweptSystem::sumDiagonal(const BlockSystem& a, std::size_t k) {
  Eigen::Matrix3d sum = a.own[source[k]];
  for (std::int32_t e = row[k].ahead; e < row[k + 1].ahead; ++e) sum += matrixOf(ahead.block[e]);
  for (std::int32_t e = row[k].behind; e < row[k + 1].behind; ++e) sum += matrixOf(known.block[e]);
  diagonal[k] = sum;
}

const std::vector<std::int32_t>& SweptSystem::refresh(const BlockSystem& a,
                                                      const std::vector<std::int32_t>& rows) {
  refreshed_.resize(rows.size());
  forEachIndex(rows.size(), [&](std::size_t r) { sumDiagonal(a, refreshed_[r] = place_[rows[r]]); });
  return refreshed_;
}

}  // namespace spume::foam
