#pragma once

#include <cstdint>
#include <vector>

#include "foam/block_system.h"
#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/near_walls.h"
#include "foam/surroundings.h"

namespace spume::foam {

/// Everything that happens between bubbles and solids within a step: one-sided contact springs, adhesion and
/// pinning. What is closed and how strongly a wall brakes depends on the motion sought, so the solve
/// alternates with update().
///
/// Pinning is Coulomb's law with a force that does not depend on the pressure: no slip under a smaller pull,
/// friction of just that force against any slip. Within a solve it is a viscous brake, strength / |slip|, at
/// most `hold`: never does it drive a bubble, and each round of the solve that follows it dissipates.
class WallContacts {
 public:
  /// Notes which bubbles adhere (`touchedSolid`) and how stiff their contacts are. `immersed` = chi of each.
  void describe(const FoamParams& params, const Surroundings& around, const std::vector<double>& immersed,
                BubbleStore& bubbles);

  /// Adds contacts, adhesion and brakes to the system of the change against the velocities `before`, as
  /// suits before + change, of which it takes the slip of what is stuck: a start from which the stiff hold of
  /// one bubble does not set the scale of the residual of all. Returns these bubbles. `walls` are looked at
  /// by update() too; `expected`: by how much one may expect each velocity to change [m/s].
  const std::vector<std::int32_t>& begin(const std::vector<NearWalls>& walls, const Vectors3& before,
                                         const std::vector<double>& expected, const std::vector<double>& mass,
                                         double dt, Vectors3& change, BlockSystem& system, Vectors3& impulse);

  /// Closes and opens contacts, in the first rounds also sets brakes anew, to suit before + change; returns
  /// the bubbles for which any changed. A closed contact is a spring in the system, so it stops a bubble
  /// however its neighbours push. `left` is what the solve leaves of each row [N s]: no pin gives way to
  /// less. Gives bubbles whose brake has changed the slip that suits it.
  const std::vector<std::int32_t>& update(const Vectors3& before, const Vectors3& left, double dt,
                                          Vectors3& change, BlockSystem& system, Vectors3& impulse);

  /// Whether the next update() would change anything for bubble i with this velocity.
  bool isChangedBy(std::size_t i, const Eigen::Vector3d& velocity, double dt) const;
  /// The bubbles of which one may expect that, as little as their velocities would have to go on changing.
  const std::vector<std::int32_t>& doubtful() const { return doubtful_; }

 private:
  /// How a bubble meets solids.
  struct Grip {
    double radius = 0;
    double gap = 0;        ///< psi below which the wall pushes [m]
    double stiffness = 0;  ///< of that push [N/m]
    double adhesion = 0;   ///< s_sad of a bubble that adheres, else 0 [N/m]
    double pinning = 0;    ///< force it takes to make it slide [N]
    double hold = 0;       ///< brake of a stuck bubble, large against all else [kg]
  };

  /// What an update finds of a bubble, in bits.
  static constexpr std::uint8_t kChanged = 1, kDoubtful = 2;

  double gapOf(std::size_t i, int k) const;
  double overlapOf(std::size_t i, int k, const Eigen::Vector3d& velocity, double dt) const;
  bool flips(std::size_t i, int k, double overlap) const;
  bool isDoubtful(std::size_t i, const Eigen::Vector3d& before, const Eigen::Vector3d& change, double dt);
  bool isInDoubt(std::size_t i, const Eigen::Vector3d& velocity, double moved, double dt) const;
  void listFound();
  bool updateContact(std::size_t i, int k, const Eigen::Vector3d& before, const Eigen::Vector3d& velocity,
                     double dt, BlockSystem& system, Vectors3& impulse);
  bool updateBrake(std::size_t i, const Eigen::Vector3d& before, double error, double dt,
                   Eigen::Vector3d& change, BlockSystem& system, Vectors3& impulse);
  double roomOf(std::size_t i, const Eigen::Vector3d& before, double dt) const;
  void setBrake(std::size_t i, double brake, const Eigen::Vector3d& before, BlockSystem& system,
                Vectors3& impulse);

  const NearWalls* walls_ = nullptr;  ///< of each bubble, the caller's
  std::vector<Grip> grip_;
  int round_ = 0;                     ///< of the solve
  std::vector<double> brake_;         ///< friction along the first wall: impulse per slip [kg]
  std::vector<std::uint8_t> closed_;  ///< bit k: the spring of wall k is closed
  /// Change of its velocity below which nothing about a bubble's walls changes, 0 if it has to be looked at
  /// in every round [m/s].
  std::vector<double> room_;
  Vectors3 seen_;                                 ///< change of a bubble's velocity as last looked at [m/s]
  std::vector<std::uint8_t> found_;               ///< by the last update()
  std::vector<std::int32_t> changed_, doubtful_;  ///< bubbles of which it or begin() has found that
};

}  // namespace spume::foam
