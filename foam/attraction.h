#pragma once

#include "foam/block_system.h"
#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/foam_topology.h"
#include "foam/liquid_sampler.h"
#include "foam/surroundings.h"
#include "foam/weak_pairs.h"

namespace spume::foam {

/// Capillary pulls on floating bubbles, towards each other [Busaryev 2012, Eq. 6] and towards solids [Eq. 8]:
/// gentle forces without stiffness, taken at the step's start. Skipped whole where nothing floats.
class Attraction {
 public:
  /// Sets `force` to the pull on every bubble [N].
  /// Deviation: [Busaryev 2012, Eq. 8] lets go of a bubble the moment it touches, and turns at once where the
  /// nearest wall changes; a raft at walls then jitters for ever. Here the pull lasts while a bubble touches
  /// (the wall's spring holds it; one that adheres is held by its adhesion), and its direction is the slope
  /// of psi across the bubble, which turns smoothly.
  void compute(const FoamParams& params, const BubbleStore& bubbles, const Surroundings& around,
               const LiquidSampler& liquid, const FoamTopology& topology, Vectors3& force);

 private:
  void findPairs(const FoamParams& params, const BubbleStore& bubbles, const FoamTopology& topology);
  void addPairs(const FoamParams& params, const BubbleStore& bubbles, Vectors3& force);
  void addSolids(const FoamParams& params, const BubbleStore& bubbles, const Surroundings& around,
                 const LiquidSampler& liquid, Vectors3& force) const;

  WeakPairs finder_;
  std::vector<WeakPair> pairs_;
  Vectors3 pull_;  ///< of each pair's j on its i [N]
  std::vector<std::uint8_t> floats_;
};

}  // namespace spume::foam
