#pragma once

#include "foam/block_system.h"
#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/foam_topology.h"
#include "foam/surroundings.h"
#include "foam/weak_pairs.h"

namespace spume::foam {

/// Capillary pulls on floating bubbles, towards each other [Busaryev 2012, Eq. 6] and towards solids [Eq. 8]:
/// gentle forces without stiffness, taken at the step's start. Skipped whole where nothing floats.
class Attraction {
 public:
  /// Sets `force` to the pull on every bubble [N].
  void compute(const FoamParams& params, const BubbleStore& bubbles, const Surroundings& around,
               const FoamTopology& topology, Vectors3& force);

 private:
  void findPairs(const FoamParams& params, const BubbleStore& bubbles, const FoamTopology& topology);

  WeakPairs finder_;
  std::vector<WeakPair> pairs_;
  std::vector<std::uint8_t> floats_;
};

}  // namespace spume::foam
