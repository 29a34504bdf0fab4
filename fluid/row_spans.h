#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/parallel.h"

namespace spume::fluid {

/// For every row of cells along k the range from the first to the last one of interest: lets loops leave out
/// the air far from the liquid at the cost of two numbers a row.
class RowSpans {
 public:
  struct Span {
    int begin, end;  ///< empty if begin >= end
  };
  RowSpans() = default;
  explicit RowSpans(const Eigen::Vector3i& cells);

  /// Finds in every row the range of the cells whose `wanted(value)` of `field` is true.
  template <typename Wanted>
  void find(const DenseField<float>& field, const Wanted& wanted) {
    const int nz = cells_.z();
    forEachRow(cells_, [&](int i, int j) {
      const float* row = &field(i, j, 0);
      Span& span = spans_[i * cells_.y() + j];
      span = {0, nz};
      while (span.begin < nz && !wanted(row[span.begin])) ++span.begin;
      while (span.end > span.begin && !wanted(row[span.end - 1])) --span.end;
      if (span.begin >= span.end) span = {nz, 0};
    });
  }

  /// Copies what a span leaves out of a row of `length` values.
  static void copyOutside(Span span, const float* from, int length, float* to) {
    if (span.begin >= span.end) span = {length, length};
    std::copy(from, from + span.begin, to);
    std::copy(from + span.end, from + length, to + span.end);
  }

  /// Widens the set by `reach` cells along every axis, corners included.
  void grow(int reach);

  Span cells(int i, int j) const { return spans_[i * cells_.y() + j]; }
  /// Range of the faces across `axis` in row (i, j) that bound a cell of the set.
  Span faces(int axis, int i, int j) const;

 private:
  static Span hull(Span a, Span b) { return {std::min(a.begin, b.begin), std::max(a.end, b.end)}; }

  Eigen::Vector3i cells_ = Eigen::Vector3i::Zero();
  std::vector<Span> spans_, scratch_;
};

}  // namespace spume::fluid
