#include "foam/swept_system.h"

#include <algorithm>

#include "foam/parallel.h"

namespace spume::foam {

void SweptSystem::copy(const BlockSystem& a, bool sweeps) {
  const std::size_t n = a.size();
  row.resize(n), diagonal.resize(n), own_.resize(n), changed.assign(n, 1);
  cutBlocks(a);
  forEachIndex(n, [&](std::size_t k) { row[k] = countRow(a, k, sweeps); });
  std::int32_t entries = 0;
  for (Row& r : row) {
    for (std::int32_t* place : {&r.ahead, &r.behind, &r.beyond, &r.end}) *place += entries;
    entries = r.end;
  }
  other.assign(entries + kPadding, static_cast<std::int32_t>(n));
  coupling.assign(entries + kPadding, Coupling::Zero());
  forEachIndex(n, [&](std::size_t k) { copyRow(a, k, sweeps), sumDiagonal(a, k); });
}

/// Cuts the rows into blocks of equal work: a bubble among others costs several times one that is alone.
void SweptSystem::cutBlocks(const BlockSystem& a) {
  constexpr std::size_t kOwnWork = 6;  // of a row without couplings, in couplings
  const std::size_t n = a.size();
  std::size_t groups = std::max(kLeastGroups, (n + kAbreast * kBlockRows - 1) / (kAbreast * kBlockRows));
  groups = std::max<std::size_t>(1, std::min(groups, n / (kAbreast * kLeastRows)));
  const std::size_t blocks = std::min(kAbreast * groups, std::max<std::size_t>(1, n / kLeastRows));
  const std::size_t all = kOwnWork * n + a.other.size();
  blockStart_.assign(kAbreast * groups + 1, n), blockOf_.resize(n);
  std::size_t work = 0, block = 0;
  blockStart_[0] = 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (work * blocks >= (block + 1) * all && block + 1 < blocks) blockStart_[++block] = k;
    blockOf_[k] = static_cast<std::uint32_t>(block);
    work += kOwnWork + static_cast<std::size_t>(a.start[k + 1] - a.start[k]);
  }
}

SweptSystem::Kind SweptSystem::kindOf(std::size_t k, std::size_t other, bool sweeps) const {
  if (!sweeps || blockOf_[other] != blockOf_[k]) return Kind::beyond;
  return other > k ? Kind::ahead : Kind::behind;
}

/// The places of a row that begins at 0.
SweptSystem::Row SweptSystem::countRow(const BlockSystem& a, std::size_t k, bool sweeps) const {
  std::int32_t count[3] = {};
  for (std::int32_t e = a.start[k]; e < a.start[k + 1]; ++e)
    ++count[static_cast<int>(kindOf(k, a.other[e], sweeps))];
  return {0, count[0], count[0] + count[1], count[0] + count[1] + count[2]};
}

/// Couplings of one kind stay in the order of the BlockSystem.
void SweptSystem::copyRow(const BlockSystem& a, std::size_t k, bool sweeps) {
  const auto nobody = static_cast<std::int32_t>(a.size());
  std::int32_t place[3] = {row[k].ahead, row[k].behind, row[k].beyond};
  for (std::int32_t e = a.start[k]; e < a.start[k + 1]; ++e) {
    const Kind kind = kindOf(k, a.other[e], sweeps);
    const std::int32_t to = place[static_cast<int>(kind)]++;
    other[to] = a.other[e] + (kind == Kind::behind ? nobody + 1 : 0);
    coupling[to] << a.block[e].along.cast<float>(), static_cast<float>(a.block[e].across);
  }
}

void SweptSystem::sumDiagonal(const BlockSystem& a, std::size_t k) {
  Eigen::Matrix3d sum = own_[k] = a.own[k];
  for (std::int32_t e = row[k].ahead; e < row[k].end; ++e) sum += matrixOf(coupling[e]);
  diagonal[k] = sum;
}

void SweptSystem::refresh(const BlockSystem& a) {
  forEachIndex(size(), [&](std::size_t k) {
    changed[k] = own_[k] != a.own[k];
    if (changed[k]) sumDiagonal(a, k);
  });
}

}  // namespace spume::foam
