#include "foam/integrator.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "foam/errors.h"
#include "foam/failure_text.h"
#include "foam/forces/air_drag.h"
#include "foam/forces/buoyancy.h"
#include "foam/forces/inertia.h"
#include "foam/forces/strong_spring.h"
#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// Gradients shorter than this have no direction (the middle of a thin sheet).
constexpr double kFlatGradient = 1e-6;

/// Rounds of finding out which bubbles press on a wall: each settles nearly all, and what is left waits for
/// the next step.
constexpr int kWallPasses = 8;
/// Residual at which contacts are looked at first, as a share of the first one, and each later one as a share
/// of that: who presses on a wall shows long before the velocities have all their digits, but not after the
/// few iterations that a tenth takes. Shorter steps (0.1) take a fifth more rounds for as many iterations,
/// longer ones (0.02) more iterations.
constexpr double kFirstAim = 0.01, kAimStep = 0.05;
/// Share of the solve's goal by which residuals may be off where contacts change: the last round ends with a
/// true one, but should not have to do much of the others' work.
constexpr double kAllowedDrift = 0.5;
/// Speed that counts as rest [m/s]: a micrometre in three hours.
constexpr double kRestSpeed = 1e-10;

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
  if (lone.immersed > 0) lone.drag = lone.immersed * dragLaw(lone.radius) * lone.radius * lone.radius;
  lone.airDrag = (1 - lone.immersed) * airDragFactor(params, lone.radius);
  if (lone.start == StepStart::afloat)
    lone.viscousDrag = viscousDragFactor(params, lone.radius, lone.immersed);
  lone.liquidVelocity = around.liquidVelocity.col(i);
  setSurface(params, around.gradPhi.col(i), lone);
  return lone;
}

/// As a CouplingBlock keeps it.
inline double rounded(double x) { return static_cast<float>(x); }

/// `left`: the residual of each bubble's row [kg m/s].
[[noreturn]] void failToConverge(const SolveReport& report, const Vectors3& left, const BubbleStore& bubbles,
                                 double dt) {
  const auto size = [](const Eigen::Vector3d& v) {
    return v.allFinite() ? v.norm() : std::numeric_limits<double>::infinity();
  };
  const auto less = [&](const auto& a, const auto& b) { return size(a) < size(b); };
  const auto worst = std::max_element(left.begin(), left.end(), less);
  throw NumericalFailure(
      joined("foam: the implicit step of ", bubbles.size(), " bubbles did not converge: relative residual ",
             report.residual, " after ", report.iterations, " iterations at dt = ", dt, " s, worst for ",
             placeOf(bubbles, static_cast<std::size_t>(worst - left.begin())), " with ", worst->norm(),
             " kg m/s, and the direct solver could not take over; use a shorter step or raise "
             "foam.solverIterations"));
}

}  // namespace

void Integrator::predict(const Surroundings& around, const Vectors3& attraction, double dt,
                         BubbleStore& bubbles) {
  constexpr double kNeighbourPush = 1;  // [radii] a neighbour moves a bubble by less within a step
  const std::size_t n = bubbles.size();
  lone_.resize(n), mass_.resize(n), immersed_.resize(n), motion_.resize(n), reach_.resize(n);
  forEachIndex(n, [&](std::size_t i) {
    bubbles.wetness[i] = wetnessAt(params_, around.phi[i], bubbles.wetness[i]);
    LoneBubble& lone = lone_[i] = loneBubble(params_, drag_, around, bubbles, i);
    lone.weight += attraction[i];
    mass_[i] = lone.mass, immersed_[i] = lone.immersed;
    motion_[i] = linearise(lone, predictVelocity(lone, dt), dt);
    const double speed = std::max(lone.velocity.norm(), motion_[i].velocity.norm());
    reach_[i] = (1 + kNeighbourPush) * lone.radius + dt * speed;
  });
  contacts_.describe(params_, around, immersed_, bubbles);
}

SolveReport Integrator::couple(const BubbleStore& bubbles, const FoamTopology& topology,
                               const Neighbours& neighbours, const std::vector<NearWalls>& walls, double dt) {
  const std::size_t n = lone_.size();
  findPairs(bubbles, topology, dt);
  system_.own.resize(n), impulse_.resize(n), impulseScale_.resize(n), velocity_.resize(n);
  change_.resize(n), expected_.resize(n);
  system_.start = neighbours.start;
  system_.other.resize(neighbours.other.size()), system_.block.resize(neighbours.other.size());
  forEachIndex(n, [&](std::size_t i) { assembleRow(i, bubbles.velocity, neighbours); });
  const auto& stuck =
      contacts_.begin(walls, bubbles.velocity, expected_, mass_, dt, change_, system_, impulse_);
  const SolveReport report = solveWithContacts(bubbles.velocity, stuck, dt);
  if (!report.converged) failToConverge(report, solver_.left(), bubbles, dt);
  forEachIndex(n, [&](std::size_t i) { velocity_[i] = bubbles.velocity[i] + change_[i]; });
  return report;
}

SolveReport Integrator::solveWithContacts(const Vectors3& before, const std::vector<std::int32_t>& stuck,
                                          double dt) {
  const double first = solver_.begin(system_, impulse_, change_, stuck);
  const double goal = std::max(params_.solverTolerance * first, smallestGoal());
  const auto stops = [&](std::int32_t i, const Eigen::Vector3d& change) {
    return contacts_.isChangedBy(i, before[i] + change, dt);
  };
  SolveWatch watch = {kFirstAim * first, kAimStep, kAllowedDrift * goal, {}, stops};
  SolveReport report;
  for (int pass = 0; pass < kWallPasses; ++pass) {
    if (pass == kWallPasses - 1) watch.mark = 0;
    watch.rows = contacts_.doubtful();
    const int left = params_.solverIterations - report.iterations;
    const SolveReport done = solver_.solve(system_, impulse_, goal, left, change_, watch);
    report = {report.iterations + done.iterations, done.residual, done.converged, done.stopped,
              report.fellBack || done.fellBack};
    const auto& changed = contacts_.update(before, solver_.left(), dt, change_, system_, impulse_);
    solver_.follow(system_, impulse_, change_, changed);
    if (!done.stopped && (!done.converged || changed.empty())) break;
  }
  if (first > goal) solver_.balance(system_, change_);
  return report;
}

