#include "foam/swept_system.h"

#include <algorithm>
#include <bit>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

constexpr std::size_t kOwnWork = 6;  ///< of a row without couplings, in couplings

}  // namespace

void SweptSystem::copy(const BlockSystem& a, bool sweeps) {
  const std::size_t n = a.size();
  sweeps_ = sweeps;
  cutBlocks(a, sweeps), orderRows();
  row.resize(n + 1), diagonal.resize(n);
  forEachIndex(n, [&](std::size_t k) { row[k] = countRow(a, k); });
  std::int32_t inAhead = 0, inKnown = 0;
  row[n] = {};
  for (Row& r : row) {
    const Row count = r;
    r = {inAhead, inKnown, inKnown + count.behind};
    inAhead += count.ahead, inKnown += count.behind + count.beyond;
  }
  ahead.resize(inAhead, static_cast<std::int32_t>(n)), known.resize(inKnown, static_cast<std::int32_t>(n));
  forEachIndex(n, [&](std::size_t k) { copyRow(a, k); });
}

/// As many blocks for each group of inner rows and of border rows, kAbreast; the last of them may be empty.
void SweptSystem::cutBlocks(const BlockSystem& a, bool sweeps) {
  const std::size_t n = a.size();
  std::size_t groups = std::max(kLeastGroups, (n + kAbreast * kBlockRows - 1) / (kAbreast * kBlockRows));
  groups = std::bit_ceil(groups);  // of which 2, 4, 8 threads get as many each
  tasks_ = std::max<std::size_t>(1, std::min(groups, n / (kAbreast * kLeastRows)));
  const std::size_t most = kAbreast * tasks_,
                    blocks = std::min(most, std::max<std::size_t>(1, n / kLeastRows));
  const bool hasBorders = sweeps && blocks > 1;
  blocks_.resize(hasBorders ? 2 * most : most);
  for (auto& block : blocks_) block.clear();
  firstBorder_ = static_cast<std::uint32_t>(most);
  cutAll(a, blocks);
  if (hasBorders) findBorders(a), cutBorders(a, blocks);
  for (std::size_t i = 0; i < n; ++i) blocks_[spot_[i].block].push_back(static_cast<std::int32_t>(i));
}

/// Those with a neighbour in a later block, without which no two blocks touch.
void SweptSystem::findBorders(const BlockSystem& a) {
  isBorder_.resize(a.size());
  forEachIndex(a.size(), [&](std::size_t i) {
    const auto isLater = [&](std::int32_t j) { return spot_[j].block > spot_[i].block; };
    isBorder_[i] = std::any_of(a.other.begin() + a.start[i], a.other.begin() + a.start[i + 1], isLater);
  });
  borders_.clear();
  for (std::size_t i = 0; i < a.size(); ++i)
    if (isBorder_[i]) borders_.push_back(static_cast<std::int32_t>(i));
}

/// Cuts all rows into blocks of equal work: a bubble among others costs several times one that is alone.
void SweptSystem::cutAll(const BlockSystem& a, std::size_t blocks) {
  const auto workBefore = [&](std::size_t i) { return kOwnWork * i + static_cast<std::size_t>(a.start[i]); };
  const std::size_t all = workBefore(a.size());
  spot_.resize(a.size());
  forEachIndex(a.size(), [&](std::size_t i) {
    spot_[i].block = static_cast<std::uint32_t>(workBefore(i) * blocks / all);
  });
}

/// The same with border rows alone.
void SweptSystem::cutBorders(const BlockSystem& a, std::size_t blocks) {
  const auto workOf = [&](std::int32_t i) {
    return kOwnWork + static_cast<std::size_t>(a.start[i + 1] - a.start[i]);
  };
  std::size_t all = 0, work = 0;
  for (const std::int32_t i : borders_) all += workOf(i);
  for (const std::int32_t i : borders_) {
    spot_[i].block = firstBorder_ + static_cast<std::uint32_t>(work * blocks / all);
    work += workOf(i);
  }
}

