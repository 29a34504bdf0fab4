#include "foam/predictor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "foam/forces/drag.h"

namespace spume::foam {
namespace {

using Eigen::Vector3d;

constexpr int kSweeps =
    3;  // between the motion along and across grad phi; each is exact for the other's slip
constexpr int kNewtonSteps = 60;  // bisection alone reaches round-off within these
constexpr double kRootTolerance =
    1e-13;  // relative to the bracket: well above round-off, far below any force that matters

/// Where a root lies, and how well it has to be known.
struct Bracket {
  double low, high;
  double resolution = kRootTolerance * std::max({std::abs(low), std::abs(high), high - low});
};

/// Root of an increasing function in the bracket, Newton kept inside it. `f(x)` returns {value, slope}.
template <typename Function>
double increasingRoot(const Function& f, Bracket in, double guess) {
  double x = std::clamp(guess, in.low, in.high);
  for (int step = 0; step < kNewtonSteps && in.high - in.low > in.resolution; ++step) {
    const auto [value, slope] = f(x);
    if (value == 0) return x;
    (value > 0 ? in.high : in.low) = x;
    double next = x - value / slope;
    if (std::abs(next - x) <= in.resolution) return next;  // before round-off takes it for out of the bracket
    if (!(next > in.low && next < in.high)) next = 0.5 * (in.low + in.high);
    x = next;
  }
  return x;
}

/// The step's equation written for the slip w = v - u, so that drag is central.
struct SlipEquation {
  const LoneBubble& bubble;
  double dt;
  double inertia;      ///< m + dt (a + viscous)
  double dragPerStep;  ///< dt k
  Vector3d momentum;   ///< m w0 + dt (constant forces - a u): all but the surface force
  double pull;         ///< of the momentum along grad phi [N s]
  double lift;         ///< of the full buoyancy along grad phi [N]
  double phiAtRest;    ///< at the end of the step without slip [m]

  SlipEquation(const LoneBubble& b, double step)
      : bubble(b),
        dt(step),
        inertia(b.mass + step * (b.airDrag + b.viscousDrag)),
        dragPerStep(step * b.drag) {
    momentum = b.mass * (b.velocity - b.liquidVelocity) + step * (b.weight - b.airDrag * b.liquidVelocity);
    pull = b.up.dot(momentum), lift = b.up.dot(b.fullBuoyancy);
    phiAtRest = b.phiAfter(b.liquidVelocity, step);
  }

  double phiAt(double along) const { return phiAtRest + dt * bubble.phiSlope * along; }
  static double speedOf(double along, double across) { return std::sqrt(along * along + across * across); }

  /// {value, slope} of the equation along grad phi for the slip `along`, the slip across it being known.
  std::pair<double, double> alongSurface(double along, double across) const {
    const double speed = dragPerStep > 0 ? speedOf(along, across) : 0, at = phiAt(along);
    const double drag = dragPerStep * speed;
    const double dragSlope = speed > 0 ? dragPerStep * (speed + along * along / speed) : 0;
    const double force = bubble.surfacePull(at, lift);
    const double stiffness = dt * bubble.phiSlope * bubble.surfaceStiffness(at, lift);
    return {(inertia + drag) * along - pull - dt * force, inertia + dragSlope - dt * stiffness};
  }

  /// Slip along grad phi; `near`: the guess is the answer for nearly the same slip across it.
  double solveAlong(double across, double guess, bool near) const {
    // The surface force lies between these two whatever the path, so the root does too.
    const double reach = bubble.fullBuoyancy.norm() + bubble.adhesion * bubble.radius;
    Bracket in{std::min((pull - dt * reach) / inertia, 0.0), std::max((pull + dt * reach) / inertia, 0.0)};
    const auto balance = [&](double along) { return alongSurface(along, across); };
    if (!near)
      for (const double end : {-bubble.radius, bubble.radius}) narrow(balance, slipTo(end), in);
    return increasingRoot(balance, in, guess);
  }

  /// Slip along grad phi that ends the step at a signed distance from the surface; none if no slip does.
  double slipTo(double phi) const { return (phi - phiAtRest) / (dt * bubble.phiSlope); }

  /// The bubble dips into the surface in a small part of the bracket only, and elsewhere the force does not
  /// change: Newton from the one side would not find its way to the root on the other.
  template <typename Function>
  static void narrow(const Function& balance, double at, Bracket& in) {
    if (at > in.low && at < in.high) (balance(at).first > 0 ? in.high : in.low) = at;
  }

