#pragma once

#include <vector>

#include "foam/block_system.h"
#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/foam_topology.h"
#include "foam/forces/drag.h"
#include "foam/implicit_solve.h"
#include "foam/lone_bubble.h"
#include "foam/neighbours.h"
#include "foam/pair_forces.h"
#include "foam/predictor.h"
#include "foam/surroundings.h"
#include "foam/wall_contacts.h"

namespace spume::foam {

/// The implicit step of [Busaryev 2012, Eq. 9] with its corrections: first every bubble alone, then all
/// together, (M - dt df/dv - dt^2 df/dx) dv = impulses at the old velocities, where dv is the change against
/// these: what is at rest starts with no residual, and stays at rest to round-off. Deviation: Eq. 9 lacks
/// -dt (df/dv) v and dt^2 (df/dx) v on the right; here every force contributes as it would be at the end of
/// the step if velocities stayed as they are, so both are there.
class Integrator {
 public:
  explicit Integrator(const FoamParams& params) : params_(params), drag_(params), solver_(params.solver) {}

  /// Each bubble's own forces and inertia from the step's start, `attraction` [N] added to them, and its
  /// motion alone. Also sets the bubbles' wetness and whether they adhere to a solid.
  void predict(const Surroundings& around, const Vectors3& attraction, double dt, BubbleStore& bubbles);
  /// How far from its centre each bubble can meet a wall within the step, as predicted [m].
  const std::vector<double>& reach() const { return reach_; }
  /// Adds what neighbours do to each other, solves, and leaves the new velocities in velocities().
  /// Throws NumericalFailure if the solve does not reach the tolerance.
  SolveReport couple(const BubbleStore& bubbles, const FoamTopology& topology, const Neighbours& neighbours,
                     const std::vector<NearWalls>& walls, double dt);
  /// Moves the bubbles with their new velocities.
  void advance(double dt, BubbleStore& bubbles) const;

  /// What drag has given bubble `i` over the step of the last couple(), by the balance of its momentum: the
  /// rest of it comes from weight, buoyancy, the surface, the air and the neighbours [N s].
  Eigen::Vector3d dragImpulse(std::size_t i, double dt) const;
  /// The larger of its slips at the step's ends [m/s].
  double slip(std::size_t i) const;

  const std::vector<double>& mass() const { return mass_; }  ///< inertia of each bubble [kg]
  const Vectors3& velocities() const { return velocity_; }
  /// The system of the last couple() for the change of the velocities, with the wall contacts it ended with.
  const BlockSystem& system() const { return system_; }
  const Vectors3& impulses() const { return impulse_; }
  double kineticEnergy() const;  ///< with the new velocities [J]

 private:
  /// What a pair adds to the impulses.
  struct alignas(32) PairImpulse {
    Eigen::Vector3d first;  ///< of the first bubble; the second has the opposite [kg m/s]
    double size;            ///< of what adds up to it [kg m/s]
  };

  void findPairs(const BubbleStore& bubbles, const FoamTopology& topology, double dt);
  void setPairs(const PairForces& forces, const FoamTopology& topology, std::size_t first, std::size_t count,
                double dt);
  void assembleRow(std::size_t i, const Vectors3& before, const Neighbours& neighbours);
  /// Solves, and again while wall contacts change; `before`: the old velocities, `stuck`: the bubbles whose
  /// change is not 0 at first.
  SolveReport solveWithContacts(const Vectors3& before, const std::vector<std::int32_t>& stuck, double dt);
  /// Residual not worth improving [kg m/s]: round-off, or kRestSpeed of every bubble.
  double smallestGoal() const;

  const FoamParams& params_;
  DragLawTable drag_;
  std::vector<LoneBubble> lone_;
  std::vector<double> mass_, immersed_, reach_;
  std::vector<LinearMotion> motion_;
  std::vector<PairedBubble> paired_;
  std::vector<CouplingBlock> pairBlock_;
  std::vector<PairImpulse> pairImpulse_;
  BlockSystem system_;
  Vectors3 impulse_, change_, velocity_;  ///< change_: against the old velocities
  std::vector<double> expected_;          ///< size of each bubble's change if it were alone [m/s]
  std::vector<double> impulseScale_;      ///< sum of the sizes of what adds up to each impulse [kg m/s]
  WallContacts contacts_;
  ImplicitSolve solver_;
};

}  // namespace spume::foam
