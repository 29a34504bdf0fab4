#include "foam/forces/drag.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spume::foam {
namespace {

constexpr double kSmallestRadius = 1e-7,
                 kLargestRadius = 1;  // [m] ends of the table: beyond them the end value holds
// 256 nodes a decade keep linear interpolation of ln c within 1e-5 of the law, away from its one kink.
constexpr int kNodesPerDecade = 256;
constexpr double kLongTime =
    300;  // relaxation times after which nothing is left; cosh would overflow beyond 700
constexpr double kEarthGravity = 9.80665;  // [m/s^2] defines C_D(d) when gravity is off

double gravityOf(const FoamParams& params) {
  const double g = params.gravity.norm();
  return g > 0 ? g : kEarthGravity;
}

bool hasConstantCoefficient(const FoamParams& params, double radius) {
  return params.dragLaw == DragLaw::coefficient && radius <= params.dragCoefficientLimit;
}

/// c in c r^2 v^2 = 4/3 pi r^3 (rho - rho_gas) g at the terminal speed.
double coefficientAtTerminalSpeed(const FoamParams& params, double radius) {
  const double speed = terminalSpeed(params, 2 * radius);
  return 0.5 * std::numbers::pi * params.density * dragCoefficientAt(params, 2 * radius, speed);
}

double nodePosition(double radius) { return std::log10(radius / kSmallestRadius) * kNodesPerDecade; }

/// Solution of y' = 1 - |y| y, and the share of a small slip across it that is left.
struct ScaledSlip {
  double along, acrossShare;
};

ScaledSlip scaledSlipAfter(double start, double time) {
  if (start < 0) {  // against the force: y' = 1 + y^2, y = tan, until the motion turns
    const double angle = std::atan(start), turned = angle + time;
    if (turned <= 0) return {std::tan(turned), std::cos(angle) / std::cos(turned)};
    const ScaledSlip after = scaledSlipAfter(0, turned);
    return {after.along, std::cos(angle) * after.acrossShare};
  }
  // y = (y0 + tanh t) / (1 + y0 tanh t), below the terminal speed and above it.
  const double growth = std::tanh(time), fade = 1 + start * growth;
  return {(start + growth) / fade, 1 / (std::cosh(std::min(time, kLongTime)) * fade)};
}

}  // namespace

double dragCoefficientAt(const FoamParams& params, double diameter, double speed) {
  const double reynolds = params.density * speed * diameter / params.viscosity;
  const double difference = params.density - params.gasDensity;
  const double eotvos = difference * gravityOf(params) * diameter * diameter / params.surfaceTension;
  const double deformed = 8.0 / 3.0 * eotvos / (eotvos + 4);
  const double inertial = 1 + 0.15 * std::pow(reynolds, 0.687);
  if (params.dragLaw == DragLaw::clean)
    return std::max(std::min(16 / reynolds * inertial, 48 / reynolds), deformed);
  return std::max(24 / reynolds * inertial, deformed);
}

double terminalSpeed(const FoamParams& params, double diameter) {
  const double drive = std::max(params.density - params.gasDensity, 0.0) * gravityOf(params);
  if (hasConstantCoefficient(params, 0.5 * diameter))
    return std::sqrt(2 * std::numbers::pi * diameter * drive / (3 * params.dragCoefficient));
  // Above the limit of the constant coefficient the contaminated law holds, as dragCoefficientAt() takes it.
  // C_D v^2 grows with v from 0 without bound: bisection in ln v cannot fail.
  const double wanted = 4 * diameter * drive / (3 * params.density);
  double low = std::log(1e-12), high = std::log(1e6);
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high), speed = std::exp(middle);
    (dragCoefficientAt(params, diameter, speed) * speed * speed < wanted ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

DragLawTable::DragLawTable(const FoamParams& params) {
  if (params.dragLaw == DragLaw::coefficient)
    constant_ = params.dragCoefficient, constantBelow_ = params.dragCoefficientLimit;
  if (constantBelow_ >= kLargestRadius) return;
  FoamParams physical = params;
  if (params.dragLaw == DragLaw::coefficient) physical.dragLaw = DragLaw::contaminated;
  const int nodes = static_cast<int>(nodePosition(kLargestRadius)) + 2;
  for (int node = 0; node < nodes; ++node) {
    const double radius = kSmallestRadius * std::pow(10.0, static_cast<double>(node) / kNodesPerDecade);
    logCoefficient_.push_back(std::log(coefficientAtTerminalSpeed(physical, radius)));
  }
}

double DragLawTable::operator()(double radius) const {
  if (radius <= constantBelow_ || logCoefficient_.empty()) return constant_;
  const double last = static_cast<double>(logCoefficient_.size() - 1);
  const double position = std::clamp(nodePosition(radius), 0.0, last - 1e-9);
  const auto node = static_cast<std::size_t>(position);
  const double share = position - static_cast<double>(node);
  return std::exp((1 - share) * logCoefficient_[node] + share * logCoefficient_[node + 1]);
}

double viscousDragFactor(const FoamParams& params, double radius, double immersed) {
  const double stokes = params.dragLaw == DragLaw::clean ? 4 : 6;
  return stokes * std::numbers::pi * params.viscosity * radius * immersed;
}

Eigen::Vector3d dragForce(double k, const Eigen::Vector3d& slip) { return -k * slip.norm() * slip; }

Eigen::Vector3d slipAfter(const Eigen::Vector3d& slip, const Eigen::Vector3d& force, double k, double mass,
                          double dt) {
  const double push = force.norm();
  if (k == 0) return slip + dt / mass * force;
  if (push == 0) return slip / (1 + dt * k * slip.norm() / mass);
  const Eigen::Vector3d axis = force / push;
  const double terminal = std::sqrt(push / k), along = axis.dot(slip);
  const Eigen::Vector3d across = slip - along * axis;
  const ScaledSlip end = scaledSlipAfter(along / terminal, dt * std::sqrt(push * k) / mass);
  // What the slip across the force adds to the drag, beyond that of the motion along it.
  const double extra = 1 + dt * k * (slip.norm() - std::abs(along)) / mass;
  return (end.along * terminal * axis + end.acrossShare * across) / extra;
}

Eigen::Matrix3d meanDragJacobian(double k, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  // Three-point Gauss rule; exact while the slip keeps its direction, and positive always.
  constexpr double kOuter = 0.774596669241483377;
  const Eigen::Vector3d middle = 0.5 * (from + to), outer = 0.5 * kOuter * (to - from);
  const Eigen::Vector3d slips[] = {middle - outer, middle, middle + outer};
  constexpr double kWeights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  double speeds = 0;
  for (int point = 0; point < 3; ++point) {
    const double speed = slips[point].norm();
    if (speed == 0) continue;
    speeds += kWeights[point] * speed;
    mean += slips[point] * (kWeights[point] / speed * slips[point]).transpose();
  }
  mean.diagonal().array() += speeds;
  return -k * mean;
}

}  // namespace spume::foam
