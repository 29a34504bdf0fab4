#include "coupling/statistics_columns.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "coupling/toml_slot.h"

namespace spume::coupling {
namespace {

std::string cellOf(double value) { return exactText(value); }
std::string cellOf(std::uint64_t value) { return std::to_string(value); }
std::string cellOf(int value) { return std::to_string(value); }
std::string cellOf(const char* word) { return word; }

template <typename Report>
using Columns = std::vector<Column<Report>>;

/// One after the other.
template <typename Report>
Columns<Report> joined(const std::vector<Columns<Report>>& sections) {
  Columns<Report> all;
  for (const Columns<Report>& section : sections) all.insert(all.end(), section.begin(), section.end());
  return all;
}

template <typename Report, typename Value>
Column<Report> column(std::string name, std::string unit, std::string meaning, Value value) {
  return {{std::move(name), std::move(unit), std::move(meaning)},
          [value](const Report& report) { return cellOf(value(report)); }};
}

template <typename Value>
Column<StepReport> step(std::string name, std::string unit, std::string meaning, Value value) {
  return column<StepReport>(std::move(name), std::move(unit), std::move(meaning), value);
}
template <typename Value>
Column<FrameReport> frame(std::string name, std::string unit, std::string meaning, Value value) {
  return column<FrameReport>(std::move(name), std::move(unit), std::move(meaning), value);
}
template <typename Value>
Column<EventRow> event(std::string name, std::string unit, std::string meaning, Value value) {
  return column<EventRow>(std::move(name), std::move(unit), std::move(meaning), value);
}

const char* nameOf(foam::BubbleClass type) {
  constexpr const char* kNames[] = {"liquid", "surface", "air"};
  return kNames[static_cast<int>(type)];
}
const char* nameOf(EventCause cause) {
  constexpr const char* kNames[] = {"",    "marker",      "pocket", "source",      "scene", "nucleation",
                                    "age", "unsupported", "region", "dissolution", "border"};
  return kNames[static_cast<int>(cause)];
}
const char* nameOf(Event::Kind kind) {
  constexpr const char* kNames[] = {"birth", "burst", "merge", "class", "kill", "leave"};
  return kNames[static_cast<int>(kind)];
}

/// Sum and extremes over the steps of a frame.
template <typename Value>
auto sum(Value value) {
  return [value](const FrameReport& f) {
    std::decay_t<decltype(value(f.steps[0]))> total{};
    for (const StepReport& s : f.steps) total += value(s);
    return total;
  };
}
template <typename Value>
auto most(Value value) {
  return [value](const FrameReport& f) {
    double largest = -std::numeric_limits<double>::infinity();
    for (const StepReport& s : f.steps) largest = std::max(largest, static_cast<double>(value(s)));
    return f.steps.empty() ? 0.0 : largest;
  };
}
template <typename Value>
auto last(Value value) {
  return [value](const FrameReport& f) {
    return f.steps.empty() ? decltype(value(f.steps[0])){} : value(f.steps.back());
  };
}

/// Of the step itself.
Columns<StepReport> stepItself() {
  using R = StepReport;
  return {
      step("step", "-", "number of the step, from 1", [](const R& r) { return r.step; }),
      step("time", "s", "at its end", [](const R& r) { return r.time; }),
      step("dt", "s", "its length", [](const R& r) { return r.dt; }),
      step("foam_substeps", "-", "steps the foam split it into", [](const R& r) { return r.foamSubSteps; }),
      step("halvings", "-", "times it was halved because a module failed",
           [](const R& r) { return r.halvings; })};
}

/// Of the liquid, its bodies and drops.
Columns<StepReport> liquidOfStep() {
  using R = StepReport;
  return {
      step("liquid_substeps", "-", "sub-steps of the liquid", [](const R& r) { return r.liquid.subSteps; }),
      step("cfl", "-", "largest of its sub-steps", [](const R& r) { return r.liquid.cfl; }),
      step("max_speed", "m/s", "of the liquid", [](const R& r) { return r.liquid.maxSpeed; }),
      step("pressure_iterations", "-", "summed over its sub-steps",
           [](const R& r) { return r.liquid.pressureIterations; }),
      step("pressure_residual", "-", "worst relative one",
           [](const R& r) { return r.liquid.pressureResidual; }),
      step("divergence", "m/s", "largest |div u - source| dx after projection",
           [](const R& r) { return r.liquid.divergence; }),
      step("liquid_volume", "m^3", "of the grid liquid", [](const R& r) { return r.liquid.liquidVolume; }),
      step("target_volume", "m^3", "initial + poured - drained - drops + immersed gas",
           [](const R& r) { return r.liquid.targetVolume; }),
      step("volume_drift", "m^3", "liquid_volume - target_volume",
           [](const R& r) { return r.liquid.liquidVolume - r.liquid.targetVolume; }),
      step("poured", "m^3", "through inflows since the start", [](const R& r) { return r.poured; }),
      step("drained", "m^3", "out of the domain since the start", [](const R& r) { return r.drained; }),
      step("drops", "-", "in flight, of escaped negative markers", [](const R& r) { return r.liquid.drops; }),
      step("drop_volume", "m^3", "in them", [](const R& r) { return r.liquid.dropVolume; }),
      step("drops_launched", "m^3", "left the grid liquid in this step",
           [](const R& r) { return r.liquid.launched; }),
      step("drops_landed", "m^3", "came back in this step", [](const R& r) { return r.liquid.landed; }),
      step("immersed_gas", "m^3", "of bubbles under the surface", [](const R& r) { return r.immersedGas; }),
      step("push_withheld", "N s", "of the bubbles' drag, from liquid that is lighter than they or not there",
           [](const R& r) { return r.liquid.pushes.withheld.norm(); }),
      step("kinetic_energy", "J", "of the liquid", [](const R& r) { return r.liquid.kineticEnergy; }),
      step("potential_energy", "J", "of the liquid", [](const R& r) { return r.liquid.potentialEnergy; }),
      step("positive_markers", "-", "in the air", [](const R& r) { return r.liquid.positiveMarkers; }),
      step("negative_markers", "-", "in the liquid", [](const R& r) { return r.liquid.negativeMarkers; })};
}

/// Of the bubbles and their solver.
Columns<StepReport> bubblesOfStep() {
  using R = StepReport;
  return {
      step("bubbles", "-", "at the end", [](const R& r) { return r.foam.bubbles; }),
      step("bubbles_liquid", "-", "under the surface", [](const R& r) { return r.foam.liquid; }),
      step("bubbles_surface", "-", "at the surface", [](const R& r) { return r.foam.surface; }),
      step("bubbles_air", "-", "above it", [](const R& r) { return r.foam.air; }),
      step("births", "-", "in this step", [](const R& r) { return r.births; }),
      step("source_unplaced", "-",
           "bubbles of sources that found no place outside solids or in the liquid, since the start",
           [](const R& r) { return r.sourceUnplaced; }),
      step("bursts", "-", "in this step", [](const R& r) { return r.bursts; }),
      step("contacts", "-", "films between bubbles", [](const R& r) { return r.foam.contacts; }),
      step("overlaps", "-", "overlapping pairs", [](const R& r) { return r.foam.overlaps; }),
      step("hidden", "-", "bubbles swallowed by others", [](const R& r) { return r.foam.hidden; }),
      step("clamped", "-", "bubbles at the limit of their radius", [](const R& r) { return r.foam.clamped; }),
      step("pushed_out", "-", "bubbles taken out of solids", [](const R& r) { return r.foam.pushedOut; }),
      step("foam_iterations", "-", "of the implicit step",
           [](const R& r) { return r.foam.solverIterations; }),
      step("foam_residual", "-", "of the implicit step", [](const R& r) { return r.foam.solverResidual; }),
      step("foam_fell_back", "-", "1: its iteration stalled and was finished by the direct solver",
           [](const R& r) { return r.foam.solverFellBack ? 1 : 0; }),
      step("bubble_max_speed", "m/s", "of the bubbles", [](const R& r) { return r.foam.maxSpeed; }),
      step("bubble_kinetic_energy", "J", "of the bubbles", [](const R& r) { return r.foam.kineticEnergy; }),
      step("volume_error_median", "-", "|V - V0|/V0 of unflagged bubbles",
           [](const R& r) { return r.foam.volumeErrorMedian; }),
      step("volume_error_max", "-", "the worst of them", [](const R& r) { return r.foam.volumeErrorMax; })};
}

/// The ledger of the gas.
Columns<StepReport> gasOfStep() {
  using R = StepReport;
  return {
      step("gas_born_markers", "m^3", "from escaped markers, since the start",
           [](const R& r) { return r.gas.bornMarkers; }),
      step("gas_born_pockets", "m^3", "from collapsed pockets", [](const R& r) { return r.gas.bornPockets; }),
      step("gas_born_sources", "m^3", "from sources and the scene",
           [](const R& r) { return r.gas.bornSources; }),
      step("gas_born_nucleation", "m^3", "out of solution at walls",
           [](const R& r) { return r.gas.bornNucleation; }),
      step("gas_grown", "m^3", "out of solution into bubbles, less what they gave back",
           [](const R& r) { return r.gas.grown; }),
      step("gas_burst", "m^3", "given back to the air", [](const R& r) { return r.gas.burst; }),
      step("gas_killed", "m^3", "removed by the scene", [](const R& r) { return r.gas.killed; }),
      step("gas_left", "m^3", "gone from the domain", [](const R& r) { return r.gas.left; }),
      step("gas_not_entrained", "m^3", "lost by the level set below the onset",
           [](const R& r) { return r.gas.notEntrained; }),
      step("gas_unplaced", "m^3", "of bubbles of sources that found no place",
           [](const R& r) { return r.gas.unplaced; }),
      step("gas_in_bubbles", "m^3", "held at the end", [](const R& r) { return r.gas.inBubbles; }),
      step("gas_in_reservoirs", "m^3", "held at the end", [](const R& r) { return r.gas.inReservoirs; }),
      step("gas_in_solution", "m^3", "at the pressure of the air, where it is followed",
           [](const R& r) { return r.gasInSolution; }),
      step("gas_imbalance", "m^3", "what the ledger does not explain",
           [](const R& r) { return r.gas.imbalance(); })};
}

/// Where the wall time went.
Columns<StepReport> timesOfStep() {
  using R = StepReport;
  return {step("seconds_liquid", "s", "wall time", [](const R& r) { return r.secondsLiquid; }),
          step("seconds_entrainment", "s", "wall time", [](const R& r) { return r.secondsEntrainment; }),
          step("seconds_supply", "s", "wall time of sources, nucleation, growth and removal",
               [](const R& r) { return r.secondsSupply; }),
          step("seconds_foam", "s", "wall time", [](const R& r) { return r.secondsFoam; })};
}

/// Of the frame itself, and of its steps.
Columns<FrameReport> frameItself() {
  using S = StepReport;
  return {
      frame("frame", "-", "number of the frame, from 1", [](const FrameReport& f) { return f.frame; }),
      frame("time", "s", "of the frame", [](const FrameReport& f) { return f.time; }),
      frame("steps", "-", "shared steps",
            [](const FrameReport& f) { return static_cast<int>(f.steps.size()); }),
      frame("seconds", "s", "wall time", [](const FrameReport& f) { return f.seconds; }),
      frame("seconds_liquid", "s", "wall time", sum([](const S& s) { return s.secondsLiquid; })),
      frame("seconds_entrainment", "s", "wall time", sum([](const S& s) { return s.secondsEntrainment; })),
      frame("seconds_foam", "s", "wall time", sum([](const S& s) { return s.secondsFoam; })),
      frame("halvings", "-", "of steps that failed", sum([](const S& s) { return s.halvings; }))};
}

/// Of the liquid.
Columns<FrameReport> liquidOfFrame() {
  using S = StepReport;
  return {
      frame("liquid_substeps", "-", "of the liquid", sum([](const S& s) { return s.liquid.subSteps; })),
      frame("cfl", "-", "largest", most([](const S& s) { return s.liquid.cfl; })),
      frame("max_speed", "m/s", "largest of the liquid", most([](const S& s) { return s.liquid.maxSpeed; })),
      frame("pressure_iterations", "-", "summed",
            sum([](const S& s) { return s.liquid.pressureIterations; })),
      frame("divergence", "m/s", "largest", most([](const S& s) { return s.liquid.divergence; })),
      frame("liquid_volume", "m^3", "of the grid liquid",
            last([](const S& s) { return s.liquid.liquidVolume; })),
      frame("target_volume", "m^3", "what it should be",
            last([](const S& s) { return s.liquid.targetVolume; })),
      frame("poured", "m^3", "since the start", last([](const S& s) { return s.poured; })),
      frame("drained", "m^3", "since the start", last([](const S& s) { return s.drained; })),
      frame("drops", "-", "in flight at the end", last([](const S& s) { return s.liquid.drops; })),
      frame("drop_volume", "m^3", "in them", last([](const S& s) { return s.liquid.dropVolume; }))};
}

/// Of the bubbles and their gas.
Columns<FrameReport> bubblesOfFrame() {
  using S = StepReport;
  return {frame("bubbles", "-", "at the end", last([](const S& s) { return s.foam.bubbles; })),
          frame("bubbles_liquid", "-", "under the surface", last([](const S& s) { return s.foam.liquid; })),
          frame("bubbles_surface", "-", "at the surface", last([](const S& s) { return s.foam.surface; })),
          frame("bubbles_air", "-", "above it", last([](const S& s) { return s.foam.air; })),
          frame("births", "-", "in the frame", sum([](const S& s) { return s.births; })),
          frame("source_unplaced", "-", "bubbles of sources that found no place, since the start",
                last([](const S& s) { return s.sourceUnplaced; })),
          frame("bursts", "-", "in the frame", sum([](const S& s) { return s.bursts; })),
          frame("contacts", "-", "films at the end", last([](const S& s) { return s.foam.contacts; })),
          frame("hidden", "-", "bubbles swallowed by others, at the end",
                last([](const S& s) { return s.foam.hidden; })),
          frame("clamped", "-", "bubbles at the limit of their radius, at the end",
                last([](const S& s) { return s.foam.clamped; })),
          frame("foam_iterations", "-", "summed", sum([](const S& s) { return s.foam.solverIterations; })),
          frame("volume_error_median", "-", "of the bubbles' cells",
                last([](const S& s) { return s.foam.volumeErrorMedian; })),
          frame("volume_error_max", "-", "of the bubbles' cells",
                last([](const S& s) { return s.foam.volumeErrorMax; })),
          frame("gas_in_bubbles", "m^3", "at the end", last([](const S& s) { return s.gas.inBubbles; })),
          frame("gas_imbalance", "m^3", "of the ledger", last([](const S& s) { return s.gas.imbalance(); }))};
}

}  // namespace

const std::vector<Column<StepReport>>& columnsOfSteps() {
  static const auto kColumns =
      joined<StepReport>({stepItself(), liquidOfStep(), bubblesOfStep(), gasOfStep(), timesOfStep()});
  return kColumns;
}

const std::vector<Column<FrameReport>>& columnsOfFrames() {
  static const auto kColumns = joined<FrameReport>({frameItself(), liquidOfFrame(), bubblesOfFrame()});
  return kColumns;
}

const std::vector<Column<EventRow>>& columnsOfEvents() {
  using R = EventRow;
  static const std::vector<Column<R>> kColumns{
      event("step", "-", "in which it happened", [](const R& r) { return r.step; }),
      event("time", "s",
            "burst, merge, class: end of the sub-step of the foam in which it happened; birth, kill, leave: "
            "end "
            "of the step",
            [](const R& r) { return r.event.time; }),
      event("kind", "-", "birth, burst, merge, class, kill or leave",
            [](const R& r) { return nameOf(r.event.kind); }),
      event("id", "-", "of the bubble", [](const R& r) { return r.event.id; }),
      event("other", "-", "merge: the bubble that took the gas", [](const R& r) { return r.event.other; }),
      event(
          "cause", "-",
          "birth: marker, pocket, source, scene or nucleation; end: age, unsupported, region, dissolution or "
          "border",
          [](const R& r) { return nameOf(r.event.cause); }),
      event("origin", "-", "number of the source, nucleation or region that did it, from 0; -1: none",
            [](const R& r) { return r.event.origin; }),
      event("x", "m", "place", [](const R& r) { return r.event.position.x(); }),
      event("y", "m", "place", [](const R& r) { return r.event.position.y(); }),
      event("z", "m", "place", [](const R& r) { return r.event.position.z(); }),
      event("radius", "m", "of the bubble", [](const R& r) { return r.event.radius; }),
      event("gas", "m^3", "in the bubble", [](const R& r) { return r.event.gas; }),
      event("age", "s", "of the bubble", [](const R& r) { return r.event.age; }),
      event("from", "-", "class before: liquid, surface or air",
            [](const R& r) { return nameOf(r.event.from); }),
      event("to", "-", "class after", [](const R& r) { return nameOf(r.event.to); })};
  return kColumns;
}

}  // namespace spume::coupling
