#pragma once

#include <cstdint>
#include <vector>

#include "foam/block_system.h"
#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/near_walls.h"
#include "foam/predictor.h"
#include "foam/surroundings.h"

namespace spume::foam {

/// Everything that happens between bubbles and solids within a step: one-sided contact springs, adhesion and
/// pinning. What is closed or stuck depends on the motion sought, so the solve alternates with update().
class WallContacts {
 public:
  /// Notes which bubbles adhere (`touchedSolid`) and how stiff their contacts are. `immersed` = chi of each.
  void describe(const FoamParams& params, const Surroundings& around, const std::vector<double>& immersed,
                BubbleStore& bubbles);

  /// Adds adhesion and pins to the system, for the walls found on the way of `motion`.
  void begin(std::vector<NearWalls> walls, const std::vector<LinearMotion>& motion,
             const std::vector<double>& mass, double dt, BlockSystem& system, Vectors3& impulse);

  /// Takes the part along the wall out of the motion + change of what is stuck: a start from which the stiff
  /// hold of one bubble does not set the scale of the residual of all.
  void stopHeld(const std::vector<LinearMotion>& motion, Vectors3& change) const;

  /// Closes and opens contacts, lets go of pins pulled too hard and takes those again whose friction would
  /// set them in motion, to suit motion + change; true if any changed. A closed contact is a spring in the
  /// system, so it stops a bubble however its neighbours push. `left` is
  /// what the solve leaves of each row [N s]: pins are not moved by less. Stops what is taken again.
  bool update(const std::vector<LinearMotion>& motion, const Vectors3& left, double dt, Vectors3& change,
              BlockSystem& system, Vectors3& impulse);

 private:
  /// A bubble that was let go and taken again stays `held` to the end of the step.
  enum class Pin : std::uint8_t { none, stuck, sliding, held };

  /// How a bubble meets solids.
  struct Grip {
    double radius = 0;
    double gap = 0;        ///< psi below which the wall pushes [m]
    double stiffness = 0;  ///< of that push [N/m]
    double adhesion = 0;   ///< s_sad of a bubble that adheres, else 0 [N/m]
    double pinning = 0;    ///< force it takes to make it slide [N]
    double hold = 0;       ///< of a stuck bubble: impulse per slip, large against all else [kg]
  };

  bool updateContact(std::size_t i, int k, const Eigen::Vector3d& predicted, const Eigen::Vector3d& velocity,
                     double dt, BlockSystem& system, Vectors3& impulse);
  bool releasePin(std::size_t i, const Eigen::Vector3d& predicted, const Eigen::Vector3d& velocity,
                  double error, double dt, BlockSystem& system, Vectors3& impulse);
  bool takeAgain(std::size_t i, const Eigen::Vector3d& predicted, double error, double dt,
                 Eigen::Vector3d& change, BlockSystem& system, Vectors3& impulse);
  void addHold(std::size_t i, double sign, const Eigen::Vector3d& predicted, BlockSystem& system,
               Vectors3& impulse) const;

  std::vector<NearWalls> walls_;
  std::vector<Grip> grip_;
  std::vector<Pin> pin_;
  Vectors3 slide_;                    ///< direction in which a sliding bubble was pulled [-]
  std::vector<std::uint8_t> closed_;  ///< bit k: the spring of wall k is closed
};

}  // namespace spume::foam
