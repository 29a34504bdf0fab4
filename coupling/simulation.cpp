#include "coupling/simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "coupling/domain_box.h"
#include "coupling/foam_objects.h"
#include "coupling/liquid_part.h"
#include "coupling/momentum_exchange.h"
#include "coupling/probes.h"
#include "coupling/stopwatch.h"
#include "coupling/time_step.h"
#include "fluid/errors.h"
#include "foam/errors.h"
#include "foam/forces/buoyancy.h"

namespace spume::coupling {
namespace {

/// A step that keeps failing at a sixteenth of its length will not be saved by a smaller one.
constexpr int kMaxHalvings = 4;

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

struct Simulation::Internals {
  Internals(const Scene& s, std::unique_ptr<LiquidPart> part)
      : scene(s),
        domain(s),
        liquid(std::move(part)),
        foam(foamParamsOf(s)),
        entrainment(s.coupling.entrainment, s.dx(), s.seed),
        supplier(s),
        probes(s) {}

  const Scene scene;
  const DomainBox domain;
  const std::unique_ptr<LiquidPart> liquid;
  foam::FoamSolver foam;
  Entrainment entrainment;
  const BubbleSupply supplier;
  const Probes probes;

  foam::BubbleStore bubbles;
  Reservoirs reservoirs;
  SupplyState supply;
  std::vector<fluid::Push> pushes;
  GasLedger gas;
  int frame = 0, steps = 0;
  double time = 0, initialVolume = 0, poured = 0, drained = 0;
  double foamDt = std::numeric_limits<double>::infinity();

  StepReport attempt(double dt);
  void stepLiquid(double dt, StepReport& report);
  void bear(const Birth& birth, StepReport& report);
  void entrain(StepReport& report);
  void reportFirstBubbles(StepReport& report) const;
  void supplyBubbles(double dt, StepReport& report);
  void stepFoam(double dt, StepReport& report);
  void takeFoamEvents(foam::FoamStepReport& happened, StepReport& report);
  void removeLeavers(StepReport& report);
  void book(double dt, StepReport& report);

