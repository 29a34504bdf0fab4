#include "foam/space_order.h"

#include <algorithm>

#include "foam/cell_hash.h"
#include "foam/hilbert_curve.h"
#include "foam/parallel.h"
#include "foam/radix_sort.h"

namespace spume::foam {
namespace {

struct Box {
  Eigen::Vector3d low, high;
};

Box boundsOf(const std::vector<Eigen::Vector3d>& position) {
  const auto join = [](const Box& a, const Box& b) {
    return Box{a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
  };
  const auto point = [&](std::size_t i) { return Box{position[i], position[i]}; };
  return reduceIndices(position.size(), Box{position.front(), position.front()}, point, join);
}

}  // namespace

void sortInSpace(const std::vector<Eigen::Vector3d>& position, std::vector<std::int32_t>& order) {
  constexpr int kAxisBits = 10;  // cells of a thousandth: finer ones would change no order that matters
  order.resize(position.size());
  if (position.empty()) return;
  const Box box = boundsOf(position);
  const double size = (box.high - box.low).maxCoeff();
  const double scale = size > 0 ? (1 << kAxisBits) / size : 0;
  RawBuffer<SortKey> keys, spare;
  keys.resize(position.size()), spare.resize(position.size());
  forEachIndex(position.size(), [&](std::size_t i) {
    const Eigen::Vector3d cell = scale * (position[i] - box.low);
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis)
      code |=
          spreadCellBits(std::min(static_cast<std::int64_t>(cell[axis]), (std::int64_t{1} << kAxisBits) - 1))
          << axis;
    keys[i] = {hilbertPlace(code, kAxisBits), static_cast<std::int32_t>(i)};
  });
  radixSort(keys, spare, position.size(), 3 * kAxisBits);
  forEachIndex(position.size(), [&](std::size_t k) { order[k] = keys[k].index; });
}

}  // namespace spume::foam
