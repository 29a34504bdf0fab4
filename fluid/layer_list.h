#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fluid/dense_field.h"

namespace spume::fluid {

/// Indices of points given by their offsets in a field: divides only where a new row begins, so that lists in
/// the order of the offsets are cheap to walk.
class RowCursor {
 public:
  template <typename T>
  explicit RowCursor(const DenseField<T>& field)
      : strideI_(static_cast<int>(field.stride(0))), strideJ_(static_cast<int>(field.stride(1))) {}

  /// Moves to an offset; returns true if it lies in another row than the one before.
  bool seek(std::int32_t offset) {
    k = offset - row_ - kGhost;
    if (static_cast<std::uint32_t>(offset - row_) < static_cast<std::uint32_t>(strideJ_)) return false;
    i = offset / strideI_ - kGhost;
    j = offset % strideI_ / strideJ_ - kGhost;
    k = offset % strideJ_ - kGhost;
    row_ = offset - k - kGhost;
    return true;
  }

  int i = 0, j = 0, k = 0;

 private:
  int strideI_, strideJ_;
  std::int32_t row_ = -(1 << 20);  ///< offset at which the row begins; at first none
};

/// Points of a window grouped by their distance in face-neighbour steps from a seed set: the order in which
/// reinitialisation and extrapolation work outwards. Inside a layer points are sorted by offset.
class LayerList {
 public:
  static constexpr std::uint8_t kUnreached = 255;  ///< not seen yet
  static constexpr std::uint8_t kBarred = 254;     ///< never entered

  LayerList() = default;
  explicit LayerList(const Eigen::Vector3i& size);

  /// Marks to be set before `grow`: 0 at seeds, kBarred where no layer may enter, kUnreached elsewhere.
  DenseField<std::uint8_t>& marks() { return mark_; }
  const DenseField<std::uint8_t>& marks() const { return mark_; }

  /// Grows `layers` layers from the seeds and collects the offsets of the layers from `first` on.
  void grow(int layers, int first = 0);
  /// Offsets of the points of a collected layer in a DenseField<float> of the same size; layer 0 holds the
  /// seeds.
  std::span<const std::int32_t> layer(int l) const;
  int layers() const { return static_cast<int>(start_.size()) - 1; }

 private:
  void dilate(std::uint8_t layer);
  void collect(int first, int layers);

  DenseField<std::uint8_t> mark_, next_;
  std::ptrdiff_t strideI_ = 0, strideJ_ = 0, first_ = 0;  ///< of a DenseField<float> of this size
  std::vector<std::int32_t> offsets_;
  std::vector<std::size_t> start_;
  std::vector<std::size_t> slabStart_;
};

}  // namespace spume::fluid