  double frameEnd() const { return (frame + 1) / scene.time.fps; }
  double nextDt(double remaining) const {
    return sharedTimeStep(scene.time, liquid->stableDt(scene.time.maxSubSteps), remaining);
  }
  fluid::ImmersedGas immersedGas() const;
};

fluid::ImmersedGas Simulation::Internals::immersedGas() const {
  fluid::ImmersedGas immersed;
  if (!scene.coupling.immersedGas || bubbles.size() == 0) return immersed;
  Eigen::VectorXd phi(bubbles.size());
  liquid->sampler()->phi(bubbles.positions(), phi);
  for (std::size_t b = 0; b < bubbles.size(); ++b) {
    const double fraction = foam::immersedFraction(phi[b], bubbles.radius[b]);
    if (fraction <= 0) continue;
    immersed.position.push_back(bubbles.position[b]);
    immersed.volume.push_back(fraction * bubbles.gas[b]);
  }
  return immersed;
}

void Simulation::Internals::stepLiquid(double dt, StepReport& report) {
  const Stopwatch watch;
  const fluid::ImmersedGas immersed = immersedGas();
  for (const double volume : immersed.volume) report.immersedGas += volume;
  report.liquid = liquid->step(dt, immersed, pushes);
  report.secondsLiquid = watch.seconds();
}

void Simulation::Internals::bear(const Birth& birth, StepReport& report) {
  bubbles.add(birth.bubble);
  const EventCause cause = birth.cause == BirthCause::marker ? EventCause::marker : EventCause::pocket;
  report.events.push_back(eventOf(Event::Kind::birth, cause, report.time, bubbles, bubbles.size() - 1));
}

void Simulation::Internals::entrain(StepReport& report) {
  const Stopwatch watch;
  const auto escaped = liquid->takeEscaped();
  const auto pockets = liquid->takeCollapsedPockets();
  if (scene.coupling.entrainment.enabled) {
    for (const Birth& birth : entrainment.step(escaped, pockets, reservoirs, gas)) bear(birth, report);
    for (const Birth& birth : liquid->recordedBirths()) {
      bear(birth, report);
      (birth.cause == BirthCause::marker ? gas.bornMarkers : gas.bornPockets) += bubbles.gas.back();
    }
  }
  report.secondsEntrainment = watch.seconds();
}

/// The bubbles the scene starts with are born at time 0.
void Simulation::Internals::reportFirstBubbles(StepReport& report) const {
  for (std::size_t b = 0; b < bubbles.size(); ++b)
    report.events.push_back(eventOf(Event::Kind::birth, EventCause::scene, 0, bubbles, b));
}

void Simulation::Internals::supplyBubbles(double dt, StepReport& report) {
  const Stopwatch watch;
  const LiquidChange change{report.liquid.liquidVolume - report.immersedGas, report.liquid.poured,
                            report.liquid.drained};
  supplier.step(report.time, dt, *liquid->sampler(), change, bubbles, supply, gas, report.events);
  report.gasInSolution = supply.dissolved;
  report.secondsSupply = watch.seconds();
}

/// The foam may ask for shorter steps than the liquid; it then sub-cycles on the liquid's end-of-step fields.
void Simulation::Internals::stepFoam(double dt, StepReport& report) {
  const Stopwatch watch;
  const std::unique_ptr<foam::LiquidSampler> fields = liquid->sampler();
  const double wanted = std::max(foamDt, scene.time.minDt);
  const int subSteps = std::max(1, static_cast<int>(std::ceil(dt / wanted - kRoundOff)));
  double burst = 0;
  std::vector<fluid::Push> given;
  for (int n = 0; n < subSteps; ++n) {
    foam::FoamStepReport now = foam.step(bubbles, *fields, dt / subSteps);
    takeFoamEvents(now, report);
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
  pushes = std::move(given);
  report.foam.gasBurst = burst;
  report.foamSubSteps = subSteps;
  gas.burst += burst;
  foamDt = foam.stableDt(bubbles);
  report.secondsFoam = watch.seconds();
}

void Simulation::Internals::takeFoamEvents(foam::FoamStepReport& happened, StepReport& report) {
  for (const foam::FoamEvent& event : happened.events) {
    report.events.push_back(foamEvent(event, report.time));
  }
  happened.events.clear();
}

void Simulation::Internals::removeLeavers(StepReport& report) {
  std::vector<std::uint8_t> gone(bubbles.size(), 0);
  bool any = false;
  for (std::size_t b = 0; b < bubbles.size(); ++b) {
    if (domain.reaches(bubbles.position[b], bubbles.radius[b])) continue;
    gone[b] = 1;
    any = true;
    gas.left += bubbles.gas[b];
    report.events.push_back(eventOf(Event::Kind::leave, EventCause::border, report.time, bubbles, b));
  }
  if (any) bubbles.remove(gone);
}

void Simulation::Internals::book(double dt, StepReport& report) {
  gas.inBubbles = 0;
  for (const double g : bubbles.gas) gas.inBubbles += g;
  poured += report.liquid.poured;
  drained += report.liquid.drained;
  time += dt;
  ++steps;
  report.gas = gas;
  report.poured = poured;
  report.drained = drained;
  for (const Event& event : report.events) {
    report.births += event.kind == Event::Kind::birth;
    report.bursts += event.kind == Event::Kind::burst;
  }
}

StepReport Simulation::Internals::attempt(double dt) {
  StepReport report;
  report.step = steps + 1;
  report.dt = dt;
  report.time = time + dt;
  if (steps == 0) reportFirstBubbles(report);
  stepLiquid(dt, report);
  entrain(report);
  supplyBubbles(dt, report);
  stepFoam(dt, report);
  removeLeavers(report);
  book(dt, report);
  report.probes = probes.read(*liquid);
  return report;
}

Simulation::Simulation(const Scene& scene)
    : internals_(std::make_unique<Internals>(scene, makeLiquid(scene))) {
  Internals& in = *internals_;
  in.bubbles = initialBubbles(scene);
  for (const double gas : in.bubbles.gas) in.gas.bornSources += gas;
  in.gas.inBubbles = in.gas.bornSources;
  in.initialVolume = in.liquid->liquidVolume();
  in.supply = in.supplier.begin(*in.liquid->sampler(), in.initialVolume);
}

Simulation::Simulation(const Scene& scene, SimulationState state)
    : internals_(std::make_unique<Internals>(scene, makeLiquid(scene, std::move(state.liquid)))) {
  Internals& in = *internals_;
  in.bubbles = std::move(state.bubbles);
  in.reservoirs = std::move(state.reservoirs);
  in.supply = std::move(state.supply);
  in.pushes = std::move(state.pushes);
  in.gas = state.gas;
  in.frame = state.frame;
  in.steps = state.step;
  in.time = state.time;
  in.initialVolume = state.initialVolume;
  in.poured = state.poured;
  in.drained = state.drained;
  in.foamDt = state.foamDt;
}

Simulation::~Simulation() = default;

StepReport Simulation::step(double dt) {
  Internals& in = *internals_;
  const foam::BubbleStore bubbles = in.bubbles;
  const Reservoirs reservoirs = in.reservoirs;
  const SupplyState supply = in.supply;
  const GasLedger gas = in.gas;
  for (int halvings = 0;; ++halvings) {
    try {
      StepReport report = in.attempt(dt);
      report.halvings = halvings;
      return report;
    } catch (const fluid::NumericalFailure&) {
      if (halvings == kMaxHalvings) throw;
    } catch (const foam::NumericalFailure&) {
      in.liquid->rollBack();
      in.bubbles = bubbles;
      in.reservoirs = reservoirs;
      in.supply = supply;
      in.gas = gas;
      if (halvings == kMaxHalvings) throw;
    }
    dt /= 2;
  }
}

FrameReport Simulation::advanceFrame(const std::function<void(const StepReport&)>& onStep) {
  const Stopwatch watch;
  Internals& in = *internals_;
  FrameReport report;
  const double end = in.frameEnd();
  // The last step of a frame may miss its end by round-off only; the clock is then set to the frame's exact
  // time.
  const double kRoundOff = 1e-12 * end;
  while (end - in.time > kRoundOff) {
    const double remaining = end - in.time;
    report.steps.push_back(step(std::min(remaining, in.nextDt(remaining))));
    if (onStep) onStep(report.steps.back());
  }
  in.time = end;
  report.frame = ++in.frame;
  report.time = end;
  report.seconds = watch.seconds();
  return report;
}

SimulationState Simulation::state() const {
  const Internals& in = *internals_;
  SimulationState state;
  state.frame = in.frame;
  state.step = in.steps;
  state.time = in.time;
  state.liquid = in.liquid->state();
  state.bubbles = in.bubbles;
  state.reservoirs = in.reservoirs;
  state.supply = in.supply;
  state.pushes = in.pushes;
  state.gas = in.gas;
  state.initialVolume = in.initialVolume;
  state.poured = in.poured;
  state.drained = in.drained;
  state.foamDt = in.foamDt;
  return state;
}

int Simulation::frame() const { return internals_->frame; }
double Simulation::time() const { return internals_->time; }
const Scene& Simulation::scene() const { return internals_->scene; }
const fluid::LiquidState& Simulation::liquid() const { return internals_->liquid->state(); }
const fluid::SolidBoundary& Simulation::solids() const { return internals_->liquid->solids(); }
std::unique_ptr<foam::LiquidSampler> Simulation::fields() const { return internals_->liquid->sampler(); }
const foam::BubbleStore& Simulation::bubbles() const { return internals_->bubbles; }
const foam::FoamTopology& Simulation::topology() const { return internals_->foam.topology(); }
const std::vector<std::uint64_t>& Simulation::topologyIds() const { return internals_->foam.topologyIds(); }

}  // namespace spume::coupling
