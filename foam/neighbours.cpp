#include "foam/neighbours.h"

namespace spume::foam {

void Neighbours::build(std::size_t bubbles, const std::vector<OverlapPair>& pairs) {
  start.assign(bubbles + 2, 0);
  for (const OverlapPair& p : pairs) ++start[p.i + 2], ++start[p.j + 2];
  for (std::size_t i = 2; i < start.size(); ++i) start[i] += start[i - 1];
  other.resize(2 * pairs.size()), pair.resize(2 * pairs.size());
  // Pairs come sorted by (i, j): placing every (j, i) first leaves each row sorted by neighbour.
  const auto place = [this](std::int32_t owner, std::int32_t neighbour, std::size_t index) {
    const std::int32_t slot = start[owner + 1]++;
    other[slot] = neighbour, pair[slot] = static_cast<std::int32_t>(index);
  };
  for (std::size_t k = 0; k < pairs.size(); ++k) place(pairs[k].j, pairs[k].i, k);
  for (std::size_t k = 0; k < pairs.size(); ++k) place(pairs[k].i, pairs[k].j, k);
  start.pop_back();
}

}  // namespace spume::foam
