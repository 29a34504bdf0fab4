#include "foam/neighbours.h"

#include <tbb/parallel_invoke.h>

namespace spume::foam {

/// A row has its earlier neighbours first, which meet it in their order, then those of the pairs it begins:
/// it comes out sorted. One thread writes the ones, one the others.
void Neighbours::build(std::size_t bubbles, const std::vector<OverlapPair>& pairs) {
  start.assign(bubbles + 1, 0), earlier_.assign(bubbles, 0);
  tbb::parallel_invoke(
      [&] {
        for (const OverlapPair& pair : pairs) ++start[pair.i + 1];
      },
      [&] {
        for (const OverlapPair& pair : pairs) ++earlier_[pair.j];
      });
  for (std::size_t i = 0; i < bubbles; ++i) start[i + 1] += start[i] + earlier_[i];
  other.resize(start.back()), pair.resize(start.back());
  next_.assign(start.begin(), start.end() - 1);
  const auto list = [&](std::int32_t place, std::int32_t neighbour, std::size_t k) {
    other[place] = neighbour, pair[place] = static_cast<std::int32_t>(k);
  };
  const auto listEarlier = [&] {
    for (std::size_t k = 0; k < pairs.size(); ++k) list(next_[pairs[k].j]++, pairs[k].i, k);
  };
  const auto listLater = [&] {
    std::int32_t place = 0;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const std::int32_t i = pairs[k].i;
      if (k == 0 || i != pairs[k - 1].i) place = start[i] + earlier_[i];
      list(place++, pairs[k].j, k);
    }
  };
  tbb::parallel_invoke(listEarlier, listLater);
}

}  // namespace spume::foam