void Integrator::findPairs(const BubbleStore& bubbles, const FoamTopology& topology, double dt) {
  constexpr std::size_t kMost = PairForces::kMost;
  const std::size_t pairs = topology.overlaps.size();
  paired_.resize(bubbles.size()), pairBlock_.resize(pairs), pairImpulse_.resize(pairs);
  forEachIndex(paired_.size(), [&](std::size_t i) {
    const Eigen::Vector3d &x = bubbles.position[i], &v = bubbles.velocity[i];
    paired_[i] = {{x.x(), x.y(), x.z()}, {v.x(), v.y(), v.z()}, bubbles.radius[i], mass_[i]};
  });
  const PairForces::Foam foam = {params_, SpringLaw(params_), bubbles, topology, paired_};
  const tbb::blocked_range<std::size_t> groups(0, (pairs + kMost - 1) / kMost, kGrain / kMost);
  tbb::parallel_for(groups, [&](const auto& range) {
    PairForces forces;
    for (std::size_t group = range.begin(); group != range.end(); ++group) {
      const std::size_t first = group * kMost, count = std::min(kMost, pairs - first);
      forces.find(foam, first, count);
      setPairs(forces, topology, first, count, dt);
    }
  });
}

/// Of pairs `first` .. `first` + `count` - 1, whose forces are known. dt^2 K + dt C with K = along n n^T +
/// across (I - n n^T): the turning part is split off so that both terms stay positive; along >= across
/// always.
void Integrator::setPairs(const PairForces& forces, const FoamTopology& topology, std::size_t first,
                          std::size_t count, double dt) {
  std::array<PairForces::Column, 3> along, impulse;
  PairForces::Column across;
  const auto &n = forces.direction, &v = forces.approach;
  for (std::size_t k = 0; k < across.size(); ++k) {
    const double root = dt * std::sqrt(forces.along[k] - forces.across[k]);
    for (int axis = 0; axis < 3; ++axis) along[axis][k] = rounded(root * n[axis][k]);
    across[k] = rounded(dt * (dt * forces.across[k] + forces.damping[k]));
    const double closing = along[0][k] * v[0][k] + along[1][k] * v[1][k] + along[2][k] * v[2][k];
    const double pull = dt * forces.tension[k];
    for (int axis = 0; axis < 3; ++axis) {
      impulse[axis][k] = pull * n[axis][k] - closing * along[axis][k] - across[k] * v[axis][k];
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    const double distance = topology.overlaps[first + k].distance;
    pairBlock_[first + k] = CouplingBlock({along[0][k], along[1][k], along[2][k]}, across[k]);
    pairImpulse_[first + k] = {{impulse[0][k], impulse[1][k], impulse[2][k]},
                               dt * (std::abs(forces.tension[k]) + forces.along[k] * distance)};
  }
}

void Integrator::assembleRow(std::size_t i, const Vectors3& before, const Neighbours& neighbours) {
  const LinearMotion& motion = motion_[i];
  const Eigen::Vector3d expected = motion.velocity - before[i];
  Eigen::Vector3d impulse = motion.matrix * expected;
  double size = mass_[i] * motion.velocity.norm();
  for (std::int32_t e = neighbours.start[i]; e < neighbours.start[i + 1]; ++e) {
    const std::int32_t pair = neighbours.pair[e], other = neighbours.other[e];
    const PairImpulse& of = pairImpulse_[pair];
    const bool first = static_cast<std::int32_t>(i) < other;
    system_.other[e] = other, system_.block[e] = pairBlock_[pair];
    impulse += first ? of.first : Eigen::Vector3d(-of.first);
    size += of.size;
  }
  system_.own[i] = motion.matrix, impulse_[i] = impulse, impulseScale_[i] = size;
  expected_[i] = expected.norm(), change_[i].setZero();
}

double Integrator::smallestGoal() const {
  const auto add = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q) { return (p + q).eval(); };
  const auto squares = [&](std::size_t i) {
    return Eigen::Vector2d(impulseScale_[i] * impulseScale_[i], mass_[i] * mass_[i]);
  };
  const Eigen::Vector2d sum = reduceIndices(mass_.size(), Eigen::Vector2d(0, 0), squares, add);
  return std::max(4 * std::numeric_limits<double>::epsilon() * std::sqrt(sum.x()),
                  kRestSpeed * std::sqrt(sum.y()));
}

Eigen::Vector3d Integrator::dragImpulse(std::size_t i, double dt) const {
  const LoneBubble& lone = lone_[i];
  if (lone.drag == 0 && lone.viscousDrag == 0) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d& v = velocity_[i];
  const Eigen::Vector3d others = motion_[i].matrix * (v - motion_[i].velocity);
  const Eigen::Vector3d forces = lone.weight + lone.surfaceForce(lone.phiAfter(v, dt)) - lone.airDrag * v;
  return lone.mass * (v - lone.velocity) - dt * forces - others;
}

double Integrator::slip(std::size_t i) const {
  const Eigen::Vector3d& u = lone_[i].liquidVelocity;
  return std::max((lone_[i].velocity - u).norm(), (velocity_[i] - u).norm());
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
