#include <algorithm>
#include <cmath>
#include <numbers>

#include "fluid/transport_study.h"

namespace spume::fluid {
namespace {

constexpr double kPi = std::numbers::pi;

/// Signed distance to a half-infinite slot |x| < halfWidth, y < top.
double slotDistance(double x, double y, double halfWidth, double top) {
  const double dx = std::abs(x) - halfWidth, dy = y - top;
  const double outside = std::hypot(std::max(dx, 0.0), std::max(dy, 0.0));
  return outside + std::min(std::max(dx, dy), 0.0);
}

/// Signed distance to a ball less a slot whose mouth is wide open below. Exact but outside the slot's mouth,
/// where the distance to its two rims is taken.
double slottedDistance(double ball, double slot, double rimX, double rimY) {
  const double cut = std::max(ball, -slot);
  // Inside the slot's mouth, past the ball's edge, the nearest surface points are the rims.
  return ball > 0 && slot < 0 ? std::hypot(rimX, rimY) : cut;
}

Eigen::Vector3d rotation(const Eigen::Vector3d& x, const Eigen::Vector3d& centre, double rate) {
  return {rate * (centre.y() - x.y()), rate * (x.x() - centre.x()), 0};
}

/// A disk with its centre at `height`, cut by a slot from below up to `top`.
struct SlottedDisk {
  double box, height, radius, slotWidth, top;
};

/// The disk as it turns about the middle of its box.
TransportCase turningDisk(const SlottedDisk& disk, double rate) {
  const double halfSlot = 0.5 * disk.slotWidth, middle = 0.5 * disk.box;
  TransportCase scene;
  scene.size = {disk.box, disk.box, 0};
  scene.planar = true;
  scene.phi0 = [=](const Eigen::Vector3d& x) {
    const double ax = x.x() - middle, ay = x.y() - disk.height;
    const double ball = std::hypot(ax, ay) - disk.radius;
    const double slot = slotDistance(ax, x.y(), halfSlot, disk.top);
    const double rimDrop = std::sqrt(disk.radius * disk.radius - halfSlot * halfSlot);
    return ay < 0 ? slottedDistance(ball, slot, halfSlot - std::abs(ax), ay + rimDrop)
                  : std::max(ball, -slot);
  };
  scene.velocity = [=](const Eigen::Vector3d& x) { return rotation(x, {middle, middle, 0}, rate); };
  return scene;
}

}  // namespace

TransportCase zalesakDisk() {
  TransportCase scene =
      turningDisk({.box = 100, .height = 75, .radius = 15, .slotWidth = 5, .top = 85}, kPi / 314);
  scene.name = "zalesak disk";
  scene.duration = 628;
  return scene;
}

TransportCase rudmanDisk() {
  TransportCase scene =
      turningDisk({.box = 4, .height = 2.75, .radius = 0.5, .slotWidth = 0.12, .top = 2.85}, 1);
  scene.name = "rudman disk";
  scene.duration = 2 * kPi;
  return scene;
}

TransportCase zalesakSphere() {
  constexpr double kRadius = 0.15, kHalfSlot = 0.025, kTop = 0.725;
  const Eigen::Vector3d middle(0.5, 0.75, 0.5);
  TransportCase scene{"zalesak sphere", {1, 1, 1}, false, 1, {}, {}, {}};
  scene.phi0 = [=](const Eigen::Vector3d& x) {
    const Eigen::Vector3d a = x - middle;
    const double ball = a.norm() - kRadius;
    const double slot = slotDistance(a.x(), x.y(), kHalfSlot, kTop);
    const double rim = std::sqrt(kRadius * kRadius - kHalfSlot * kHalfSlot);
    const double across = std::hypot(a.y(), a.z());
    return a.y() < 0 ? slottedDistance(ball, slot, kHalfSlot - std::abs(a.x()), across - rim)
                     : std::max(ball, -slot);
  };
  scene.velocity = [](const Eigen::Vector3d& x) { return rotation(x, {0.5, 0.5, 0.5}, 2 * kPi); };
  return scene;
}

TransportCase singleVortex() {
  TransportCase scene{"single vortex", {1, 1, 0}, true, 8, {}, {}, {}};
  scene.phi0 = [](const Eigen::Vector3d& x) { return std::hypot(x.x() - 0.5, x.y() - 0.75) - 0.15; };
  scene.velocity = [](const Eigen::Vector3d& x) {
    const double sx = std::sin(kPi * x.x()), sy = std::sin(kPi * x.y());
    return Eigen::Vector3d(sx * sx * std::sin(2 * kPi * x.y()), -sy * sy * std::sin(2 * kPi * x.x()), 0);
  };
  scene.timeFactor = [](double t) { return std::cos(kPi * t / 8); };
  return scene;
}

TransportCase enrightDeformation() {
  TransportCase scene{"enright deformation", {1, 1, 1}, false, 3, {}, {}, {}};
  scene.phi0 = [](const Eigen::Vector3d& x) { return (x - Eigen::Vector3d::Constant(0.35)).norm() - 0.15; };
  scene.velocity = [](const Eigen::Vector3d& x) {
    const Eigen::Vector3d s = (kPi * x).array().sin(), d = (2 * kPi * x).array().sin();
    return Eigen::Vector3d(2 * s.x() * s.x() * d.y() * d.z(), -d.x() * s.y() * s.y() * d.z(),
                           -d.x() * d.y() * s.z() * s.z());
  };
  scene.timeFactor = [](double t) { return std::cos(kPi * t / 3); };
  return scene;
}

}  // namespace spume::fluid
