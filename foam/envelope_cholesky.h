#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace spume::foam {

/// A symmetric matrix of 3 x 3 blocks, both halves, row by row; each row has a block on the diagonal.
struct SparseBlocks {
  std::vector<std::int32_t> start;  ///< n + 1
  std::vector<std::int32_t> other;
  std::vector<Eigen::Matrix3d> block;

  std::size_t size() const { return start.empty() ? 0 : start.size() - 1; }
  /// The product with v, three numbers a row.
  void times(const Eigen::VectorXd& v, Eigen::VectorXd& product) const;
};

/// Cholesky factor of a SparseBlocks, for some hundred rows that know only those around them. Rows are
/// numbered by distance from one end, which keeps what couples them near the diagonal [reverse Cuthill and
/// McKee 1969]; a row of the factor reaches from its first coupling to the diagonal and lies in memory as it
/// is read.
class EnvelopeCholesky {
 public:
  /// Chooses the order of the rows, from which of them are coupled alone.
  void order(const SparseBlocks& a);
  /// Factors a matrix of the pattern order() has seen. False where round-off leaves it not positive definite;
  /// solve() then gives 0.
  bool factor(const SparseBlocks& a);
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const;

 private:
  void number(const SparseBlocks& a);
  void layOut(const SparseBlocks& a);
  void copyRow(const SparseBlocks& a, std::size_t row);
  bool factorRow(std::size_t row);
  /// Numbers of each of the three lines of a row, left of the diagonal.
  std::size_t width(std::size_t row) const { return 3 * (row - first_[row]); }
  double* lines(std::size_t row) { return &value_[begin_[row]]; }
  const double* lines(std::size_t row) const { return &value_[begin_[row]]; }
  void fetch(std::size_t& fetched, std::size_t row) const;  ///< of solve(): into the caches

  std::vector<std::int32_t> source_, place_;  ///< the matrix's row behind each of the factor's, and back
  std::vector<std::size_t> first_;            ///< first column of each row, in blocks
  std::vector<std::size_t> begin_;            ///< where its three lines begin
  std::vector<double> value_;
  std::vector<Eigen::Matrix3d> inverse_;  ///< of the factor's diagonal blocks; first the matrix's own
  bool isUsable_ = false;
  mutable Eigen::VectorXd work_;  ///< of solve(), which one thread at a time may call
};

}  // namespace spume::foam
