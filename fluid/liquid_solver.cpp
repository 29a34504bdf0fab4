#include "fluid/liquid_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "fluid/air_pockets.h"
#include "fluid/errors.h"
#include "fluid/extrapolation.h"
#include "fluid/level_set.h"
#include "fluid/level_set_advection.h"
#include "fluid/liquid_bodies.h"
#include "fluid/liquid_measures.h"
#include "fluid/marker_correction.h"
#include "fluid/marker_escape.h"
#include "fluid/marker_particles.h"
#include "fluid/open_boundary.h"
#include "fluid/pocket_markers.h"
#include "fluid/projection.h"
#include "fluid/reinitialize.h"
#include "fluid/velocity_advection.h"
#include "fluid/volume_control.h"

namespace spume::fluid {
namespace {

/// The velocity must reach beyond the fastest sub-step and the stencil of its interpolation [cells].
constexpr int kStencilReach = 3;

/// More sub-steps than this in one step mean that the velocity has run away.
constexpr int kMaxSubSteps = 2000;

/// Steps that fill an interval up to round-off must not be given one more.
constexpr double kRoundOff = 1e-9;

}  // namespace

struct LiquidSolver::Internals {
  Internals(FluidParams p, LiquidSetup s);
  void start();
  void resumeControl();

  FluidParams params;
  LiquidSetup setup;
  LiquidState state, before;
  SolidBoundary solids;
  InflowSet inflows;
  OutflowSet outflows;

  SolidExtension extension;
  LevelSetAdvection levelSetAdvection;
  Reinitializer reinitializer;
  VelocityAdvector velocityAdvector;
  VelocityExtrapolator extrapolator;
  MarkerSorter sorter;
  MarkerSeeder seeder;
  MarkerCorrection correction;
  MarkerEscape escape;
  AirPockets pockets;
  LiquidBodies bodies;
  VolumeControl volumeControl;
  Projection projection;
  DenseField<float> source, fraction;
  DenseField<std::int32_t> cellMark;

  std::vector<EscapedMarker> escaped;
  std::vector<CollapsedPocket> collapsed;
  std::size_t escapedBefore = 0, collapsedBefore = 0;
  double maxSpeed = 0;

  MarkerScene markerScene() const { return {state.grid, params, setup.walls, solids}; }
  double longestStep(double reach) const;
  int subStepsFor(double dt) const;