  /// Size of the slip across grad phi under a momentum of size p, the slip along it being known.
  double solveAcross(double p, double along, double guess) const {
    if (dragPerStep == 0) return p / inertia;
    const auto balance = [&](double across) {
      const double speed = speedOf(along, across);
      const double slope = speed > 0 ? dragPerStep * (speed + across * across / speed) : 0;
      return std::pair((inertia + dragPerStep * speed) * across - p, inertia + slope);
    };
    return increasingRoot(balance, {0, p / inertia}, p / (inertia + dragPerStep * speedOf(along, guess)));
  }
};

Vector3d slipAtSurface(const SlipEquation& equation) {
  const LoneBubble& b = equation.bubble;
  const Vector3d start = b.velocity - b.liquidVelocity;
  double along = b.up.dot(start);
  Vector3d across = start - along * b.up;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    along = equation.solveAlong(across.norm(), along, sweep > 0);
    const Vector3d total = equation.momentum + equation.dt * b.surfaceForce(equation.phiAt(along));
    const Vector3d sideways = total - b.up.dot(total) * b.up;
    const double p = sideways.norm();
    if (p == 0) return along * b.up;
    across = equation.solveAcross(p, along, across.norm()) / p * sideways;
    if (equation.dragPerStep == 0) break;  // nothing but drag knows of both
  }
  return along * b.up + across;
}

/// Whether the surface force is the same at both ends of the path.
bool surfaceForceIsConstant(const LoneBubble& b, double phiEnd) {
  const bool deep = b.phi <= -b.radius && phiEnd <= -b.radius;
  const bool high = b.start == StepStart::aloft && phiEnd >= b.radius;
  return deep || high;
}

/// Whether a bubble that starts here can have a path of constant surface force at all.
bool startsOffTheSurface(const LoneBubble& b) { return b.phi <= -b.radius || b.start == StepStart::aloft; }

/// Exact while the surface force stays as it is at the start.
Vector3d velocityUnderConstantForce(const LoneBubble& b, double dt) {
  const Vector3d start = b.velocity - b.liquidVelocity;
  const Vector3d force = b.weight + b.surfaceForce(b.phi) - b.airDrag * b.velocity - b.viscousDrag * start;
  const double inertia = b.mass + dt * (b.airDrag + b.viscousDrag);
  return b.liquidVelocity + slipAfter(start, force, b.drag, inertia, dt);
}

/// Slope of a force of one variable between two points of it, never positive; the tangent where they
/// coincide.
double chord(double change, double distance, double scale, double tangent) {
  constexpr double kClose = 1e-7;  // of the bubble's radius: closer, cancellation beats the tangent's error
  return std::abs(distance) > kClose * scale ? std::min(0.0, change / distance) : tangent;
}

/// x . M^-1 x of a symmetric positive definite M, by Cramer's rule.
double alongInverse(const Eigen::Matrix3d& m, const Vector3d& x) {
  const Vector3d yz = m.col(1).cross(m.col(2)), zx = m.col(2).cross(m.col(0)), xy = m.col(0).cross(m.col(1));
  return x.dot(x.x() * yz + x.y() * zx + x.z() * xy) / m.col(0).dot(yz);
}

/// Makes `matrix` turn the motion p = v* - v0 into the impulse that holds the bubble at v0, by a change along
/// p alone. Where taking that much away would leave a direction in which the bubble runs off by itself, the
/// matrix is shortened along p instead, which keeps it positive definite.
void matchHoldingImpulse(const Vector3d& p, const Vector3d& impulse, Eigen::Matrix3d& matrix) {
  constexpr double kStill = 1e-30;  // [m/s] no motion: its square would leave the range of doubles
  constexpr double kSafe = 0.9;     // 1 is where the difference becomes singular
  const double speed = p.norm();
  if (!(speed > kStill)) return;
  const Vector3d along = p / speed;
  const double wanted = along.dot(impulse) / speed, has = along.dot(matrix * along);
  if (!(wanted > 0)) return;
  if ((has - wanted) * alongInverse(matrix, along) < kSafe) {
    matrix += (wanted - has) * along * along.transpose();
  } else {
    const Eigen::Matrix3d shorten =
        Eigen::Matrix3d::Identity() + (std::sqrt(wanted / has) - 1) * along * along.transpose();
    matrix = (shorten * matrix * shorten).eval();
  }
}

}  // namespace

Vector3d predictVelocity(const LoneBubble& b, double dt) {
  if (startsOffTheSurface(b)) {
    const Vector3d end = velocityUnderConstantForce(b, dt);
    if (surfaceForceIsConstant(b, b.phiAfter(end, dt))) return end;
  }
  return b.liquidVelocity + slipAtSurface(SlipEquation(b, dt));
}

LinearMotion linearise(const LoneBubble& b, const Vector3d& predicted, double dt) {
  const double phiA = b.phiAfter(b.velocity, dt), phiB = b.phiAfter(predicted, dt);
  const double inertia = b.mass + dt * (b.airDrag + b.viscousDrag);
  // Without drag, away from the surface, the prediction is the solution of this linear equation.
  if (b.drag == 0 && surfaceForceIsConstant(b, phiA) && surfaceForceIsConstant(b, phiB))
    return {predicted, inertia * Eigen::Matrix3d::Identity()};
  const double change = b.up.dot(b.surfaceForce(phiA) - b.surfaceForce(phiB));
  const double stiffness = -chord(change, phiA - phiB, b.radius, b.surfaceStiffness(phiB));
  LinearMotion motion{predicted, inertia * Eigen::Matrix3d::Identity()};
  motion.matrix -= dt * meanDragJacobian(b.drag, b.velocity - b.liquidVelocity, predicted - b.liquidVelocity);
  motion.matrix += dt * dt * b.phiSlope * stiffness * b.up * b.up.transpose();
  matchHoldingImpulse(predicted - b.velocity, dt * b.force(b.velocity, dt), motion.matrix);
  return motion;
}

}  // namespace spume::foam
