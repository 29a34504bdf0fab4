#include "foam/wall_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
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
/// Brakes are left as they are where friction is that of the pin to within this share.
constexpr double kSameBrake = 0.05;
/// Rounds of a solve after which brakes are set anew. What they leave of a crowd's slipping waits for the
/// next step: a brake that lags takes energy, whatever it is.
constexpr int kBrakeRounds = 2;

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

void WallContacts::begin(const std::vector<NearWalls>& walls, const std::vector<LinearMotion>& motion,
                         const std::vector<double>& mass, double dt, Vectors3& change, BlockSystem& system,
                         Vectors3& impulse) {
  walls_ = walls.data(), room_.resize(walls.size()), round_ = 0;
  closed_.assign(grip_.size(), 0), brake_.assign(grip_.size(), 0.0);
  forEachIndex(grip_.size(), [&](std::size_t i) {
    Grip& grip = grip_[i];
    const Vector3d velocity = motion[i].velocity + change[i];
    for (int k = 0; k < walls_[i].count; ++k)
      updateContact(i, k, motion[i].velocity, velocity, dt, system, impulse);
    room_[i] = roomOf(i, motion[i].velocity, dt);
    if (grip.adhesion == 0 || walls_[i].count == 0) return;
    const NearWall& wall = walls_[i].wall[0];
    // Eq. 7, -s psi grad psi, implicit: the spring rests with the bubble's centre on the wall.
    system.own[i] += dt * dt * grip.adhesion * wall.away * wall.away.transpose();
    impulse[i] -= dt * grip.adhesion * wall.psiAfter(motion[i].velocity, dt) * wall.away;
    grip.hold = (mass[i] + dt * dt * grip.stiffness) / kGiveWay;
    const Vector3d slip = alongWall(wall) * (velocity - wall.velocity);
    const double strength = dt * grip.pinning, speed = slip.norm();
    const bool sticks = grip.hold * speed <= strength;
    if (sticks) change[i] -= slip;
    setBrake(i, sticks ? grip.hold : strength / speed, motion[i].velocity, system, impulse);
  });
}

const std::vector<std::int32_t>& WallContacts::update(const std::vector<LinearMotion>& motion,
                                                      const Vectors3& left, double dt, Vectors3& change,
                                                      BlockSystem& system, Vectors3& impulse) {
  const bool setsBrakes = round_++ < kBrakeRounds;
  isChanged_.resize(grip_.size());
  forEachIndex(grip_.size(), [&](std::size_t i) {
    isChanged_[i] = 0;
    if (change[i].squaredNorm() < room_[i] * room_[i]) return;
    const Vector3d predicted = motion[i].velocity, velocity = predicted + change[i];
    bool changed = false;
    for (int k = 0; k < walls_[i].count; ++k)
      changed |= updateContact(i, k, predicted, velocity, dt, system, impulse);
    if (setsBrakes && brake_[i] > 0)
      changed |= updateBrake(i, predicted, left[i].norm(), dt, change[i], system, impulse);
    isChanged_[i] = changed;
    if (changed) room_[i] = roomOf(i, predicted, dt);
  });
  changed_.clear();
  for (std::size_t i = 0; i < isChanged_.size(); ++i)
    if (isChanged_[i]) changed_.push_back(static_cast<std::int32_t>(i));
  return changed_;
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

/// Most bubbles are far from all walls, and to find that out again in every round takes a look at one number.
double WallContacts::roomOf(std::size_t i, const Vector3d& predicted, double dt) const {
  constexpr double kSurely = 0.999;  // with room for rounding
  const Grip& grip = grip_[i];
  if (closed_[i] || brake_[i] > 0 || grip.adhesion > 0) return 0;
  double room = std::numeric_limits<double>::max();
  for (int k = 0; k < walls_[i].count; ++k) {
    const NearWall& wall = walls_[i].wall[k];
    const double above = wall.psiAfter(predicted, dt) - (k == 0 ? grip.gap : grip.radius);
    room = std::min(room, kSurely * above / (dt * wall.away.norm()));
  }
  return std::max(0.0, room);
}

void WallContacts::setBrake(std::size_t i, double brake, const Vector3d& predicted, BlockSystem& system,
                            Vectors3& impulse) {
  const NearWall& wall = walls_[i].wall[0];
  const Matrix3d more = (brake - brake_[i]) * alongWall(wall);
  system.own[i] += more;
  impulse[i] -= more * (predicted - wall.velocity);
  brake_[i] = brake;
}

/// Coulomb's law for one bubble while its neighbours keep their velocities. The slip v found with the brake b
/// shows what it would take to stop the bubble, (D + b) v where D is all else that resists it; less than the
/// pin's strength s stops it, otherwise the slip becomes ((D + b) v - s) / D.
bool WallContacts::updateBrake(std::size_t i, const Vector3d& predicted, double error, double dt,
                               Vector3d& change, BlockSystem& system, Vectors3& impulse) {
  const NearWall& wall = walls_[i].wall[0];
  const Matrix3d along = alongWall(wall);
  const Vector3d slip = along * (predicted + change - wall.velocity);
  const double speed = slip.norm(), strength = dt * grip_[i].pinning, before = brake_[i];
  const double other = 0.5 * (along * (system.diagonal(i) - before * along)).trace();
  const double excess = (other + before) * speed - strength;
  const bool sticks = excess <= error;
  const double brake = sticks ? grip_[i].hold : std::min(grip_[i].hold, strength * other / excess);
  if (std::abs(brake - before) <= kSameBrake * before) return false;
  change -= sticks ? slip : (1 - excess / (other * speed)) * slip;
  setBrake(i, brake, predicted, system, impulse);
  return true;
}

}  // namespace spume::foam
