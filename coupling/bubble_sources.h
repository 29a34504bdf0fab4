#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coupling/domain_box.h"
#include "coupling/scene.h"
#include "foam/bubble_store.h"
#include "foam/liquid_sampler.h"

namespace spume::coupling {

/// How far a source has come.
struct SourceProgress {
  std::uint64_t births = 0;    ///< bubbles so far, those included that found no place; numbers the next one
  double gas = 0;              ///< in them [m^3]
  std::uint64_t unplaced = 0;  ///< of them, those that found no place
};

/// A bubble that a source blows.
struct Blown {
  foam::NewBubble bubble;
  int source;  ///< index in the scene
};

/// What the sources blow in a step.
struct BlownStep {
  std::vector<Blown> bubbles;  ///< in the order of sources and births
  double unplacedGas = 0;      ///< of bubbles that were due and found no place [m^3]
};

/// The scene's sources. Bubble number n of a source is due when the integral of its rate passes n + u_n (by
/// number) or the gas of all bubbles up to it (by gas); time, size and place follow from (seed, source, n)
/// alone, so neither dt nor the threads matter. A bubble takes the first of a few drawn places that are clear
/// of bubbles and solids, or the freest; one that finds none outside solids, or no liquid where it needs it,
/// is not born, only counted: it is not tried again later, so a source that was dry does not blow all it owes
/// at once.
class BubbleSources {
 public:
  explicit BubbleSources(const Scene& scene);

  /// Places a bubble may choose from: with half of the region covered all are only once in 65 000.
  static constexpr int kPlaces = 16;

  /// What is due up to time `to` [s]; moves `progress` on.
  BlownStep step(double to, const foam::LiquidSampler& liquid, const foam::BubbleStore& bubbles,
                 std::vector<SourceProgress>& progress) const;

 private:
  struct Due;
  std::vector<Due> dueUntil(std::size_t source, double to, SourceProgress& progress) const;
  double drawRadius(std::size_t source, std::uint64_t birth) const;

  std::vector<BubbleSourceSpec> specs_;
  const DomainBox domain_;
  std::uint64_t seed_;
};

/// A sentence on every source of the scene some of whose bubbles found no place.
std::vector<std::string> unplacedWarnings(const Scene& scene, const std::vector<SourceProgress>& progress);

}  // namespace spume::coupling
