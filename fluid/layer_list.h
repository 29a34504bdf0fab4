#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fluid/dense_field.h"

namespace spume::fluid {

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

  /// Grows `layers` layers from the seeds and collects the offsets of every layer.
  void grow(int layers);
  /// Offsets of the points of a layer in a DenseField<float> of the same size; layer 0 holds the seeds.
  std::span<const std::int32_t> layer(int l) const;
  int layers() const { return static_cast<int>(start_.size()) - 1; }

 private:
  void dilate(std::uint8_t layer);
  void collect(int layers);

  DenseField<std::uint8_t> mark_, next_;
  std::ptrdiff_t strideI_ = 0, strideJ_ = 0, first_ = 0;  ///< of a DenseField<float> of this size
  std::vector<std::int32_t> offsets_;
  std::vector<std::size_t> start_;
  std::vector<std::size_t> slabStart_;
};

}  // namespace spume::fluid
