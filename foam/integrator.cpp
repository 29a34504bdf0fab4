#include "foam/integrator.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "foam/errors.h"
#include "foam/forces/air_drag.h"
#include "foam/forces/buoyancy.h"
#include "foam/forces/inertia.h"
#include "foam/forces/strong_spring.h"
#include "foam/forces/wall_contact.h"
#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// Gradients shorter than this have no direction (the middle of a thin sheet).
constexpr double kFlatGradient = 1e-6;

/// Rounds of finding out which bubbles press on a wall: each settles nearly all, and what is left waits for
/// the next step.
constexpr int kWallPasses = 6;
/// Contacts open or closed by less than this share of a radius are left as they are: far below any visible
/// gap, and the force left over is as far below the spring's.
constexpr double kWallResolution = 1e-6;

/// Unit grad phi and its slope; where phi has a plateau, against gravity with slope 0.
void setSurface(const FoamParams& params, const Eigen::Vector3d& gradPhi, LoneBubble& lone) {
  const double slope = gradPhi.norm();
  const bool flat = slope < kFlatGradient;
  lone.phiSlope = flat ? 0 : slope;
  if (!flat)
    lone.up = gradPhi / slope;
  else
    lone.up =
        params.gravity.norm() > 0 ? Eigen::Vector3d(-params.gravity.normalized()) : Eigen::Vector3d::UnitY();
}

void setWall(const FoamParams& params, const Surroundings& around, std::size_t i, LoneBubble& lone) {
  lone.psi = around.psi[i];
  lone.awayFromWall = around.gradPsi.col(i);
  lone.wallSpeed = around.gradPsi.col(i).dot(around.solidVelocity.col(i));
  lone.wallGap = lone.radius;
  lone.wallStiffness = params.wallStiffnessFactor * springStiffness(params, lone.radius, lone.radius);
}

LoneBubble loneBubble(const FoamParams& params, const DragLawTable& dragLaw, const Surroundings& around,
                      const BubbleStore& bubbles, std::size_t i) {
  const double gas = bubbles.gas[i], wetness = bubbles.wetness[i];
  LoneBubble lone;
  lone.velocity = bubbles.velocity[i];
  lone.radius = bubbles.radius[i];
  lone.phi = around.phi[i];
  lone.start = stepStart(lone.phi, lone.radius);
  lone.immersed = immersedFraction(lone.phi, lone.radius);
  lone.mass = inertia(params, gas, wetness, lone.immersed);
  lone.weight = weighedMass(params, gas, wetness, lone.immersed) * params.gravity;
  lone.fullBuoyancy = fullBuoyancy(params, gas, around.gradPressure.col(i));
  lone.adhesion = bubbles.surfaceWeight[i] * params.liquidAdhesion;
  lone.drag = lone.immersed * dragLaw(lone.radius) * lone.radius * lone.radius;
  lone.airDrag = (1 - lone.immersed) * airDragFactor(params, lone.radius);
  if (lone.start == StepStart::afloat)
    lone.viscousDrag = viscousDragFactor(params, lone.radius, lone.immersed);
  lone.liquidVelocity = around.liquidVelocity.col(i);
  setSurface(params, around.gradPhi.col(i), lone);
  setWall(params, around, i, lone);
  return lone;
}

[[noreturn]] void failToConverge(const SolveReport& report, std::size_t bubbles, double dt) {
  std::ostringstream message;
  message << "foam: the implicit step of " << bubbles << " bubbles did not converge: relative residual "
          << report.residual << " after " << report.iterations << " iterations at dt = " << dt
          << " s; use a shorter step or raise foam.solverIterations";
  throw NumericalFailure(message.str());
}

}  // namespace

void Integrator::describe(const Surroundings& around, BubbleStore& bubbles) {
  const std::size_t n = bubbles.size();
  lone_.resize(n), mass_.resize(n);
  forEachIndex(n, [&](std::size_t i) {
    bubbles.wetness[i] = wetnessAt(params_, around.phi[i]);
    lone_[i] = loneBubble(params_, drag_, around, bubbles, i);
    mass_[i] = lone_[i].mass;
  });
}

void Integrator::predict(double dt) {
  motion_.resize(lone_.size());
  forEachIndex(lone_.size(),
               [&](std::size_t i) { motion_[i] = linearise(lone_[i], predictVelocity(lone_[i], dt), dt); });
}

