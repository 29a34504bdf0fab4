#pragma once

#include <algorithm>

#include "foam/neighbours.h"
#include "foam/volume_correction.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {

/// A dense random foam whose cells hold just their gas.
inline BubbleStore denseFoam() {
  BubbleStore bubbles;
  const Balls balls = randomFoam(300, 0.2, 2, 0.5, 11);
  for (std::size_t i = 0; i < balls.size(); ++i)
    bubbles.add(bubbleAt(1e-3 * balls.position[i], 1e-3 * balls.radius[i]));
  FoamTopology topology;
  PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, topology);
  for (std::size_t i = 0; i < bubbles.size(); ++i) bubbles.gas[i] = std::max(topology.volume[i], 1e-15);
  return bubbles;
}

inline void measure(BubbleStore& bubbles, FoamTopology& topology, Neighbours& neighbours) {
  PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, topology);
  neighbours.build(bubbles.size(), topology.overlaps);
  noteVolumes(topology, bubbles);
}

}  // namespace spume::foam::test
