#include "foam/direct_solve.h"

#include <cholmod.h>

#include <algorithm>
#include <new>
#include <vector>

namespace spume::foam {

/// The matrix as CHOLMOD takes it: the lower triangle by columns, three for each bubble.
struct DirectSolve::Internals {
  cholmod_common common;
  cholmod_sparse matrix{};
  cholmod_factor* factor = nullptr;
  std::vector<std::int32_t> columnStart, rowOf, start, other;
  std::vector<double> value, right;

  Internals() {
    cholmod_start(&common);
    common.print = 0;
    common.error_handler = nullptr;
  }
  ~Internals() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Internals(const Internals&) = delete;
  Internals& operator=(const Internals&) = delete;

  bool isPatternOf(const BlockSystem& a) const { return a.start == start && a.other == other; }
  void copyPattern(const BlockSystem& a);
  void copyValues(const BlockSystem& a);
  bool analyse(const BlockSystem& a);
};

/// Rows of column 3 i + c: the lower part of the own block, then the blocks of later neighbours, which come
/// in order.
void DirectSolve::Internals::copyPattern(const BlockSystem& a) {
  start = a.start, other = a.other;
  columnStart.assign(1, 0), rowOf.clear();
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(a.size()); ++i)
    for (int c = 0; c < 3; ++c) {
      for (int r = c; r < 3; ++r) rowOf.push_back(3 * i + r);
      for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e)
        for (int r = 0; a.other[e] > i && r < 3; ++r) rowOf.push_back(3 * a.other[e] + r);
      columnStart.push_back(static_cast<std::int32_t>(rowOf.size()));
    }
  value.resize(rowOf.size()), right.resize(3 * a.size());
  matrix.nrow = matrix.ncol = 3 * a.size();
  matrix.nzmax = rowOf.size();
  matrix.p = columnStart.data(), matrix.i = rowOf.data(), matrix.x = value.data();
  matrix.stype = -1, matrix.itype = CHOLMOD_INT, matrix.xtype = CHOLMOD_REAL, matrix.dtype = CHOLMOD_DOUBLE;
  matrix.sorted = 1, matrix.packed = 1;
}

void DirectSolve::Internals::copyValues(const BlockSystem& a) {
  auto next = value.begin();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Matrix3d diagonal = a.diagonal(i);
    for (int c = 0; c < 3; ++c) {
      for (int r = c; r < 3; ++r) *next++ = diagonal(r, c);
      for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
        if (a.other[e] <= static_cast<std::int32_t>(i)) continue;
        const CouplingBlock& block = a.block[e];
        const Eigen::Vector3d along = block.along();
        for (int r = 0; r < 3; ++r) *next++ = -(along[r] * along[c] + (r == c ? block.across() : 0.0));
      }
    }
  }
}

bool DirectSolve::Internals::analyse(const BlockSystem& a) {
  copyPattern(a);
  cholmod_free_factor(&factor, &common);
  factor = cholmod_analyze(&matrix, &common);
  return factor != nullptr;
}

DirectSolve::DirectSolve() : internals_(std::make_unique<Internals>()) {}
DirectSolve::~DirectSolve() = default;
DirectSolve::DirectSolve(DirectSolve&&) noexcept = default;
DirectSolve& DirectSolve::operator=(DirectSolve&&) noexcept = default;

bool DirectSolve::factor(const BlockSystem& a) {
  Internals& s = *internals_;
  if (a.size() == 0) return true;
  if (!s.isPatternOf(a) && !s.analyse(a)) return false;
  if (s.factor == nullptr || s.common.lnz > kLargestFactor) return false;
  s.copyValues(a);
  return cholmod_factorize(&s.matrix, s.factor, &s.common) && s.common.status == CHOLMOD_OK &&
         s.factor->minor == s.matrix.ncol;
}

void DirectSolve::improve(const Vectors3& b, Vectors3& x) {
  Internals& s = *internals_;
  if (b.empty()) return;
  for (std::size_t i = 0; i < b.size(); ++i)
    for (int c = 0; c < 3; ++c) s.right[3 * i + c] = b[i][c];
  cholmod_dense right{};
  right.nrow = right.d = right.nzmax = s.right.size(), right.ncol = 1;
  right.x = s.right.data(), right.xtype = CHOLMOD_REAL, right.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, s.factor, &right, &s.common);
  if (solution == nullptr) throw std::bad_alloc();
  const double* value = static_cast<const double*>(solution->x);
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int c = 0; c < 3; ++c) x[i][c] += value[3 * i + c];
  cholmod_free_dense(&solution, &s.common);
}

}  // namespace spume::foam
