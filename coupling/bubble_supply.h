#pragma once

#include <vector>

#include "coupling/bubble_sources.h"
#include "coupling/domain_box.h"
#include "coupling/event.h"
#include "coupling/gas_ledger.h"
#include "coupling/scene.h"
#include "foam/nucleation.h"

namespace spume::coupling {

/// What sources, sites and solution have come to: part of a checkpoint.
struct SupplyState {
  std::vector<SourceProgress> sources;
  std::vector<foam::NucleationSite> sites;
  double dissolved = 0;  ///< gas in solution, at the pressure of the air [m^3]
};

/// What happened to the liquid since the last step.
struct LiquidChange {
  double volume = 0;               ///< of the liquid now, gas excluded [m^3]
  double poured = 0, drained = 0;  ///< in the step [m^3]
};

/// Makes and takes bubbles besides entrainment and their own lives: regions that remove them, sources,
/// nucleation on solids, and the exchange with gas in solution, which is taken to be well mixed. Every volume
/// of gas is booked, every bubble's coming and going an event.
class BubbleSupply {
 public:
  explicit BubbleSupply(const Scene& scene);

  /// State at the start of a run, with `liquidVolume` [m^3] of liquid.
  SupplyState begin(const foam::LiquidSampler& liquid, double liquidVolume) const;

  /// Everything due in a step of dt [s] that ends at `now` [s].
  void step(double now, double dt, const foam::LiquidSampler& liquid, const LiquidChange& change,
            foam::BubbleStore& bubbles, SupplyState& state, GasLedger& gas, std::vector<Event>& events) const;

 private:
  using Events = std::vector<Event>;
  void removeInRegions(double now, foam::BubbleStore& bubbles, GasLedger& gas, Events& events) const;
  void blow(double now, const foam::LiquidSampler& liquid, foam::BubbleStore& bubbles, SupplyState& state,
            GasLedger& gas, Events& events) const;
  void nucleate(double now, const foam::LiquidSampler& liquid, foam::BubbleStore& bubbles, SupplyState& state,
                GasLedger& gas, Events& events) const;
  void dissolve(double now, double dt, const foam::LiquidSampler& liquid, const LiquidChange& change,
                foam::BubbleStore& bubbles, SupplyState& state, GasLedger& gas, Events& events) const;
  double concentration(const SupplyState& state, double liquidVolume) const;

  const BubbleSources sources_;
  const std::vector<BubbleKillSpec> kills_;
  const foam::DissolvedGasParams solution_;
  const foam::Radius radiusOnExchange_;
  std::vector<foam::NucleationParams> nucleation_;
  const DomainBox domain_;
  std::uint64_t seed_;
};

}  // namespace spume::coupling