  void subStep(double dt, const ImmersedGas& gas, LiquidStepReport& report, StageClock& clock);
  void moveSolids(double dt);
  void transport(double dt, LiquidStepReport& report);
  void correctSurface();
  void loseMarkers(double dt);
  void reseed();
  void fillPockets();
  void pour(double dt, const ImmersedGas& gas, LiquidStepReport& report);
  void moveVelocity(double dt);
  void project(double dt, LiquidStepReport& report);
  void extrapolate();
  void checkFinite(double dt) const;
  void measure(LiquidStepReport& report);
};

LiquidSolver::Internals::Internals(FluidParams p, LiquidSetup s)
    : params(std::move(p)),
      setup(std::move(s)),
      solids(buildSolidBoundary(setup.grid, setup.walls, setup.solids, 0)),
      inflows(setup.grid, setup.inflows, params.seed),
      outflows(setup.grid, setup.outflows),
      levelSetAdvection(setup.grid),
      reinitializer(setup.grid),
      velocityAdvector(setup.grid),
      extrapolator(setup.grid),
      sorter(setup.grid),
      seeder(setup.grid),
      escape(setup.grid),
      volumeControl(setup.grid, params),
      projection(setup.grid, params),
      source(setup.grid.cells),
      fraction(setup.grid.cells),
      cellMark(setup.grid.cells, -1) {
  state.grid = setup.grid;
}

/// Brings everything derived from the state up to date with it.
void LiquidSolver::Internals::start() {
  updateSolidBoundary(state.grid, setup.walls, setup.solids, state.time, solids);
  extension.rebuild(state.grid, solids);
  maxSpeed = maxFaceSpeed(state.phi, state.velocity);
}

/// Hands the ledger of the state back to volume control, with the bodies as the last sub-step saw them.
void LiquidSolver::Internals::resumeControl() {
  inflows.stamp(state.time, 0, state.phi, solids);
  bodies.find(state.grid, state.phi, solids);
  volumeControl.resume(bodies, state.volume);
}

/// Time [s] in which the fastest liquid, speeding up under gravity, covers `reach` [m].
double LiquidSolver::Internals::longestStep(double reach) const {
  const double g = params.gravity.norm();
  const double denominator = maxSpeed + std::sqrt(maxSpeed * maxSpeed + 4 * g * reach);
  return denominator > 0 ? 2 * reach / denominator : std::numeric_limits<double>::infinity();
}

int LiquidSolver::Internals::subStepsFor(double dt) const {
  // n sub-steps of h = dt/n, each with (speed + g h) h <= cfl dx: gravity acts within a sub-step only, the
  // next one counts again.
  const double reach = params.cfl * state.grid.dx;
  // A solid must not pass a cell in one sub-step: what it uncovers is filled from the cells beside it.
  const double swept = fastestSolid(state.grid, setup.solids, solids, state.time + dt) * dt / state.grid.dx;
  const double steps = std::ceil(std::max(dt / longestStep(reach), swept) - kRoundOff);
  if (!(steps <= kMaxSubSteps)) {
    std::ostringstream message;
    message << "liquid: the speed " << maxSpeed << " m/s at t = " << state.time << " s would need " << steps
            << " sub-steps in dt = " << dt << " s (limit " << kMaxSubSteps << ")";
    throw NumericalFailure(message.str());
  }
  return std::max(1, static_cast<int>(steps));
}

void LiquidSolver::Internals::moveSolids(double dt) {
  const bool moving =
      std::any_of(setup.solids.begin(), setup.solids.end(), [](const auto& s) { return s.moves; });
  if (!moving) return;
  updateSolidBoundary(state.grid, setup.walls, setup.solids, state.time + dt, solids);
  extension.rebuild(state.grid, solids);
}

void LiquidSolver::Internals::transport(double dt, LiquidStepReport& report) {
  report.drained += volumeControl.bookOutflow(state.phi, solids, state.velocity, dt);
  levelSetAdvection.advance(params.levelSetTransport, state.velocity, dt, state.phi);
  admitAir(state.grid, solids, state.velocity, dt, state.phi);
  advectMarkers(markerScene(), state.velocity, dt, state.positive);
  advectMarkers(markerScene(), state.velocity, dt, state.negative);
  report.drained += outflows.empty(state.time + dt, solids, state.phi, state.negative, volumeControl);
  extension.apply(state.phi);
  sorter.compact(state.positive);
  sorter.compact(state.negative);
}

void LiquidSolver::Internals::correctSurface() {
  correction.apply(static_cast<float>(state.grid.dx), state.positive, state.negative, state.phi);
  extension.apply(state.phi);
}

void LiquidSolver::Internals::loseMarkers(double dt) {
  const MarkerScene scene = markerScene();
  escape.refreshGas(scene, state.phi, state.positive);
  escape.refreshSpeed(scene, state.phi, state.velocity, dt, state.positive);
  escape.releaseEscaped(scene, state.phi, state.velocity, state.positive, escaped);
}

void LiquidSolver::Internals::reseed() {
  const MarkerScene scene = markerScene();
  adjustRadii(scene, state.phi, MarkerSign::positive, state.positive);
  adjustRadii(scene, state.phi, MarkerSign::negative, state.negative);
  if (state.subSteps % params.reseedInterval != 0) return;
  seeder.reseed(scene, state.phi, state.subSteps, state.positive, state.negative);
}

void LiquidSolver::Internals::fillPockets() {
  pockets.find(state.grid, state.phi, solids);
  const auto filled = pockets.fillSmall(state.grid, solids, state.velocity, state.phi);
  collapsePockets(state.grid, filled, sorter, cellMark, state.positive, collapsed);
}

void LiquidSolver::Internals::pour(double dt, const ImmersedGas& gas, LiquidStepReport& report) {
  const std::vector<PouredVolume>& poured = inflows.stamp(state.time + dt, dt, state.phi, solids);
  for (const PouredVolume& p : poured) report.poured += p.volume;
  extension.apply(state.phi);
  bodies.find(state.grid, state.phi, solids);
  volumeControl.update(bodies, state.velocity, dt, poured, gas);
}

void LiquidSolver::Internals::moveVelocity(double dt) {
  velocityAdvector.advance(params.velocityAdvection, state.phi, dt, state.velocity);
  constrainToSolids(solids, state.velocity);
  inflows.setVelocity(state.velocity);
}

void LiquidSolver::Internals::project(double dt, LiquidStepReport& report) {
  source.fill(0);
  if (params.volumeControl) volumeControl.addSource(bodies, solids, dt, source);
  inflows.addSource(source);
  report.drained += outflows.pump(state.time + dt, dt, state.phi, solids, source, volumeControl);
  const ProjectionReport solve =
      projection.project(state.phi, solids, dt, source, state.velocity, state.pressureGradient);
  report.pressureIterations += solve.iterations;
  report.pressureResidual = std::max(report.pressureResidual, solve.residual);
  report.divergence = std::max(report.divergence, solve.divergence);
}

void LiquidSolver::Internals::extrapolate() {
  const int layers = static_cast<int>(std::ceil(params.cfl)) + kStencilReach;
  extrapolator.apply(state.phi, solids, layers, state.velocity);
  constrainToSolids(solids, state.velocity);
}

void LiquidSolver::Internals::checkFinite(double dt) const {
  if (std::isfinite(maxSpeed)) return;
  std::ostringstream message;
  message << "liquid: the velocity is not finite after the projection at t = " << state.time + dt
          << " s, dt = " << dt << " s";
  throw NumericalFailure(message.str());
}

void LiquidSolver::Internals::subStep(double dt, const ImmersedGas& gas, LiquidStepReport& report,
                                      StageClock& clock) {
  clock.time("solids", [&] { moveSolids(dt); });
  clock.time("transport", [&] { transport(dt, report); });
  clock.time("correction", [&] { correctSurface(); });
  clock.time("reinitialize", [&] { reinitializer.apply(state.phi, &solids), extension.apply(state.phi); });
  clock.time("escape", [&] { loseMarkers(dt); });
  clock.time("correction", [&] { correctSurface(); });
  clock.time("reseed", [&] { reseed(); });
  clock.time("pockets", [&] { fillPockets(); });
  clock.time("inflow", [&] { pour(dt, gas, report); });
  clock.time("advection", [&] { moveVelocity(dt); });
  clock.time("pressure", [&] { project(dt, report); });
  clock.time("extrapolation", [&] { extrapolate(); });
  report.cfl = std::max(report.cfl, maxSpeed * dt / state.grid.dx);
  maxSpeed = maxFaceSpeed(state.phi, state.velocity);
  checkFinite(dt);
  state.volume = volumeControl.ledger();
  state.time += dt;
  ++state.subSteps;
  ++report.subSteps;
}

void LiquidSolver::Internals::measure(LiquidStepReport& report) {
  computeLiquidFraction(state.phi, solids, static_cast<float>(state.grid.dx), fraction);
  const LiquidEnergy energy =
      liquidEnergy(state.grid, fraction, state.velocity, params.density, params.gravity);
  report.kineticEnergy = energy.kinetic;
  report.potentialEnergy = energy.potential;
  report.maxSpeed = maxSpeed;
  report.liquidVolume = fluid::liquidVolume(state.grid, state.phi, solids);
  report.targetVolume = volumeControl.targetVolume();
  report.positiveMarkers = state.positive.size();
  report.negativeMarkers = state.negative.size();
}

LiquidSolver::LiquidSolver(FluidParams params, LiquidSetup setup,
                           const std::function<double(const Eigen::Vector3d&)>& phi0) {
  params.validate();
  internals_ = std::make_unique<Internals>(std::move(params), std::move(setup));
  Internals& in = *internals_;
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
  in.bodies.find(in.state.grid, in.state.phi, in.solids);
  in.volumeControl.start(in.bodies);
  in.state.volume = in.volumeControl.ledger();
}

LiquidSolver::LiquidSolver(FluidParams params, LiquidSetup setup, LiquidState state) {
  params.validate();
  internals_ = std::make_unique<Internals>(std::move(params), std::move(setup));
  internals_->state = std::move(state);
  internals_->start();
  internals_->resumeControl();
}

LiquidSolver::~LiquidSolver() = default;
LiquidSolver::LiquidSolver(LiquidSolver&&) noexcept = default;

LiquidStepReport LiquidSolver::step(double dt, const ImmersedGas& gas) {
  Internals& in = *internals_;
  in.before = in.state;
  in.escapedBefore = in.escaped.size();
  in.collapsedBefore = in.collapsed.size();
  LiquidStepReport report;
  StageClock clock;
  const double end = in.state.time + dt;
  try {
    for (double remaining = dt; remaining > 0;) {
      const int left = in.subStepsFor(remaining);
      in.subStep(remaining / left, gas, report, clock);
      remaining = left == 1 ? 0 : remaining * (left - 1) / left;
    }
  } catch (const NumericalFailure&) {
    rollBack();
    throw;
  }
  in.state.time = end;
  in.measure(report);
  report.stages = clock.stages();
  return report;
}

void LiquidSolver::rollBack() {
  Internals& in = *internals_;
  in.state = in.before;
  in.escaped.resize(in.escapedBefore);
  in.collapsed.resize(in.collapsedBefore);
  in.start();
  in.resumeControl();
}

double LiquidSolver::stableDt(int maxSubSteps) const {
  return maxSubSteps * internals_->longestStep(internals_->params.cfl * internals_->state.grid.dx);
}

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
