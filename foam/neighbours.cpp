#include "foam/neighbours.h"

#include <utility>

namespace spume::foam {

/// A row meets its earlier neighbours in their order before it is itself the earlier one: it comes out
/// sorted.
void Neighbours::build(std::size_t bubbles, const std::vector<OverlapPair>& pairs) {
  start.assign(bubbles + 1, 0);
  for (const OverlapPair& pair : pairs) ++start[pair.i + 1], ++start[pair.j + 1];
  for (std::size_t i = 0; i < bubbles; ++i) start[i + 1] += start[i];
  next_.assign(start.begin(), start.end() - 1);
  other.resize(start.back()), pair.resize(start.back());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = std::pair(pairs[k].i, pairs[k].j);
    const std::int32_t here = next_[i]++, there = next_[j]++;
    other[here] = j, other[there] = i;
    pair[here] = pair[there] = static_cast<std::int32_t>(k);
  }
}

}  // namespace spume::foam
