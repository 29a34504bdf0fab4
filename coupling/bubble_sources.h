#pragma once

#include <cstdint>
#include <vector>

#include "coupling/domain_box.h"
#include "coupling/scene.h"
#include "foam/bubble_store.h"
#include "foam/liquid_sampler.h"

namespace spume::coupling {

/// How far a source has come.
struct SourceProgress {
  std::uint64_t births = 0;  ///< bubbles so far, those included that found no place; numbers the next one
  double gas = 0;            ///< in them [m^3]
};

/// A bubble that a source blows.
struct Blown {
  foam::NewBubble bubble;
  int source;  ///< index in the scene
};

/// The scene's sources. Bubble number n of a source is due when the integral of its rate passes n + u_n (by
/// number) or the gas of all bubbles up to it (by gas); time, size and place follow from (seed, source, n)
/// alone, so neither dt nor the threads matter. A bubble takes the first of a few drawn places that are clear
/// of bubbles and solids, or the freest; one that finds none outside solids, or no liquid where it needs it,
/// is not born.
class BubbleSources {
 public:
  explicit BubbleSources(const Scene& scene);

  /// Bubbles due up to time `to` [s], in the order of sources and births; moves `progress` on.
  std::vector<Blown> step(double to, const foam::LiquidSampler& liquid, const foam::BubbleStore& bubbles,
                          std::vector<SourceProgress>& progress) const;

 private:
  struct Due;
  std::vector<Due> dueUntil(std::size_t source, double to, SourceProgress& progress) const;
  double drawRadius(std::size_t source, std::uint64_t birth) const;

  std::vector<BubbleSourceSpec> specs_;
  const DomainBox domain_;
  std::uint64_t seed_;
};

}  // namespace spume::coupling
