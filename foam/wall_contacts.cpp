#include "foam/wall_contacts.h"

#include <algorithm>
#include <cmath>
#include <cstring>
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

/// A bubble counts as doubtful while this many times the last change of its velocity would make it meet a
/// wall or leave one, and is not looked at while it would take as many times its whole change.
constexpr double kDoubt = 4, kFar = 2;

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

const std::vector<std::int32_t>& WallContacts::begin(
    const std::vector<NearWalls>& walls, const Vectors3& before, const std::vector<double>& expected,
    const std::vector<double>& mass, double dt, Vectors3& change, BlockSystem& system, Vectors3& impulse) {
  walls_ = walls.data(), room_.resize(walls.size()), round_ = 0;
  closed_.assign(grip_.size(), 0), brake_.assign(grip_.size(), 0.0);
  seen_.resize(grip_.size()), found_.resize(grip_.size());
  forEachIndex(grip_.size(), [&](std::size_t i) {
    Grip& grip = grip_[i];
    const Vector3d velocity = before[i] + change[i];
    for (int k = 0; k < walls_[i].count; ++k) updateContact(i, k, before[i], velocity, dt, system, impulse);
    room_[i] = roomOf(i, before[i], dt), seen_[i] = change[i];
    found_[i] = isInDoubt(i, velocity, expected[i], dt) ? kDoubtful : 0;
    if (grip.adhesion == 0 || walls_[i].count == 0) return;
    found_[i] = kDoubtful;
    const NearWall& wall = walls_[i].wall[0];
    // Eq. 7, -s psi grad psi, implicit: the spring rests with the bubble's centre on the wall.
    system.own[i] += dt * dt * grip.adhesion * wall.away * wall.away.transpose();
    impulse[i] -= dt * grip.adhesion * wall.psiAfter(before[i], dt) * wall.away;
    grip.hold = (mass[i] + dt * dt * grip.stiffness) / kGiveWay;
    const Vector3d slip = alongWall(wall) * (velocity - wall.velocity);
    const double strength = dt * grip.pinning, speed = slip.norm();
    const bool sticks = grip.hold * speed <= strength;
    if (sticks) change[i] -= slip, found_[i] |= kChanged;
    setBrake(i, sticks ? grip.hold : strength / speed, before[i], system, impulse);
  });
  listFound();
  return changed_;
}

const std::vector<std::int32_t>& WallContacts::update(const Vectors3& before, const Vectors3& left, double dt,
                                                      Vectors3& change, BlockSystem& system,
                                                      Vectors3& impulse) {
  const bool setsBrakes = round_++ < kBrakeRounds;
  forEachIndex(grip_.size(), [&](std::size_t i) {
    found_[i] = 0;
    if (kFar * kFar * change[i].squaredNorm() < room_[i] * room_[i]) return;
    const Vector3d velocity = before[i] + change[i];
    bool changed = false;
    for (int k = 0; k < walls_[i].count; ++k)
      changed |= updateContact(i, k, before[i], velocity, dt, system, impulse);
    if (setsBrakes && brake_[i] > 0)
      changed |= updateBrake(i, before[i], left[i].norm(), dt, change[i], system, impulse);
    if (changed) found_[i] |= kChanged, room_[i] = roomOf(i, before[i], dt);
    if (isDoubtful(i, before[i], change[i], dt)) found_[i] |= kDoubtful;
  });
  listFound();
  return changed_;
}

/// Of most bubbles nothing has been found: eight are passed over at a time.
void WallContacts::listFound() {
  changed_.clear(), doubtful_.clear();
  for (std::size_t i = 0; i < found_.size();) {
    std::uint64_t eight = 0;
    if (i + sizeof eight <= found_.size()) {
      std::memcpy(&eight, &found_[i], sizeof eight);
      if (eight == 0) {
        i += sizeof eight;
        continue;
      }
    }
    if (found_[i] & kChanged) changed_.push_back(static_cast<std::int32_t>(i));
    if (found_[i] & kDoubtful) doubtful_.push_back(static_cast<std::int32_t>(i));
    ++i;
  }
}

/// Distance at which wall k pushes [m]: only the wall a bubble adheres to lets its centre come to it.
double WallContacts::gapOf(std::size_t i, int k) const { return k == 0 ? grip_[i].gap : grip_[i].radius; }

/// By how much a bubble would be nearer to wall k than that [m].
double WallContacts::overlapOf(std::size_t i, int k, const Vector3d& velocity, double dt) const {
  return gapOf(i, k) - walls_[i].wall[k].psiAfter(velocity, dt);
}

