#pragma once

#include <memory>
#include <string>
#include <vector>

#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/foam_topology.h"
#include "foam/liquid_sampler.h"

namespace spume::foam {

/// What the liquid's drag gave a bubble in a step; the liquid is owed the opposite.
struct DragImpulse {
  Eigen::Vector3d position;  ///< of the bubble, at the step's end [m]
  Eigen::Vector3d impulse;   ///< [N s]
  double slip;               ///< the larger of those at the step's ends [m/s]
};

enum class FoamEventKind { burst, merge, classChange };

/// Something that happened to a bubble during a step.
struct FoamEvent {
  FoamEventKind kind;
  std::uint64_t id;
  std::uint64_t other = 0;   ///< merge: the bubble that took the gas
  Eigen::Vector3d position;  ///< [m]
  double radius;             ///< [m]
  double gas;                ///< [m^3]
  double age;                ///< [s]
  BubbleClass from, to;      ///< classChange: before and after; otherwise both the class
  bool unsupported = false;  ///< burst, merge: its cluster had lost all support
};

struct FoamStageTime {
  std::string stage;
  double seconds;
};

/// What a step did.
struct FoamStepReport {
  std::size_t bubbles = 0, liquid = 0, surface = 0, air = 0;
  std::size_t contacts = 0, overlaps = 0, hidden = 0, clamped = 0;
  std::size_t pushedOut = 0;  ///< bubbles taken out of solids at the end, see wall_limit.h
  int solverIterations = 0;
  double solverResidual = 0;
  bool solverFellBack = false;                       ///< the iteration stalled, the direct solver finished it
  double maxSpeed = 0;                               ///< [m/s]
  double gas = 0;                                    ///< in bubbles at the end [m^3]
  double gasBurst = 0;                               ///< released in this step [m^3]
  double volumeErrorMedian = 0, volumeErrorMax = 0;  ///< |V - V0| / V0 over unflagged bubbles
  double kineticEnergy = 0;                          ///< [J]
  std::vector<FoamEvent> events;
  std::vector<FoamStageTime> stages;
};

/// Moves the bubbles of a foam through a liquid it can only sample. Holds scratch memory between steps, no
/// state: everything a step depends on is in the BubbleStore.
class FoamSolver {
 public:
  /// Throws InvalidParameter.
  explicit FoamSolver(FoamParams params);
  ~FoamSolver();

  /// Advances all bubbles by dt [s]. Throws NumericalFailure, and then the store is as it was before the
  /// call.
  FoamStepReport step(BubbleStore& bubbles, const LiquidSampler& liquid, double dt);

  /// What drag did in the last step, in the order of the foam's rows; bubbles without drag left out.
  const std::vector<DragImpulse>& dragImpulses() const;

  /// Largest dt [s] for which 95 of 100 pairs of neighbours move relative to each other by no more than half
  /// the smaller radius. The few others are bubbles that rise into a pile, and what they run into stops them.
  double stableDt(const BubbleStore& bubbles) const;

  /// Geometry as last measured in the last step; row k is the bubble topologyIds()[k]. With volume_mode newton
  /// that is the foam as the step leaves it, else as it found it.
  const FoamTopology& topology() const;
  const std::vector<std::uint64_t>& topologyIds() const;
  const FoamParams& params() const;

 private:
  struct Internals;
  std::unique_ptr<Internals> internals_;
};

}  // namespace spume::foam