SolveReport Integrator::couple(const BubbleStore& bubbles, const FoamTopology& topology,
                               const Neighbours& neighbours, double dt) {
  const std::size_t n = lone_.size();
  computePairForces(params_, bubbles, topology, mass_, pairForce_);
  system_.own.resize(n), impulse_.resize(n), impulseScale_.resize(n), velocity_.resize(n);
  system_.start = neighbours.start, system_.other = neighbours.other;
  system_.block.resize(neighbours.other.size());
  forEachIndex(n, [&](std::size_t i) { assembleRow(i, topology, neighbours, dt); });
  change_.assign(n, Eigen::Vector3d::Zero());
  closed_.assign(n, 0);
  SolveReport report;
  const double floor = roundOff();
  for (int pass = 0; pass < kWallPasses && (updateContacts(dt) || pass == 0); ++pass) {
    const SolveReport done =
        solver_.solve(system_, impulse_, params_.solverTolerance, floor, params_.solverIterations, change_);
    if (!done.converged) failToConverge(done, n, dt);
    report = {report.iterations + done.iterations, done.residual, true};
  }
  forEachIndex(n, [&](std::size_t i) { velocity_[i] = motion_[i].velocity + change_[i]; });
  return report;
}

bool Integrator::updateContacts(double dt) {
  const auto update = [&](std::size_t i) {
    const LoneBubble& lone = lone_[i];
    const double overlap = lone.wallGap - lone.psiAfter(motion_[i].velocity + change_[i], dt);
    const bool closed = overlap > 0;
    if (closed == static_cast<bool>(closed_[i]) || std::abs(overlap) < kWallResolution * lone.radius)
      return false;
    closed_[i] = closed;
    setWallSpring(lone, motion_[i].velocity, closed ? dt : -dt, dt, i);
    return true;
  };
  return reduceIndices(lone_.size(), false, update, std::logical_or<>());
}

void Integrator::setWallSpring(const LoneBubble& lone, const Eigen::Vector3d& velocity, double signedDt,
                               double dt, std::size_t i) {
  const Eigen::Vector3d& away = lone.awayFromWall;
  const double push = wallContact(lone.wallStiffness, lone.psiAfter(velocity, dt), lone.wallGap);
  system_.own[i] -= signedDt * dt * wallContactSlope(lone.wallStiffness) * away * away.transpose();
  impulse_[i] += signedDt * push * away;
}

void Integrator::assembleRow(std::size_t i, const FoamTopology& topology, const Neighbours& neighbours,
                             double dt) {
  const LinearMotion& motion = motion_[i];
  system_.own[i] = motion.matrix;
  impulse_[i].setZero();
  impulseScale_[i] = lone_[i].mass * motion.velocity.norm();
  for (std::int32_t e = neighbours.start[i]; e < neighbours.start[i + 1]; ++e) {
    const PairForce& pair = pairForce_[neighbours.pair[e]];
    const OverlapPair& overlap = topology.overlaps[neighbours.pair[e]];
    const bool first = overlap.i == static_cast<std::int32_t>(i);
    // dt^2 K + dt C with K = along n n^T + across (I - n n^T): the turning part is split off so that both
    // terms stay positive; along >= across always.
    const double along = dt * dt * (pair.along - pair.across);
    system_.block[e] = {std::sqrt(along) * pair.direction, dt * (dt * pair.across + pair.damping)};
    const Eigen::Vector3d approach = motion.velocity - motion_[neighbours.other[e]].velocity;
    impulse_[i] += (first ? dt : -dt) * pair.tension * pair.direction - system_.block[e].times(approach);
    impulseScale_[i] += dt * (std::abs(pair.tension) + pair.along * overlap.distance);
  }
}

double Integrator::roundOff() const {
  const double sum = reduceIndices(
      impulseScale_.size(), 0.0, [&](std::size_t i) { return impulseScale_[i] * impulseScale_[i]; },
      std::plus<>());
  return 4 * std::numeric_limits<double>::epsilon() * std::sqrt(sum);
}

double Integrator::kineticEnergy() const {
  return reduceIndices(
      mass_.size(), 0.0, [&](std::size_t i) { return 0.5 * mass_[i] * velocity_[i].squaredNorm(); },
      std::plus<>());
}

void Integrator::advance(double dt, BubbleStore& bubbles) const {
  forEachIndex(bubbles.size(), [&](std::size_t i) {
    bubbles.velocity[i] = velocity_[i];
    bubbles.position[i] += dt * velocity_[i];
  });
}

}  // namespace spume::foam
