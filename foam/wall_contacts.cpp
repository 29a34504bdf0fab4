#include "foam/wall_contacts.h"

#include <cmath>
#include <functional>
#include <utility>

#include "foam/forces/solid_adhesion.h"
#include "foam/forces/strong_spring.h"
#include "foam/forces/wall_contact.h"
#include "foam/parallel.h"

namespace spume::foam {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Contacts open or closed by less than this share of a radius are left as they are: far below any visible
/// gap, and the force left over is as far below the spring's.
constexpr double kResolution = 1e-6;
/// A stuck bubble gives way by this share of what it would do freely.
constexpr double kGiveWay = 1e-6;

/// Projection onto the plane of a wall.
Matrix3d alongWall(const NearWall& wall) {
  const Vector3d normal = wall.away.normalized();
  return Matrix3d::Identity() - normal * normal.transpose();
}

}  // namespace

void WallContacts::describe(const FoamParams& params, const Surroundings& around,
                            const std::vector<double>& immersed, BubbleStore& bubbles) {
  grip_.resize(bubbles.size());
  forEachIndex(bubbles.size(), [&](std::size_t i) {
    const SolidSurface& solid = params.surfaceOf(around.solid[i]);
    const double r = bubbles.radius[i], psi = around.psi[i];
    const bool touches = bubbles.touchedSolid[i] || psi <= r;
    const bool sticks = touches && adheres(params, solid, bubbles.gas[i], r, immersed[i], psi);
    bubbles.touchedSolid[i] = sticks;
    grip_[i] = {.radius = r,
                .gap = sticks ? 0 : r,
                .stiffness = params.wallStiffnessFactor * springStiffness(params, r, r)};
    if (sticks) grip_[i].adhesion = solid.adhesion, grip_[i].pinning = pinningForce(params, solid);
  });
}

void WallContacts::begin(std::vector<NearWalls> walls, const std::vector<LinearMotion>& motion,
                         const std::vector<double>& mass, double dt, BlockSystem& system, Vectors3& impulse) {
  walls_ = std::move(walls);
  closed_.assign(grip_.size(), 0), pin_.assign(grip_.size(), Pin::none);
  slide_.resize(grip_.size());
  forEachIndex(grip_.size(), [&](std::size_t i) {
    Grip& grip = grip_[i];
    for (int k = 0; k < walls_[i].count; ++k)
      updateContact(i, k, motion[i].velocity, motion[i].velocity, dt, system, impulse);
    if (grip.adhesion == 0 || walls_[i].count == 0) return;
    const NearWall& wall = walls_[i].wall[0];
    // Eq. 7, -s psi grad psi, implicit: the spring rests with the bubble's centre on the wall.
    system.own[i] += dt * dt * grip.adhesion * wall.away * wall.away.transpose();
    impulse[i] -= dt * grip.adhesion * wall.psiAfter(motion[i].velocity, dt) * wall.away;
    grip.hold = (mass[i] + dt * dt * grip.stiffness) / kGiveWay;
    pin_[i] = Pin::stuck;
    addHold(i, 1, motion[i].velocity, system, impulse);
  });
}

void WallContacts::stopHeld(const std::vector<LinearMotion>& motion, Vectors3& change) const {
  forEachIndex(pin_.size(), [&](std::size_t i) {
    if (pin_[i] != Pin::stuck) return;
    const NearWall& wall = walls_[i].wall[0];
    change[i] -= alongWall(wall) * (motion[i].velocity + change[i] - wall.velocity);
  });
}

bool WallContacts::update(const std::vector<LinearMotion>& motion, const Vectors3& left, double dt,
                          Vectors3& change, BlockSystem& system, Vectors3& impulse) {
  const auto updateBubble = [&](std::size_t i) {
    const Vector3d velocity = motion[i].velocity + change[i];
    bool changed = false;
    for (int k = 0; k < walls_[i].count; ++k)
      changed |= updateContact(i, k, motion[i].velocity, velocity, dt, system, impulse);
    const double error = left[i].norm();
    if (pin_[i] == Pin::stuck)
      changed |= releasePin(i, motion[i].velocity, velocity, error, dt, system, impulse);
    else if (pin_[i] == Pin::sliding)
      changed |= takeAgain(i, motion[i].velocity, error, dt, change[i], system, impulse);
    return changed;
  };
  return reduceIndices(grip_.size(), false, updateBubble, std::logical_or<>());
}

bool WallContacts::updateContact(std::size_t i, int k, const Vector3d& predicted, const Vector3d& velocity,
                                 double dt, BlockSystem& system, Vectors3& impulse) {
  const Grip& grip = grip_[i];
  const NearWall& wall = walls_[i].wall[k];
  const auto bit = static_cast<std::uint8_t>(1u << k);
  // Only the wall a bubble adheres to lets its centre come to it.
  const double gap = k == 0 ? grip.gap : grip.radius;
  const double overlap = gap - wall.psiAfter(velocity, dt);
  const bool closes = overlap > 0, isClosed = closed_[i] & bit;
  if (closes == isClosed || std::abs(overlap) < kResolution * grip.radius) return false;
  closed_[i] ^= bit;
  const double signedDt = closes ? dt : -dt;
  const double push = wallContact(grip.stiffness, wall.psiAfter(predicted, dt), gap);
  system.own[i] -= signedDt * dt * wallContactSlope(grip.stiffness) * wall.away * wall.away.transpose();
  impulse[i] += signedDt * push * wall.away;
  return true;
}

void WallContacts::addHold(std::size_t i, double sign, const Vector3d& predicted, BlockSystem& system,
                           Vectors3& impulse) const {
  const NearWall& wall = walls_[i].wall[0];
  const Matrix3d hold = sign * grip_[i].hold * alongWall(wall);
  system.own[i] += hold;
  impulse[i] -= hold * (predicted - wall.velocity);
}

bool WallContacts::releasePin(std::size_t i, const Vector3d& predicted, const Vector3d& velocity,
                              double error, double dt, BlockSystem& system, Vectors3& impulse) {
  const NearWall& wall = walls_[i].wall[0];
  const Vector3d pull = grip_[i].hold * (alongWall(wall) * (velocity - wall.velocity));
  const double strength = dt * grip_[i].pinning;
  if (pull.norm() <= strength + error) return false;
  pin_[i] = Pin::sliding;
  slide_[i] = pull.normalized();
  addHold(i, -1, predicted, system, impulse);
  impulse[i] -= strength * slide_[i];
  return true;
}

/// Friction stops a bubble, it does not send it back: one that would move against the pull that freed it was
/// freed by a push that others have taken up since.
bool WallContacts::takeAgain(std::size_t i, const Vector3d& predicted, double error, double dt,
                             Vector3d& change, BlockSystem& system, Vectors3& impulse) {
  const NearWall& wall = walls_[i].wall[0];
  const Vector3d slip = alongWall(wall) * (predicted + change - wall.velocity);
  if (!(-kGiveWay * grip_[i].hold * slide_[i].dot(slip) > error)) return false;
  change -= slip;
  pin_[i] = Pin::held;
  addHold(i, 1, predicted, system, impulse);
  impulse[i] += dt * grip_[i].pinning * slide_[i];
  return true;
}

}  // namespace spume::foam
