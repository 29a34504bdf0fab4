#include "coupling/shared_stages.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "coupling/foam_objects.h"
#include "coupling/momentum_exchange.h"
#include "coupling/stopwatch.h"
#include "foam/forces/buoyancy.h"

namespace spume::coupling {
namespace {

/// Steps that fill an interval up to round-off must not be given one more.
constexpr double kRoundOff = 1e-9;

/// Adds the times of `spent` to those of the same stages in `now`.
void addStageTimes(const std::vector<foam::FoamStageTime>& spent, std::vector<foam::FoamStageTime>& now) {
  for (const foam::FoamStageTime& t : spent) {
    const auto same = [&](const foam::FoamStageTime& other) { return other.stage == t.stage; };
    const auto found = std::find_if(now.begin(), now.end(), same);
    if (found == now.end())
      now.push_back(t);
    else
      found->seconds += t.seconds;
  }
}

Event foamEvent(const foam::FoamEvent& happened, double time) {
  constexpr Event::Kind kKinds[] = {Event::Kind::burst, Event::Kind::merge, Event::Kind::classChange};
  Event event{kKinds[static_cast<int>(happened.kind)], time, happened.id, happened.other};
  if (happened.kind != foam::FoamEventKind::classChange)
    event.cause = happened.unsupported ? EventCause::unsupported : EventCause::age;
  event.position = happened.position;
  event.radius = happened.radius;
  event.gas = happened.gas;
  event.age = happened.age;
  event.from = happened.from;
  event.to = happened.to;
  return event;
}

}  // namespace

SharedStages::SharedStages(const Scene& s, std::unique_ptr<LiquidPart> part)
    : scene(s),
      domain(s),
      liquid(std::move(part)),
      foam(foamParamsOf(s)),
      entrainment(s.coupling.entrainment, s.dx(), s.seed),
      supplier(s),
      probes(s) {}

fluid::ImmersedGas SharedStages::immersedGas() const {
  fluid::ImmersedGas immersed;
  if (!scene.coupling.immersedGas || state.bubbles.size() == 0) return immersed;
  Eigen::VectorXd phi(state.bubbles.size());
  liquid->sampler()->phi(state.bubbles.positions(), phi);
  for (std::size_t b = 0; b < state.bubbles.size(); ++b) {
    const double fraction = foam::immersedFraction(phi[b], state.bubbles.radius[b]);
    if (fraction <= 0) continue;
    immersed.position.push_back(state.bubbles.position[b]);
    immersed.volume.push_back(fraction * state.bubbles.gas[b]);
  }
  return immersed;
}

void SharedStages::stepLiquid(double dt, StepReport& report) {
  const Stopwatch watch;
  const fluid::ImmersedGas immersed = immersedGas();
  for (const double volume : immersed.volume) report.immersedGas += volume;
  report.liquid = liquid->step(dt, immersed, state.pushes);
  liquidHasMoved_ = true;
  report.secondsLiquid = watch.seconds();
}

void SharedStages::bear(const Birth& birth, StepReport& report) {
  state.bubbles.add(birth.bubble);
  const EventCause cause = birth.cause == BirthCause::marker ? EventCause::marker : EventCause::pocket;
  report.events.push_back(
      eventOf(Event::Kind::birth, cause, report.time, state.bubbles, state.bubbles.size() - 1));
}

void SharedStages::entrain(StepReport& report) {
  const Stopwatch watch;
  const auto escaped = liquid->takeEscaped();
  const auto pockets = liquid->takeCollapsedPockets();
  if (scene.coupling.entrainment.enabled) {
    for (const Birth& birth : entrainment.step(escaped, pockets, state.reservoirs, state.gas))
      bear(birth, report);
    for (const Birth& birth : liquid->recordedBirths()) {
      bear(birth, report);
      (birth.cause == BirthCause::marker ? state.gas.bornMarkers : state.gas.bornPockets) +=
          state.bubbles.gas.back();
    }
  }
  report.secondsEntrainment = watch.seconds();
}

/// The bubbles the scene starts with are born at time 0.
void SharedStages::reportFirstBubbles(StepReport& report) const {
  for (std::size_t b = 0; b < state.bubbles.size(); ++b)
    report.events.push_back(eventOf(Event::Kind::birth, EventCause::scene, 0, state.bubbles, b));
}

void SharedStages::supplyBubbles(double dt, StepReport& report) {
  const Stopwatch watch;
  const LiquidChange change{report.liquid.liquidVolume - report.immersedGas, report.liquid.poured,
                            report.liquid.drained};
  supplier.step(report.time, dt, *liquid->sampler(), change, state.bubbles, state.supply, state.gas,
                report.events);
  for (const SourceProgress& source : state.supply.sources) report.sourceUnplaced += source.unplaced;
  report.gasInSolution = state.supply.dissolved;
  report.secondsSupply = watch.seconds();
}

/// The foam may ask for shorter steps than the liquid; it then sub-cycles on the liquid's end-of-step fields.
void SharedStages::stepFoam(double dt, StepReport& report) {
  const Stopwatch watch;
  const std::unique_ptr<foam::LiquidSampler> fields = liquid->sampler();
  const double wanted = std::max(state.foamDt, scene.time.minDt);
  const int subSteps = std::max(1, static_cast<int>(std::ceil(dt / wanted - kRoundOff)));
  double burst = 0;
  std::vector<fluid::Push> given;
  for (int n = 0; n < subSteps; ++n) {
    foam::FoamStepReport now = foam.step(state.bubbles, *fields, dt / subSteps);
    takeFoamEvents(now, n + 1 == subSteps ? report.time : state.time + dt * (n + 1) / subSteps, report);
    if (scene.coupling.twoWay) {
      const std::vector<fluid::Push> pushed = reactions(foam.dragImpulses());
      given.insert(given.end(), pushed.begin(), pushed.end());
    }
    burst += now.gasBurst;
    now.solverIterations += report.foam.solverIterations;
    now.pushedOut += report.foam.pushedOut;
    addStageTimes(report.foam.stages, now.stages);
    report.foam = std::move(now);
  }
  state.pushes = std::move(given);
  report.foam.gasBurst = burst;
  report.foamSubSteps = subSteps;
  state.gas.burst += burst;
  state.foamDt = foam.stableDt(state.bubbles);
  report.secondsFoam = watch.seconds();
}

/// Of a sub-step that ends at `time` [s].
void SharedStages::takeFoamEvents(foam::FoamStepReport& happened, double time, StepReport& report) {
  for (const foam::FoamEvent& event : happened.events) report.events.push_back(foamEvent(event, time));
  happened.events.clear();
}

void SharedStages::removeLeavers(StepReport& report) {
  std::vector<std::uint8_t> gone(state.bubbles.size(), 0);
  bool any = false;
  for (std::size_t b = 0; b < state.bubbles.size(); ++b) {
    if (domain.reaches(state.bubbles.position[b], state.bubbles.radius[b])) continue;
    gone[b] = 1;
    any = true;
    state.gas.left += state.bubbles.gas[b];
    report.events.push_back(eventOf(Event::Kind::leave, EventCause::border, report.time, state.bubbles, b));
  }
  if (any) state.bubbles.remove(gone);
}

void SharedStages::book(double dt, StepReport& report) {
  state.gas.inBubbles = 0;
  for (const double g : state.bubbles.gas) state.gas.inBubbles += g;
  state.poured += report.liquid.poured;
  state.drained += report.liquid.drained;
  state.time += dt;
  ++state.step;
  report.gas = state.gas;
  report.poured = state.poured;
  report.drained = state.drained;
  for (const Event& event : report.events) {
    report.births += event.kind == Event::Kind::birth;
    report.bursts += event.kind == Event::Kind::burst;
  }
}

StepReport SharedStages::attempt(double dt) {
  StepReport report;
  report.step = state.step + 1;
  report.dt = dt;
  report.time = state.time + dt;
  liquidHasMoved_ = false;
  if (state.step == 0) reportFirstBubbles(report);
  stepLiquid(dt, report);
  entrain(report);
  supplyBubbles(dt, report);
  stepFoam(dt, report);
  removeLeavers(report);
  book(dt, report);
  report.probes = probes.read(*liquid);
  return report;
}

void SharedStages::rollBack(const SimulationState& start) {
  if (std::exchange(liquidHasMoved_, false)) liquid->rollBack();
  state = start;
}

}  // namespace spume::coupling