/// Goes through the blocks of each group at speeds at which all end together.
void SweptSystem::orderRows() {
  source.clear(), source.reserve(spot_.size());
  groupStart_ = {0};
  for (std::size_t first = 0; first < blocks_.size(); first += kAbreast) {
    std::size_t longest = 0, next[kAbreast] = {};
    for (std::size_t b = 0; b < kAbreast; ++b) longest = std::max(longest, blocks_[first + b].size());
    for (std::size_t k = 1; k <= longest; ++k)
      for (std::size_t b = 0; b < kAbreast; ++b) {
        const std::vector<std::int32_t>& rows = blocks_[first + b];
        if (next[b] * longest < k * rows.size()) source.push_back(rows[next[b]++]);
      }
    groupStart_.push_back(source.size());
  }
  forEachIndex(source.size(), [&](std::size_t k) { spot_[source[k]].place = static_cast<std::int32_t>(k); });
}

/// Of a coupling between two rows of the BlockSystem, of which one block or the round of border rows sweeps
/// one after the other. Without branches, which nothing could foretell.
inline SweptSystem::Kind SweptSystem::kindOf(const Spot& row, const Spot& other) const {
  const bool inTurn =
      (row.block == other.block) | ((row.block < firstBorder_) != (other.block < firstBorder_));
  const std::uint8_t isEarlier = other.place < row.place, beyond = kBeyond;
  return static_cast<Kind>(inTurn & sweeps_ ? isEarlier : beyond);
}

/// How many couplings of each kind a row has.
SweptSystem::Row SweptSystem::countRow(const BlockSystem& a, std::size_t k) const {
  const std::int32_t i = source[k];
  std::int32_t count[3] = {};
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) ++count[kindOf(spot_[i], spot_[a.other[e]])];
  return {count[kAhead], count[kBehind], count[kBeyond]};
}

/// Couplings of one kind stay in the order of the BlockSystem.
void SweptSystem::copyRow(const BlockSystem& a, std::size_t k) {
  const auto nobody = static_cast<std::int32_t>(a.size());
  const std::int32_t i = source[k];
  const Spot spot = spot_[i];
  std::int32_t* other[3] = {&ahead.other[row[k].ahead], &known.other[row[k].behind],
                            &known.other[row[k].beyond]};
  Coupling* block[3] = {&ahead.block[row[k].ahead], &known.block[row[k].behind], &known.block[row[k].beyond]};
  const std::int32_t shift[3] = {0, nobody + 1, 0};
  SymmetricSum sum(a.own[i]);
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
    const Spot& at = spot_[a.other[e]];
    const Kind kind = kindOf(spot, at);
    *other[kind]++ = at.place + shift[kind];
    *block[kind]++ = a.block[e].number;
    sum.add(a.block[e].number);
  }
  diagonal[k] = sum.matrix();
}

Eigen::Matrix3d SweptSystem::sumDiagonal(const BlockSystem& a, std::size_t k) const {
  SymmetricSum sum(a.own[source[k]]);
  for (std::int32_t e = row[k].ahead; e < row[k + 1].ahead; ++e) sum.add(ahead.block[e]);
  for (std::int32_t e = row[k].behind; e < row[k + 1].behind; ++e) sum.add(known.block[e]);
  return sum.matrix();
}

const std::vector<SweptSystem::Growth>& SweptSystem::refresh(const BlockSystem& a,
                                                             const std::vector<std::int32_t>& rows) {
  growth_.resize(rows.size());
  forEachIndex(rows.size(), [&](std::size_t r) {
    const std::int32_t k = placeOf(rows[r]);
    const Eigen::Matrix3d now = sumDiagonal(a, k);
    growth_[r] = {k, now - diagonal[k]};
    diagonal[k] = now;
  });
  return growth_;
}

}  // namespace spume::foam
