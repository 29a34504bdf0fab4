#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/fluid_params.h"
#include "fluid/grid_spec.h"
#include "fluid/inflow.h"
#include "fluid/liquid_bodies.h"
#include "fluid/solid_boundary.h"
#include "fluid/volume_ledger.h"

namespace spume::fluid {

struct ImmersedGas;

/// Holds every connected body at poured + initial - drained + the gas of its immersed bubbles by a source of
/// divergence [Kim et al. 2007]. Between two sub-steps bodies merge, split, appear and vanish; bodies that
/// exchange cells form a group, whose targets are summed and dealt out again so that every body of the group
/// has the same relative error. The sum of all targets changes by what is poured, drained and in flight only.
/// Per sub-step: bookOutflow (before phi is advected) -> withdraw, deposit -> update -> addSource.
class VolumeControl {
 public:
  /// With `solids`, which must outlive it, no volume changes its side of a thin wall.
  VolumeControl(const GridSpec& grid, const FluidParams& params, const SolidBoundary* solids = nullptr);

  /// Starts with every body of `bodies` at its target.
  void start(const LiquidBodies& bodies);
  /// Continues from a checkpoint: `bodies` found from the phi the ledger belongs to. Throws InvalidParameter
  /// if their numbers differ.
  void resume(const LiquidBodies& bodies, VolumeLedger ledger);

  /// Subtracts what `velocity` carries out of the domain through its open boundaries in dt; returns it [m^3].
  double bookOutflow(const DenseField<float>& phi, const SolidBoundary& boundary, const MacVelocity& velocity,
                     double dt);

  /// Subtracts liquid [m^3] taken out of a cell from the body that is or was last there or nearby; returns
  /// what that body could give.
  double bookDrained(const Eigen::Vector3i& cell, double volume);

  /// Takes `volume` [m^3] for a drop at x [m] from the target of the body nearby, the largest if there is
  /// none, as far as it reaches; returns what was taken.
  double withdraw(const Eigen::Vector3d& x, double volume);
  /// Gives the volume of a drop that landed at x [m] back.
  void deposit(const Eigen::Vector3d& x, double volume);

  /// Moves the targets from the bodies of the last call to `bodies`, adds what was poured, finds each
  /// bubble's body. `velocity` carried the liquid over the dt [s] between the two.
  void update(const LiquidBodies& bodies, const MacVelocity& velocity, double dt,
              const std::vector<PouredVolume>& poured, const ImmersedGas& gas);

  /// Adds to `divergenceSource` [1/s] the rate that removes each body's error with the relaxation time of the
  /// params and makes up for the loss learnt from earlier errors, a proportional-integral controller with
  /// critical damping [Kim et al. 2007]; learns from this one. Zero for a body at rest within
  /// kVolumeDeadband.
  void addSource(const LiquidBodies& bodies, const SolidBoundary& boundary, double dt,
                 DenseField<float>& divergenceSource);

  const VolumeLedger& ledger() const { return ledger_; }
  /// Volume the grid liquid should have now: the ledger's total and the immersed gas [m^3].
  double targetVolume() const;

 private:
  struct GroupSum {
    int bodies = 0;
    double target = 0, liquid = 0, volume = 0, room = 0;  // [m^3]; liquid = volume less gas
    double loss = 0;                                      // [m^3/s]
  };
  void traceBack(const LiquidBodies& bodies, const MacVelocity& velocity, double dt);
  void findGroups(const LiquidBodies& bodies);
  void bookGas(const LiquidBodies& bodies, const ImmersedGas& gas);
  void dealTargets(const LiquidBodies& bodies);
  double rateOf(const LiquidBody& body, std::size_t n, double dt);
  /// Subtracts up to `volume` [m^3] from the target of a body, of the unassigned liquid if it is negative;
  /// returns it.
  double take(std::int32_t body, double volume);
  std::int32_t lastBodyNear(const Eigen::Vector3d& x) const;
  std::int32_t group(std::int32_t node);
  void unite(std::int32_t a, std::int32_t b);

  GridSpec grid_;
  const SolidBoundary* solids_;
  double relaxationTime_;  // [s]
  VolumeLedger ledger_;
  DenseField<std::int32_t> lastLabel_;
  std::vector<LiquidBody> lastBodies_;
  std::int32_t lastLargest_ = -1;      // of them
  std::vector<double> gas_;            // immersed gas of each body [m^3]
  std::vector<std::int32_t> gasBody_;  // that of each bubble

  std::vector<std::vector<std::pair<std::int32_t, std::int32_t>>> links_;  // (new, old) per i-slab
  std::vector<std::int32_t> group_;  // union-find parents: new bodies, then old ones
  std::vector<char> linked_;
  std::vector<GroupSum> sums_;  // at the roots
};

}  // namespace spume::fluid