bool WallContacts::flips(std::size_t i, int k, double overlap) const {
  const bool isClosed = closed_[i] & (1u << k);
  return (overlap > 0) != isClosed && std::abs(overlap) >= kResolution * grip_[i].radius;
}

bool WallContacts::isChangedBy(std::size_t i, const Vector3d& velocity, double dt) const {
  if (round_ < kBrakeRounds && brake_[i] > 0) return true;
  for (int k = 0; k < walls_[i].count; ++k)
    if (flips(i, k, overlapOf(i, k, velocity, dt))) return true;
  return false;
}

/// Notes the change of a bubble's velocity, for the next time.
bool WallContacts::isDoubtful(std::size_t i, const Vector3d& before, const Vector3d& change, double dt) {
  const double moved = (change - std::exchange(seen_[i], change)).norm();
  return isInDoubt(i, before + change, moved, dt);
}

/// Compares what it takes to open or close a contact with by how much the velocity has just changed.
bool WallContacts::isInDoubt(std::size_t i, const Vector3d& velocity, double moved, double dt) const {
  if (round_ < kBrakeRounds && brake_[i] > 0) return true;
  for (int k = 0; k < walls_[i].count; ++k) {
    const double overlap = overlapOf(i, k, velocity, dt);
    if (std::abs(overlap) <= kDoubt * moved * dt * walls_[i].wall[k].away.norm()) return true;
  }
  return false;
}

bool WallContacts::updateContact(std::size_t i, int k, const Vector3d& before, const Vector3d& velocity,
                                 double dt, BlockSystem& system, Vectors3& impulse) {
  const Grip& grip = grip_[i];
  const NearWall& wall = walls_[i].wall[k];
  const double overlap = overlapOf(i, k, velocity, dt);
  if (!flips(i, k, overlap)) return false;
  closed_[i] ^= static_cast<std::uint8_t>(1u << k);
  const double signedDt = overlap > 0 ? dt : -dt;
  const double push = wallContact(grip.stiffness, wall.psiAfter(before, dt), gapOf(i, k));
  system.own[i] -= signedDt * dt * wallContactSlope(grip.stiffness) * wall.away * wall.away.transpose();
  impulse[i] += signedDt * push * wall.away;
  return true;
}

/// Most bubbles are far from all walls, and to find that out again in every round takes a look at one number.
double WallContacts::roomOf(std::size_t i, const Vector3d& before, double dt) const {
  constexpr double kSurely = 0.999;  // with room for rounding
  const Grip& grip = grip_[i];
  if (closed_[i] || brake_[i] > 0 || grip.adhesion > 0) return 0;
  double room = std::numeric_limits<double>::max();
  for (int k = 0; k < walls_[i].count; ++k) {
    const NearWall& wall = walls_[i].wall[k];
    const double above = wall.psiAfter(before, dt) - gapOf(i, k);
    room = std::min(room, kSurely * above / (dt * wall.away.norm()));
  }
  return std::max(0.0, room);
}

void WallContacts::setBrake(std::size_t i, double brake, const Vector3d& before, BlockSystem& system,
                            Vectors3& impulse) {
  const NearWall& wall = walls_[i].wall[0];
  const Matrix3d more = (brake - brake_[i]) * alongWall(wall);
  system.own[i] += more;
  impulse[i] -= more * (before - wall.velocity);
  brake_[i] = brake;
}

/// Coulomb's law for one bubble while its neighbours keep their velocities. The slip v found with the brake b
/// shows what it would take to stop the bubble, (D + b) v where D is all else that resists it; less than the
/// pin's strength s stops it, otherwise the slip becomes ((D + b) v - s) / D.
bool WallContacts::updateBrake(std::size_t i, const Vector3d& before, double error, double dt,
                               Vector3d& change, BlockSystem& system, Vectors3& impulse) {
  const NearWall& wall = walls_[i].wall[0];
  const Matrix3d along = alongWall(wall);
  const Vector3d slip = along * (before + change - wall.velocity);
  const double speed = slip.norm(), strength = dt * grip_[i].pinning, former = brake_[i];
  const double other = 0.5 * (along * (system.diagonal(i) - former * along)).trace();
  const double excess = (other + former) * speed - strength;
  const bool sticks = excess <= error;
  const double brake = sticks ? grip_[i].hold : std::min(grip_[i].hold, strength * other / excess);
  if (std::abs(brake - former) <= kSameBrake * former) return false;
  change -= sticks ? slip : (1 - excess / (other * speed)) * slip;
  setBrake(i, brake, before, system, impulse);
  return true;
}

}  // namespace spume::foam
