#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "foam/block_system.h"
#include "foam/symmetric_block.h"

namespace spume::foam {

/// A BlockSystem laid out for sweeps of conjugate gradients: rows in space order, cut into blocks of
/// consecutive rows. Couplings within a block are split into those with rows before and after; couplings to
/// other blocks stand apart. Couplings are kept in single precision: the matrix differs by 1e-7 of each
/// spring, which one refinement against the BlockSystem undoes, and a sweep moves half the memory.
struct SweptSystem {
  static constexpr std::size_t kBlockRows =
      2048;  ///< few enough for many threads, enough for their inside to count

  /// along [kg^1/2] and, last, across [kg] of a CouplingBlock.
  using Coupling = Eigen::Vector4f;
  static Eigen::Matrix3d matrixOf(const Coupling& coupling) {
    const Eigen::Vector3d along = coupling.head<3>().cast<double>();
    return along * along.transpose() + static_cast<double>(coupling.w()) * Eigen::Matrix3d::Identity();
  }

  /// Where a row's couplings begin, by kind.
  struct Row {
    std::int32_t start;   ///< couplings with earlier rows of the block
    std::int32_t after;   ///< first with later rows of the block
    std::int32_t beyond;  ///< first with other blocks
    std::int32_t end;
  };

  std::vector<std::int32_t> order;  ///< row of the BlockSystem behind each row here
  std::vector<Row> row;
  std::vector<std::int32_t> other;  ///< row here
  std::vector<Coupling> coupling;
  std::vector<SymmetricBlock> diagonal;  ///< own block and all couplings [kg]

  std::size_t size() const { return row.size(); }
  std::size_t blocks() const { return (size() + kBlockRows - 1) / kBlockRows; }

  /// Copies the couplings of `a`. With `sweeps` false all couplings count as beyond their block: nothing to
  /// sweep along.
  void copy(const BlockSystem& a, bool sweeps);
  /// Copies its own blocks, once its couplings are here.
  void copyDiagonals(const BlockSystem& a);

 private:
  void copyRow(const BlockSystem& a, std::size_t k, bool sweeps);

  std::vector<std::int32_t> rank_;  ///< row here of each row of the BlockSystem
};

/// Calls body(first row, one past the last row) for each block, in parallel.
template <typename Body>
void forEachBlock(const SweptSystem& a, const Body& body) {
  const auto visit = [&](std::size_t block) {
    const std::size_t first = block * SweptSystem::kBlockRows;
    body(first, std::min(first + SweptSystem::kBlockRows, a.size()));
  };
  if (a.blocks() == 1)
    visit(0);
  else
    tbb::parallel_for(std::size_t{0}, a.blocks(), visit);
}

}  // namespace spume::foam
