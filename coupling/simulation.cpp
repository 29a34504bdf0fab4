#include "coupling/simulation.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "coupling/first_bubbles.h"
#include "coupling/foam_objects.h"
#include "coupling/shared_stages.h"
#include "coupling/stopwatch.h"
#include "coupling/time_step.h"
#include "fluid/errors.h"
#include "foam/errors.h"

namespace spume::coupling {
namespace {

/// A step that keeps failing at a sixteenth of its length will not be saved by a smaller one.
constexpr int kMaxHalvings = 4;

/// A module's failure with what only the shared step knows: the last, shortest try of a step that began at
/// `start`.
template <typename Failure>
[[noreturn]] void giveUp(const SimulationState& start, double dt, const Failure& failure) {
  std::ostringstream message;
  message << "step " << start.step + 1 << " from t = " << start.time << " s failed, halved " << kMaxHalvings
          << " times to dt = " << dt << " s: " << failure.what();
  throw Failure(message.str());
}

}  // namespace

Simulation::Simulation(const Scene& scene) : Simulation(scene, makeLiquid(scene)) {}

Simulation::Simulation(const Scene& scene, std::unique_ptr<LiquidPart> liquid)
    : stages_(std::make_unique<SharedStages>(scene, std::move(liquid))) {
  SimulationState& state = stages_->state;
  state.bubbles = initialBubbles(scene);
  for (const double gas : state.bubbles.gas) state.gas.bornSources += gas;
  state.gas.inBubbles = state.gas.bornSources;
  state.initialVolume = stages_->liquid->liquidVolume();
  state.supply = stages_->supplier.begin(*stages_->liquid->sampler(), state.initialVolume);
}

Simulation::Simulation(const Scene& scene, SimulationState state)
    : stages_(std::make_unique<SharedStages>(scene, makeLiquid(scene, std::exchange(state.liquid, {})))) {
  stages_->state = std::move(state);
}

Simulation::~Simulation() = default;

StepReport Simulation::step(double dt) {
  SharedStages& s = *stages_;
  const SimulationState start = s.state;
  for (int halvings = 0;; ++halvings) {
    try {
      StepReport report = s.attempt(dt);
      report.halvings = halvings;
      return report;
    } catch (const fluid::NumericalFailure& failure) {
      s.rollBack(start);
      if (halvings == kMaxHalvings) giveUp(start, dt, failure);
    } catch (const foam::NumericalFailure& failure) {
      s.rollBack(start);
      if (halvings == kMaxHalvings) giveUp(start, dt, failure);
    } catch (...) {  // out of memory, a file of a cached liquid: no shorter step would help
      s.rollBack(start);
      throw;
    }
    dt /= 2;
  }
}

FrameReport Simulation::advanceFrame(const std::function<void(const StepReport&)>& onStep) {
  const Stopwatch watch;
  SimulationState& state = stages_->state;
  const TimeSpec& clock = scene().time;
  FrameReport report;
  const double end = (state.frame + 1) / clock.fps;
  // The last step of a frame may miss its end by round-off only; the clock is then set to the frame's exact
  // time.
  const double kRoundOff = 1e-12 * end;
  while (end - state.time > kRoundOff) {
    const double remaining = end - state.time;
    const double next = sharedTimeStep(clock, stages_->liquid->stableDt(clock.maxSubSteps), remaining);
    report.steps.push_back(step(std::min(remaining, next)));
    if (onStep) onStep(report.steps.back());
  }
  state.time = end;
  report.frame = ++state.frame;
  report.time = end;
  report.seconds = watch.seconds();
  return report;
}

SimulationState Simulation::state() const {
  SimulationState state = stages_->state;
  state.liquid = stages_->liquid->state();
  return state;
}

int Simulation::frame() const { return stages_->state.frame; }
double Simulation::time() const { return stages_->state.time; }
const Scene& Simulation::scene() const { return stages_->scene; }
const fluid::LiquidState& Simulation::liquid() const { return stages_->liquid->state(); }
const fluid::SolidBoundary& Simulation::solids() const { return stages_->liquid->solids(); }
std::unique_ptr<foam::LiquidSampler> Simulation::fields() const { return stages_->liquid->sampler(); }
const foam::BubbleStore& Simulation::bubbles() const { return stages_->state.bubbles; }
const SupplyState& Simulation::supply() const { return stages_->state.supply; }
const foam::FoamTopology& Simulation::topology() const { return stages_->foam.topology(); }
const std::vector<std::uint64_t>& Simulation::topologyIds() const { return stages_->foam.topologyIds(); }

}  // namespace spume::coupling
