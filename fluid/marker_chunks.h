#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace spume::fluid {

/// Markers handled by one task. Fixed, so that the split into vectors does not depend on the threads.
inline constexpr std::size_t kMarkerChunk = 2048;

/// Calls body(first, last) for consecutive ranges of at most kMarkerChunk of `count` markers, in parallel.
template <typename Body>
void forEachMarkerChunk(std::size_t count, const Body& body) {
  const std::size_t chunks = (count + kMarkerChunk - 1) / kMarkerChunk;
  tbb::parallel_for(std::size_t{0}, chunks,
                    [&](std::size_t c) { body(c * kMarkerChunk, std::min(count, (c + 1) * kMarkerChunk)); });
}

}  // namespace spume::fluid
