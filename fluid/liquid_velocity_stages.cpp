// The stages of a sub-step that change the velocity.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "fluid/errors.h"
#include "fluid/liquid_stages.h"

namespace spume::fluid {
namespace {

/// Least time that the velocity advances in a sub-step, of the sub-step's: where the steps shorten suddenly
/// its lead over the surface is taken back in several.
constexpr double kLeastAdvance = 0.5;

}  // namespace

void LiquidStages::moveVelocity(double dt, LiquidStepReport& report) {
  if (params.velocityAdvection == VelocityAdvection::trapezoidal)
    acceleration.advect(state.phi, dt, velocityAdvector, state.velocity);
  else
    velocityAdvector.advance(params.velocityAdvection, state.phi, dt, state.velocity);
  slipAlongWalls();
  depositMomentum(state.grid, landed, state.velocity);
  if (!pushed.empty()) {
    report.pushes = pushes.apply(state.grid, params.density, state.phi, solids.open, pushed, state.velocity);
    pushed.clear();
  }
  constrainToSolids(solids, state.velocity);
  inflows.setVelocity(state.velocity);
}

/// Liquid that sticks to walls is slowed down there by its viscosity.
void LiquidStages::slipAlongWalls() {
  const bool sticks = params.viscosity > 0 && params.noSlip;
  if (!sticks) wallSlip.apply(state.velocity);
}

void LiquidStages::applyViscosity(double dt) { viscosity.apply(state.phi, solids, dt, state.velocity); }

/// Surface and velocity leap over each other: the velocity that carries the surface is that of the sub-step's
/// middle, which makes free fall exact and waves second order in time. This brings the velocity of a fresh
/// state there.
void LiquidStages::leapAhead(double dt) {
  if (state.subSteps > 0 || state.lead > 0) return;
  state.lead = 0.5 * dt;
  source.fill(0);
  const HeldPockets held{pockets.label(), pockets.pockets(), pocketBooks.growth(pockets, dt)};
  projection.project(state.phi, solids, state.lead, source, state.velocity, state.pressureGradient, &held);
  extrapolate();
  maxSpeed = carryingSpeed();
}

/// Time [s] by which the velocity advances in a sub-step of dt, so that it leads the surface by half of the
/// next one if that is as long.
double LiquidStages::velocityAdvance(double dt) const {
  return std::max(1.5 * dt - state.lead, kLeastAdvance * dt);
}

void LiquidStages::project(double dt, double advance, LiquidStepReport& report) {
  source.fill(0);
  if (params.volumeControl) volumeControl.addSource(bodies, solids, dt, source);
  inflows.addSource(source);
  report.drained += outflows.pump(endOf(dt), dt, state.phi, solids, source, volumeControl);
  const HeldPockets held{pockets.label(), pockets.pockets(), pocketBooks.growth(pockets, dt)};
  const ProjectionReport solve =
      projection.project(state.phi, solids, advance, source, state.velocity, state.pressureGradient, &held);
  report.pressureIterations += solve.iterations;
  report.pressureResidual = std::max(report.pressureResidual, solve.residual);
  report.divergence = std::max(report.divergence, solve.divergence);
}

void LiquidStages::extrapolate() {
  const int layers = static_cast<int>(std::ceil(params.cfl)) + kStencilReach;
  extrapolator.apply(state.phi, solids, layers, state.velocity);
  surfaceStands = true;
  constrainToSolids(solids, state.velocity);
}

void LiquidStages::checkFinite(double dt) const {
  if (std::isfinite(maxSpeed)) return;
  std::ostringstream message;
  message << "liquid: the velocity is not finite after the projection at t = " << state.time + dt
          << " s, dt = " << dt << " s";
  throw NumericalFailure(message.str());
}

}  // namespace spume::fluid
