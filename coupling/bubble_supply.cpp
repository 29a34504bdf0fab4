#include "coupling/bubble_supply.h"

#include <algorithm>

#include "coupling/foam_objects.h"
#include "coupling/shapes.h"
#include "foam/volume_correction.h"

namespace spume::coupling {
namespace {

/// Adds a bubble with its event; returns its gas [m^3].
double addBubble(const foam::NewBubble& bubble, EventCause cause, int origin, double now,
                 foam::BubbleStore& bubbles, std::vector<Event>& events) {
  bubbles.add(bubble);
  events.push_back(eventOf(Event::Kind::birth, cause, now, bubbles, bubbles.size() - 1));
  events.back().origin = origin;
  return bubbles.gas.back();
}

}  // namespace

BubbleSupply::BubbleSupply(const Scene& scene)
    : sources_(scene),
      kills_(scene.bubbleKills),
      solution_(scene.dissolvedGas),
      radiusOnExchange_(foam::holdsVolumes(foamParamsOf(scene)) ? foam::Radius::stays
                                                                : foam::Radius::follows),
      nucleation_(nucleationParamsOf(scene)),
      domain_(scene),
      seed_(scene.seed) {}

SupplyState BubbleSupply::begin(const foam::LiquidSampler& liquid, double liquidVolume) const {
  SupplyState state;
  for (std::size_t k = 0; k < nucleation_.size(); ++k) {
    const auto sites = foam::findNucleationSites(nucleation_[k], static_cast<int>(k), liquid, domain_.lower,
                                                 domain_.upper, seed_);
    state.sites.insert(state.sites.end(), sites.begin(), sites.end());
  }
  if (solution_.enabled)
    state.dissolved = solution_.concentration * liquidVolume / solution_.molesPerVolume();
  return state;
}

void BubbleSupply::step(double now, double dt, const foam::LiquidSampler& liquid, const LiquidChange& change,
                        foam::BubbleStore& bubbles, SupplyState& state, GasLedger& gas,
                        Events& events) const {
  removeInRegions(now, bubbles, gas, events);
  blow(now, liquid, bubbles, state, gas, events);
  if (solution_.enabled) dissolve(now, dt, liquid, change, bubbles, state, gas, events);
  nucleate(now, liquid, bubbles, state, gas, events);
}

void BubbleSupply::removeInRegions(double now, foam::BubbleStore& bubbles, GasLedger& gas,
                                   Events& events) const {
  std::vector<std::uint8_t> gone(bubbles.size(), 0);
  for (std::size_t k = 0; k < kills_.size(); ++k) {
    if (now < kills_[k].start || now >= kills_[k].stop) continue;
    for (std::size_t i = 0; i < bubbles.size(); ++i) {
      if (gone[i] || signedDistance(kills_[k].shape, bubbles.position[i]) > 0) continue;
      gone[i] = 1;
      gas.killed += bubbles.gas[i];
      events.push_back(eventOf(Event::Kind::kill, EventCause::region, now, bubbles, i));
      events.back().origin = static_cast<int>(k);
    }
  }
  if (std::find(gone.begin(), gone.end(), 1) != gone.end()) bubbles.remove(gone);
}

void BubbleSupply::blow(double now, const foam::LiquidSampler& liquid, foam::BubbleStore& bubbles,
                        SupplyState& state, GasLedger& gas, Events& events) const {
  const BlownStep step = sources_.step(now, liquid, bubbles, state.sources);
  gas.unplaced += step.unplacedGas;
  for (const Blown& blown : step.bubbles)
    gas.bornSources += addBubble(blown.bubble, EventCause::source, blown.source, now, bubbles, events);
}

/// Where gas in solution is followed, a new bubble's gas comes out of it.
void BubbleSupply::nucleate(double now, const foam::LiquidSampler& liquid, foam::BubbleStore& bubbles,
                            SupplyState& state, GasLedger& gas, Events& events) const {
  for (const foam::Nucleated& born : foam::nucleate(nucleation_, liquid, bubbles, now, seed_, state.sites)) {
    foam::NucleationSite& site = state.sites[born.site];
    site.bubble = bubbles.nextId;
    const double taken = addBubble(born.bubble, EventCause::nucleation, site.params, now, bubbles, events);
    gas.bornNucleation += taken;
    if (solution_.enabled && solution_.depletes) state.dissolved -= taken;
  }
}

double BubbleSupply::concentration(const SupplyState& state, double liquidVolume) const {
  if (!solution_.depletes || !(liquidVolume > 0)) return solution_.concentration;
  return std::max(0.0, state.dissolved * solution_.molesPerVolume() / liquidVolume);
}

void BubbleSupply::dissolve(double now, double dt, const foam::LiquidSampler& liquid,
                            const LiquidChange& change, foam::BubbleStore& bubbles, SupplyState& state,
                            GasLedger& gas, Events& events) const {
  const double before = change.volume - change.poured + change.drained;
  state.dissolved += change.poured * solution_.concentration / solution_.molesPerVolume();
  state.dissolved -= change.drained * concentration(state, before) / solution_.molesPerVolume();
  if (bubbles.size() == 0) return;
  foam::Surroundings around;
  around.sampleFlow(liquid, bubbles.positions());
  std::vector<std::uint8_t> dissolved;
  double taken = exchangeGas(solution_, concentration(state, change.volume), around, dt, radiusOnExchange_,
                             bubbles, dissolved);
  for (std::size_t i = 0; i < dissolved.size(); ++i) {
    if (!dissolved[i]) continue;
    taken -= bubbles.gas[i];
    events.push_back(eventOf(Event::Kind::kill, EventCause::dissolution, now, bubbles, i));
  }
  gas.grown += taken;
  if (solution_.depletes) state.dissolved -= taken;
  bubbles.remove(dissolved);
}

}  // namespace spume::coupling
