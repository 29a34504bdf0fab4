#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "foam/block_system.h"
#include "foam/crew.h"
#include "foam/flush_tiny.h"
#include "foam/symmetric_block.h"

namespace spume::foam {

/// A BlockSystem laid out for sweeps of conjugate gradients: rows cut into blocks of consecutive rows, each
/// row with two runs of couplings, those with later rows of its block and all others. Couplings are
/// kept in single precision: the matrix differs by 1e-7 of each spring, which one refinement against the
/// BlockSystem undoes, and a sweep moves half the memory.
struct SweptSystem {
  /// Rows of a block, on average at most: the larger, the better the factor; the fewer, the more threads.
  static constexpr std::size_t kBlockRows = 4096;
  static constexpr std::size_t kAbreast = 4;  ///< blocks a thread sweeps side by side
  static constexpr std::size_t kLeastGroups = 2;
  /// Rows of a block on average, at least: below, a cut costs more than it gains.
  static constexpr std::size_t kLeastRows = 512;
  /// Entries behind the last coupling, 0, that whole registers may read.
  static constexpr std::int32_t kPadding = 4;

  /// along [kg^1/2] and, last, across [kg] of a CouplingBlock.
  using Coupling = Eigen::Vector4f;
  static Eigen::Matrix3d matrixOf(const Coupling& coupling) {
    const Eigen::Vector3d along = coupling.head<3>().cast<double>();
    return along * along.transpose() + static_cast<double>(coupling.w()) * Eigen::Matrix3d::Identity();
  }

  /// Where a row's couplings begin, by kind.
  struct Row {
    std::int32_t ahead;   ///< couplings with later rows of the block
    std::int32_t behind;  ///< first with earlier rows of the block
    std::int32_t beyond;  ///< first with other blocks
    std::int32_t end;
  };

  std::vector<Row> row;
  /// Place of the other row's number in a list of 2 n + 2: its own number where it is ahead or in another
  /// block, n + 1 more where it is behind in this block. Padding has n.
  std::vector<std::int32_t> other;
  std::vector<Coupling> coupling;
  std::vector<Eigen::Matrix3d> diagonal;  ///< own block and all couplings [kg]
  std::vector<std::uint8_t> changed;      ///< diagonals the last refresh() has changed

  std::size_t size() const { return row.size(); }
  std::size_t groups() const { return (blockStart_.size() - 1) / kAbreast; }
  /// The rows of block `block` of kAbreast x groups() are blockStart()[block] .. blockStart()[block + 1] - 1.
  const std::vector<std::size_t>& blockStart() const { return blockStart_; }

  /// Rows of the longest of kAbreast blocks.
  static std::size_t longestBlock(const std::size_t* start) {
    std::size_t longest = 0;
    for (std::size_t block = 0; block < kAbreast; ++block)
      longest = std::max(longest, start[block + 1] - start[block]);
    return longest;
  }

  /// Copies `a`. With `sweeps` false all couplings count as beyond their block: nothing to sweep along.
  void copy(const BlockSystem& a, bool sweeps);
  /// Copies its own blocks again where they have changed; its couplings must not have.
  void refresh(const BlockSystem& a);

 private:
  enum class Kind : std::uint8_t { ahead, behind, beyond };
  void cutBlocks(const BlockSystem& a);
  Kind kindOf(std::size_t k, std::size_t other, bool sweeps) const;
  Row countRow(const BlockSystem& a, std::size_t k, bool sweeps) const;
  void copyRow(const BlockSystem& a, std::size_t k, bool sweeps);
  void sumDiagonal(const BlockSystem& a, std::size_t k);

  std::vector<std::size_t> blockStart_ = {0};
  std::vector<std::uint32_t> blockOf_;  ///< each row's
  std::vector<Eigen::Matrix3d> own_;    ///< of the BlockSystem, as last copied [kg]
};

/// Calls body(group, row) for the rows of each block in order. The blocks of a group go side by side, the
/// first row of each, then the second: a row waits for the one before it, and others fill the wait. Groups
/// are the crew's tasks.
template <typename Body>
void sweepForth(Crew& crew, const SweptSystem& a, const Body& body) {
  crew.forEachTask([&](std::size_t group) {
    const FlushTiny flush;
    const std::size_t* start = &a.blockStart()[SweptSystem::kAbreast * group];
    const std::size_t longest = SweptSystem::longestBlock(start);
    for (std::size_t k = 0; k < longest; ++k)
      for (std::size_t block = 0; block < SweptSystem::kAbreast; ++block)
        if (start[block] + k < start[block + 1]) body(group, start[block] + k);
  });
}

/// The same with the rows of each block from last to first.
template <typename Body>
void sweepBack(Crew& crew, const SweptSystem& a, const Body& body) {
  crew.forEachTask([&](std::size_t group) {
    const FlushTiny flush;
    const std::size_t* start = &a.blockStart()[SweptSystem::kAbreast * group];
    const std::size_t longest = SweptSystem::longestBlock(start);
    for (std::size_t k = 1; k <= longest; ++k)
      for (std::size_t block = 0; block < SweptSystem::kAbreast; ++block)
        if (start[block] + k <= start[block + 1]) body(group, start[block + 1] - k);
  });
}

}  // namespace spume::foam
