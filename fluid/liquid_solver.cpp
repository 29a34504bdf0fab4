#include "fluid/liquid_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fluid/errors.h"
#include "fluid/liquid_measures.h"
#include "fluid/liquid_stages.h"

namespace spume::fluid {

LiquidSolver::LiquidSolver(FluidParams params, LiquidSetup setup,
                           const std::function<double(const Eigen::Vector3d&)>& phi0) {
  params.validate();
  internals_ = std::make_unique<LiquidStages>(std::move(params), std::move(setup));
  LiquidStages& in = *internals_;
  const Eigen::Vector3i& cells = in.state.grid.cells;
  in.state.phi = DenseField<float>(cells);
  in.state.velocity = MacVelocity(cells);
  in.state.pressureGradient = MacField<float>(cells);
  initialiseLevelSet(in.state.grid, phi0, in.state.phi);
  in.start();
  in.extension.apply(in.state.phi);
  in.reinitializer.apply(in.state.phi, &in.solids);
  in.extension.apply(in.state.phi);
  in.reseed();
  in.drops.refreshVolumes(in.markerScene(), in.state.phi, in.state.positive, in.state.negative);
  in.bodies.find(in.state.grid, in.state.phi, in.solids);
  in.volumeControl.start(in.bodies);
  in.startPockets();
}

LiquidSolver::LiquidSolver(FluidParams params, LiquidSetup setup, LiquidState state) {
  params.validate();
  internals_ = std::make_unique<LiquidStages>(std::move(params), std::move(setup));
  internals_->state = std::move(state);
  internals_->start();
  internals_->resumeControl();
}

LiquidSolver::~LiquidSolver() = default;
LiquidSolver::LiquidSolver(LiquidSolver&&) noexcept = default;

LiquidStepReport LiquidSolver::step(double dt, const ImmersedGas& gas, const std::vector<Push>& pushes) {
  LiquidStages& in = *internals_;
  copyState(in.state, in.before);
  in.escapedBefore = in.escaped.size();
  in.collapsedBefore = in.collapsed.size();
  in.pushed = pushes;
  LiquidStepReport report;
  StageClock clock;
  in.stepEnd = in.state.time + dt;
  try {
    double longest = dt;  // a sub-step may be cut short; the next ones grow again by no more than twice
    for (double remaining = dt; remaining > 0;) {
      const int left =
          std::max(in.subStepsFor(remaining), static_cast<int>(std::ceil(remaining / longest - kRoundOff)));
      const double asked = remaining / left, taken = in.subStep(asked, gas, report, clock);
      if (taken < asked)
        remaining -= taken;
      else
        remaining = left == 1 ? 0 : remaining * (left - 1) / left;
      longest = 2 * taken;
    }
    in.state.time = in.stepEnd;
    in.measure(report);
  } catch (...) {  // a failure of the numbers, or out of memory
    rollBack();
    throw;
  }
  report.stages = clock.stages();
  return report;
}

void LiquidSolver::rollBack() {
  LiquidStages& in = *internals_;
  in.state = in.before;
  in.escaped.resize(in.escapedBefore);
  in.collapsed.resize(in.collapsedBefore);
  in.start();
  in.resumeControl();
}

double LiquidSolver::stableDt(int maxSubSteps) const { return maxSubSteps * internals_->longestStep(); }

double LiquidSolver::liquidVolume() const {
  return fluid::liquidVolume(internals_->state.grid, internals_->state.phi, internals_->solids);
}
const DenseField<float>& LiquidSolver::pressure() const { return internals_->projection.pressure(); }
const LiquidState& LiquidSolver::state() const { return internals_->state; }
const SolidBoundary& LiquidSolver::solids() const { return internals_->solids; }
const FluidParams& LiquidSolver::params() const { return internals_->params; }
std::vector<EscapedMarker> LiquidSolver::takeEscaped() { return std::exchange(internals_->escaped, {}); }
std::vector<CollapsedPocket> LiquidSolver::takeCollapsedPockets() {
  return std::exchange(internals_->collapsed, {});
}

}  // namespace spume::fluid
