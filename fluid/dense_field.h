#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>

#include "fluid/large_pages.h"

namespace spume::fluid {

/// Ghost layers around every dense field, so that a WENO5 stencil one cell outside the grid needs no branch.
inline constexpr int kGhost = 4;

/// A dense window of values on (nx, ny, nz) points with `kGhost` ghost layers, z fastest, 64-byte aligned.
/// Indices run from -kGhost to n + kGhost - 1. Holds plain values only: no position, no unit.
template <typename T>
class DenseField {
 public:
  DenseField() = default;
  explicit DenseField(const Eigen::Vector3i& size, T fill = T{}) : size_(size) {
    const std::ptrdiff_t padZ = size.z() + 2 * kGhost;
    strideJ_ = (padZ + kRow - 1) / kRow * kRow;
    strideI_ = strideJ_ * (size.y() + 2 * kGhost);
    count_ = strideI_ * (size.x() + 2 * kGhost);
    data_ = allocate(count_);
    std::fill_n(data_.get(), count_, fill);
  }
  DenseField(const DenseField& other) { *this = other; }
  DenseField(DenseField&&) noexcept = default;
  DenseField& operator=(DenseField&&) noexcept = default;
  DenseField& operator=(const DenseField& other) {
    if (this == &other) return *this;
    if (count_ != other.count_) data_ = other.count_ ? allocate(other.count_) : nullptr;
    size_ = other.size_;
    strideI_ = other.strideI_;
    strideJ_ = other.strideJ_;
    count_ = other.count_;
    std::copy_n(other.data_.get(), count_, data_.get());
    return *this;
  }

  T& operator()(int i, int j, int k) { return data_[index(i, j, k)]; }
  const T& operator()(int i, int j, int k) const { return data_[index(i, j, k)]; }
  T& operator()(const Eigen::Vector3i& c) { return (*this)(c.x(), c.y(), c.z()); }
  const T& operator()(const Eigen::Vector3i& c) const { return (*this)(c.x(), c.y(), c.z()); }

  /// Offset of (i, j, k) from `data()`; neighbours lie `stride(axis)` apart.
  std::ptrdiff_t index(int i, int j, int k) const {
    return (i + kGhost) * strideI_ + (j + kGhost) * strideJ_ + (k + kGhost);
  }
  std::ptrdiff_t stride(int axis) const { return axis == 0 ? strideI_ : axis == 1 ? strideJ_ : 1; }
  const Eigen::Vector3i& size() const { return size_; }
  bool contains(int i, int j, int k) const {
    return i >= 0 && j >= 0 && k >= 0 && i < size_.x() && j < size_.y() && k < size_.z();
  }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::ptrdiff_t count() const { return count_; }   ///< values held, ghosts included
  void fill(T value) { std::fill_n(data_.get(), count_, value); }
  void swap(DenseField& other) noexcept { std::swap(*this, other); }

 private:
  static constexpr std::size_t kAlign = 64;
  static constexpr std::ptrdiff_t kRow = sizeof(T) < kAlign ? kAlign / sizeof(T) : 1;
  struct Free {
    std::size_t bytes = 0;
    void operator()(T* p) const { freeLargePages(p, bytes); }
  };
  using Buffer = std::unique_ptr<T[], Free>;
  static Buffer allocate(std::ptrdiff_t n) {
    const std::size_t bytes = n * sizeof(T);
    return Buffer(static_cast<T*>(allocateLargePages(bytes)), Free{bytes});
  }

  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::ptrdiff_t strideI_ = 0, strideJ_ = 0, count_ = 0;
  Buffer data_;
};

/// One value per face of a MAC grid: `axis[a](i, j, k)` lives on the minus face of cell (i, j, k) across axis a,
/// so `axis[a]` has one more point than there are cells along a.
template <typename T>
struct MacField {
  std::array<DenseField<T>, 3> axis;

  MacField() = default;
  explicit MacField(const Eigen::Vector3i& cells, T fill = T{}) {
    for (int a = 0; a < 3; ++a) axis[a] = DenseField<T>(cells + Eigen::Vector3i::Unit(a), fill);
  }
  DenseField<T>& operator[](int a) { return axis[a]; }
  const DenseField<T>& operator[](int a) const { return axis[a]; }
};

using MacVelocity = MacField<float>;   ///< face-normal velocity [m/s]

}  // namespace spume::fluid
