#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "foam/block_system.h"
#include "foam/crew.h"
#include "foam/flush_tiny.h"
#include "foam/quad_lanes.h"
#include "foam/symmetric_block.h"

namespace spume::foam {

/// A BlockSystem laid out for sweeps of conjugate gradients: rows cut into blocks, each row with two runs of
/// couplings, those with rows swept later and all others.
///
/// Blocks are consecutive rows, and what couples two of them an incomplete factor would not know. So the rows
/// at their borders are taken out and swept in a round of their own when the inner rows of every block are
/// done, as the separators of nested dissection [George 1973]. Only couplings between blocks of border rows
/// are lost to the factor.
///
/// Blocks are swept side by side, kAbreast of them at a time: a row waits for the one before it, and others
/// fill the wait. Rows are numbered anew in the order in which they are swept, so that whatever a sweep reads
/// it reads from one end to the other, which memory does several times faster than many places in turns.
struct SweptSystem {
  /// Rows of a block, on average at most: the larger, the better the factor; the smaller, the more threads,
  /// of which a few use up all that memory gives.
  static constexpr std::size_t kBlockRows = 16384;
  static constexpr std::size_t kAbreast = 2;  ///< blocks a thread sweeps side by side, a group
  static constexpr std::size_t kLeastGroups = 2;
  /// Rows of a block on average, at least: below, a cut costs more than it gains.
  static constexpr std::size_t kLeastRows = 512;

  /// along [kg^1/2] and, last, across [kg] of a CouplingBlock.
  using Coupling = Eigen::Vector4f;

  /// Couplings one row after the other. Behind the last come kPadding of 0 with row n, for whole registers
  /// to read.
  struct Couplings {
    static constexpr std::int32_t kPadding = 4;
    std::vector<std::int32_t> other;
    std::vector<Coupling> block;

    /// Room for n, not set, and the padding.
    void resize(std::int32_t n, std::int32_t nobody) {
      other.resize(n + kPadding), block.resize(n + kPadding);
      std::fill(other.end() - kPadding, other.end(), nobody);
      std::fill(block.end() - kPadding, block.end(), Coupling::Zero());
    }
  };
  /// Where a row's couplings begin, by kind; each kind ends where the next row's begins.
  struct Row {
    std::int32_t ahead;   ///< in `ahead`
    std::int32_t behind;  ///< in `known`: first those with rows swept earlier
    std::int32_t beyond;  ///< in `known`: then those with rows that are swept at the same time
  };

  std::vector<Row> row;  ///< n + 1
  Couplings ahead;       ///< with rows swept later: swept back
  /// With all others: swept forth. `other` is the place of the other row's number in a list of 2 n + 2: its
  /// own where it is beyond, n + 1 more where it is behind.
  Couplings known;
  std::vector<Eigen::Matrix3d> diagonal;  ///< own block and all couplings [kg]
  std::vector<std::int32_t> source;       ///< each row's number in the BlockSystem

  std::size_t size() const { return source.size(); }
  /// All groups: those of inner rows, then as many of border rows or none.
  std::size_t groups() const { return groupStart_.size() - 1; }
  /// Groups of a round, which are the tasks of a crew.
  std::size_t tasks() const { return tasks_; }
  /// Where row i of the BlockSystem stands here.
  std::int32_t placeOf(std::size_t i) const { return spot_[i].place; }
  /// The rows of group g are groupStart()[g] .. groupStart()[g + 1] - 1.
  const std::vector<std::size_t>& groupStart() const { return groupStart_; }

  /// Copies `a`. With `sweeps` false all couplings count as beyond their block: nothing to sweep along.
  void copy(const BlockSystem& a, bool sweeps);
  /// A row whose own block has changed.
  struct Growth {
    std::int32_t row;    ///< here
    Eigen::Matrix3d by;  ///< what its diagonal has grown by [kg]
  };
  /// Copies the own blocks of `rows` again, which is all that has changed.
  const std::vector<Growth>& refresh(const BlockSystem& a, const std::vector<std::int32_t>& rows);

