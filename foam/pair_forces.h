#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/foam_topology.h"
#include "foam/forces/strong_spring.h"

namespace spume::foam {

/// What a pair asks of each of its two bubbles, in one cache line.
struct alignas(64) PairedBubble {
  std::array<double, 3> position, velocity;  ///< [m], that of the prediction [m/s]
  double radius, mass;                       ///< [m], inertia [kg]
};

/// What pairs of overlapping bubbles do to each other, at the positions of the step's start. A column for
/// each quantity: a register takes several pairs at a time, always the same ones together.
struct PairForces {
  static constexpr std::size_t kMost = 64;  ///< pairs; their columns stay in the nearest cache
  using Column = std::array<double, kMost>;

  std::array<Column, 3> direction;  ///< unit, from i to j
  std::array<Column, 3> approach;   ///< v_i - v_j [m/s]
  Column tension;                   ///< pull on each other [N]; < 0 pushes apart
  Column along;                     ///< stiffness along `direction` [N/m], >= 0
  Column across;                    ///< stiffness against turning [N/m], >= 0
  Column damping;                   ///< c_lap, against any relative velocity [kg/s], >= 0

  /// What the forces depend on.
  struct Foam {
    const FoamParams& params;
    SpringLaw spring;  ///< of `params`
    const BubbleStore& bubbles;
    const FoamTopology& topology;
    const std::vector<PairedBubble>& paired;  ///< these bubbles once more
  };

  /// Strong spring and contact damping of overlaps `first` .. `first` + `count` - 1 of the topology, kMost at
  /// most. Coincident centres part in a direction drawn from (seed, ids).
  void find(const Foam& foam, std::size_t first, std::size_t count);
};

}  // namespace spume::foam
