#include "fluid/layer_list.h"

#include <cstring>
#include <numeric>

#include "fluid/parallel.h"

namespace spume::fluid {

LayerList::LayerList(const Eigen::Vector3i& size) : mark_(size, kUnreached), next_(size, kUnreached) {
  const DenseField<float> shape(size);
  strideI_ = shape.stride(0);
  strideJ_ = shape.stride(1);
  first_ = shape.index(0, 0, 0);
}

namespace {

/// One row of a dilation, on its own so that nothing the loop reads can alias the bytes it writes.
void dilateRow(const std::uint8_t* __restrict m, std::uint8_t* __restrict out, std::ptrdiff_t si,
               std::ptrdiff_t sj, int count, std::uint8_t layer) {
  const std::uint8_t from = layer - 1;
  for (int k = 0; k < count; ++k) {
    const std::uint8_t beside = (m[k - si] == from) | (m[k + si] == from) | (m[k - sj] == from) |
                                (m[k + sj] == from) | (m[k - 1] == from) | (m[k + 1] == from);
    const std::uint8_t enter = beside & (m[k] == LayerList::kUnreached);
    out[k] = enter ? layer : m[k];
  }
}

/// Marks looked at together where nothing happens.
constexpr int kWord = 8;

/// Whether a word of marks holds nothing to collect: unreached points alone, or seeds alone that nobody
/// wants.
bool isDull(const std::uint8_t* marks, int first) {
  std::uint64_t word;
  std::memcpy(&word, marks, sizeof word);
  return word == ~std::uint64_t{0} || (first > 0 && word == 0);
}

}  // namespace

void LayerList::dilate(std::uint8_t layer) {
  forEachRow(mark_.size(), [&](int i, int j) {
    dilateRow(&mark_(i, j, 0), &next_(i, j, 0), mark_.stride(0), mark_.stride(1), mark_.size().z(), layer);
  });
  mark_.swap(next_);
}

void LayerList::collect(int first, int layers) {
  const Eigen::Vector3i n = mark_.size();
  const std::size_t width = layers + 1;
  slabStart_.assign(width * n.x(), 0);  // [layer][slab]: a prefix sum over it gives every list its place
  const auto slabCounter = [&](int layer, int i) -> std::size_t& { return slabStart_[layer * n.x() + i]; };
  const auto visitSlab = [&](int i, const auto& visit) {
    for (int j = 0; j < n.y(); ++j) {
      const std::uint8_t* m = &mark_(i, j, 0);
      const std::int32_t row = static_cast<std::int32_t>(first_ + i * strideI_ + j * strideJ_);
      for (int word = 0; word < n.z(); word += kWord) {  // past the end of a row all marks are kUnreached
        if (isDull(m + word, first)) continue;
        for (int k = word; k < word + kWord; ++k)
          if (m[k] >= first && m[k] <= layers) visit(m[k], row + k);
      }
    }
  };
  tbb::parallel_for(0, n.x(),
                    [&](int i) { visitSlab(i, [&](int layer, std::int32_t) { ++slabCounter(layer, i); }); });
  std::exclusive_scan(slabStart_.begin(), slabStart_.end(), slabStart_.begin(), std::size_t{0});
  start_.resize(width + 1);
  for (std::size_t l = 0; l < width; ++l) start_[l] = slabCounter(static_cast<int>(l), 0);
  // After the scan the last counter lacks its own slab; the total is found by counting that slab again.
  std::size_t lastSlab = 0;
  visitSlab(n.x() - 1, [&](int layer, std::int32_t) { lastSlab += layer == layers; });
  start_[width] = slabStart_.back() + lastSlab;
  offsets_.resize(start_[width]);
  tbb::parallel_for(0, n.x(), [&](int i) {
    visitSlab(i, [&](int layer, std::int32_t offset) { offsets_[slabCounter(layer, i)++] = offset; });
  });
}

void LayerList::grow(int layers, int first) {
  for (int l = 1; l <= layers; ++l) dilate(static_cast<std::uint8_t>(l));
  collect(first, layers);
}

std::span<const std::int32_t> LayerList::layer(int l) const {
  return std::span(offsets_).subspan(start_[l], start_[l + 1] - start_[l]);
}

}  // namespace spume::fluid
