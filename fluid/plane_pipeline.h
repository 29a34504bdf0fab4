#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace spume::fluid {

/// Slabs a thread gets: more would only cost cache, fewer leave threads idle where planes differ in work.
inline constexpr int kSlabsPerThread = 2;

/// Calls body(stage, plane) for every stage 0 .. stages - 1 and plane 0 .. planes - 1 such that a stage comes
/// to a plane after the stage before has been there and on both planes beside, and before the stage after
/// comes to any of the three: the order that sweeps of a stencil of one plane need. Stages follow each other
/// plane by plane, so that a plane is still in the cache when the next stage comes: red-black sweeps are
/// limited by memory alone. In parallel over slabs of planes; the order within the rules depends on the
/// number of threads, what such sweeps compute does not.
template <typename Body>
void pipelinePlanes(int stages, int planes, const Body& body) {
  const int narrowest = 2 * stages;  // what is left out at the two sides of a slab must not meet
  const int wished = kSlabsPerThread * tbb::this_task_arena::max_concurrency();
  const int slabs = std::max(1, wished <= kSlabsPerThread ? 1 : std::min(wished, planes / narrowest));
  const auto start = [&](int slab) { return slab * planes / slabs; };
  // Every slab in a skewed run, a plane less at each inner side with every stage.
  tbb::parallel_for(0, slabs, [&](int slab) {
    const int low = start(slab), high = start(slab + 1);
    for (int front = low; front < high + stages - 1; ++front)
      for (int stage = 0; stage < stages; ++stage) {
        const int plane = front - stage;
        const bool reached = slab == 0 ? plane >= low : plane >= low + stage;
        const bool left = slab == slabs - 1 ? plane >= high : plane >= high - stage;
        if (reached && !left) body(stage, plane);
      }
  });
  // What is left around the joints, a plane more at each side with every stage.
  tbb::parallel_for(1, slabs, [&](int joint) {
    for (int stage = 1; stage < stages; ++stage)
      for (int plane = start(joint) - stage; plane < start(joint) + stage; ++plane) body(stage, plane);
  });
}

}  // namespace spume::fluid
