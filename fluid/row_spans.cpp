#include "fluid/row_spans.h"

namespace spume::fluid {

RowSpans::RowSpans(const Eigen::Vector3i& cells)
    : cells_(cells), spans_(cells.x() * cells.y(), Span{cells.z(), 0}), scratch_(spans_.size()) {}

void RowSpans::grow(int reach) {
  const int nx = cells_.x(), ny = cells_.y(), nz = cells_.z();
  const Span nothing{nz, 0};
  tbb::parallel_for(0, nx, [&](int i) {
    for (int j = 0; j < ny; ++j) {
      Span widest = nothing;
      for (int n = std::max(j - reach, 0); n <= std::min(j + reach, ny - 1); ++n)
        widest = hull(widest, spans_[i * ny + n]);
      scratch_[i * ny + j] = widest;
    }
  });
  tbb::parallel_for(0, nx, [&](int i) {
    for (int j = 0; j < ny; ++j) {
      Span widest = nothing;
      for (int n = std::max(i - reach, 0); n <= std::min(i + reach, nx - 1); ++n)
        widest = hull(widest, scratch_[n * ny + j]);
      const bool empty = widest.begin >= widest.end;
      spans_[i * ny + j] =
          empty ? nothing : Span{std::max(widest.begin - reach, 0), std::min(widest.end + reach, nz)};
    }
  });
}

RowSpans::Span RowSpans::faces(int axis, int i, int j) const {
  if (axis == 2) {
    const Span row = cells(i, j);
    return {row.begin, row.begin < row.end ? row.end + 1 : row.end};
  }
  const Eigen::Vector3i lower = Eigen::Vector3i(i, j, 0) - Eigen::Vector3i::Unit(axis);
  Span span{cells_.z(), 0};
  if (i < cells_.x() && j < cells_.y()) span = cells(i, j);
  if (lower[axis] >= 0) span = hull(span, cells(lower.x(), lower.y()));
  return span;
}

}  // namespace spume::fluid