 private:
  enum Kind : std::uint8_t { kAhead = 0, kBehind = 1, kBeyond = 2 };
  /// Of a row of the BlockSystem: its row here, and its block.
  struct Spot {
    std::int32_t place;
    std::uint32_t block;
  };

  void cutBlocks(const BlockSystem& a, bool sweeps);
  void findBorders(const BlockSystem& a);
  void cutAll(const BlockSystem& a, std::size_t blocks);
  void cutBorders(const BlockSystem& a, std::size_t blocks);
  void orderRows();
  Kind kindOf(const Spot& row, const Spot& other) const;
  Row countRow(const BlockSystem& a, std::size_t k) const;
  void copyRow(const BlockSystem& a, std::size_t k);
  Eigen::Matrix3d sumDiagonal(const BlockSystem& a, std::size_t k) const;

  bool sweeps_ = false;  ///< as copy() was told
  std::size_t tasks_ = 1;
  std::vector<std::size_t> groupStart_ = {0};
  std::vector<std::vector<std::int32_t>> blocks_;  ///< rows of the BlockSystem by block, kAbreast a group
  std::vector<std::int32_t> borders_;              ///< border rows of the BlockSystem
  std::vector<std::uint8_t> isBorder_;             ///< by rows of the BlockSystem
  std::uint32_t firstBorder_ = 0;                  ///< block of border rows
  std::vector<Spot> spot_;                         ///< of each of the BlockSystem's rows
  std::vector<Growth> growth_;                     ///< of the last refresh()
};

/// Calls body(group) for all groups, those of inner rows first.
template <typename Body>
void forEachGroupForth(Crew& crew, const SweptSystem& a, const Body& body) {
  for (std::size_t first = 0; first < a.groups(); first += a.tasks())
    crew.forEachTask([&](std::size_t task) {
      const FlushTiny flush;
      body(first + task);
    });
}

/// The same, those of border rows first.
template <typename Body>
void forEachGroupBack(Crew& crew, const SweptSystem& a, const Body& body) {
  for (std::size_t end = a.groups(); end > 0; end -= a.tasks())
    crew.forEachTask([&](std::size_t task) {
      const FlushTiny flush;
      body(end - a.tasks() + task);
    });
}

/// Calls body(group, row) for the rows of each group, and so of each block, in order. The crew has a.tasks()
/// tasks.
template <typename Body>
void sweepForth(Crew& crew, const SweptSystem& a, const Body& body) {
  forEachGroupForth(crew, a, [&](std::size_t group) {
    const std::size_t last = a.groupStart()[group + 1];
    for (std::size_t k = a.groupStart()[group]; k < last; ++k) body(group, k);
  });
}

/// Sums over the rows of a group, up to three; a cache line each.
struct alignas(64) GroupSums {
  double of[3] = {};

  void set(const DoubleQuad* sums, int count) {
    for (int i = 0; i < count; ++i) of[i] = sums[i][0] + sums[i][1] + sums[i][2];
  }
};

/// sweepForth with kCount sums for each group: body(group, row, sums) adds quads of products to them, of
/// which the first three numbers count. They stay in registers, and what is added to them one quad at a time
/// takes a quarter of the instructions.
template <int kCount, typename Body>
void sumForth(Crew& crew, const SweptSystem& a, std::vector<GroupSums>& sums, const Body& body) {
  sums.resize(a.groups());
  forEachGroupForth(crew, a, [&](std::size_t group) {
    const std::size_t end = a.groupStart()[group + 1];
    DoubleQuad of[kCount] = {};
    for (std::size_t k = a.groupStart()[group]; k < end; ++k) body(group, k, of);
    sums[group].set(of, kCount);
  });
}

/// The same from last to first, with body(row, sums).
template <int kCount, typename Body>
void sumBack(Crew& crew, const SweptSystem& a, std::vector<GroupSums>& sums, const Body& body) {
  sums.resize(a.groups());
  forEachGroupBack(crew, a, [&](std::size_t group) {
    const std::size_t begin = a.groupStart()[group];
    DoubleQuad of[kCount] = {};
    for (std::size_t k = a.groupStart()[group + 1]; k > begin; --k) body(k - 1, of);
    sums[group].set(of, kCount);
  });
}

}  // namespace spume::foam
