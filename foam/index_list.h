#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "foam/parallel.h"

namespace spume::foam {

/// Lists the indices of [0, n) that are chosen, in their order; asks isChosen(i) twice of each, in parallel.
template <typename Index, typename Chosen>
void listIndices(std::size_t n, const Chosen& isChosen, std::vector<Index>& list) {
  const std::size_t blocks = (n + kGrain - 1) / kGrain;
  const auto forBlock = [&](std::size_t block, const auto& act) {
    for (std::size_t i = block * kGrain; i < std::min(n, (block + 1) * kGrain); ++i)
      if (isChosen(i)) act(i);
  };
  std::vector<std::size_t> begin(blocks + 1, 0);  // of a block's part of the list
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    std::size_t count = 0;
    forBlock(block, [&](std::size_t) { ++count; });
    begin[block + 1] = count;
  });
  for (std::size_t block = 0; block < blocks; ++block) begin[block + 1] += begin[block];
  list.resize(begin.back());
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    std::size_t place = begin[block];
    forBlock(block, [&](std::size_t i) { list[place++] = static_cast<Index>(i); });
  });
}

}  // namespace spume::foam
