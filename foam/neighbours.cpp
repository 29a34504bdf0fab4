#include "foam/neighbours.h"

#include "foam/parallel.h"

namespace spume::foam {

void Neighbours::build(std::size_t bubbles, const std::vector<OverlapPair>& pairs) {
  rows_.build(bubbles, [&](const auto& body) {
    forEachIndex(pairs.size(), [&](std::size_t k) {
      const auto [i, j] = std::pair(pairs[k].i, pairs[k].j);
      const auto index = static_cast<std::int32_t>(k);
      body(i, j, PairRows::pack(j, index), PairRows::pack(i, index));
    });
  });
  start = rows_.start;
  other.resize(rows_.entry.size()), pair.resize(rows_.entry.size());
  forEachIndex(other.size(), [&](std::size_t slot) {
    other[slot] = PairRows::keyOf(rows_.entry[slot]), pair[slot] = PairRows::valueOf(rows_.entry[slot]);
  });
}

}  // namespace spume::foam
