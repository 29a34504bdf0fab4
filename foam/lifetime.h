#pragma once

#include <cstdint>
#include <vector>

#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/foam_topology.h"

namespace spume::foam {

/// Integral of the bursting hazard over a life of `time` in the open [-]: ln 2 (r/r_ref) (time/median)^shape.
/// Shape 2 is [Busaryev 2012, Eq. 11] as a hazard burstRate r e per second; 4/3 fits thin films [Lhuissier
/// and Villermaux 2012]. Deviation: Eq. 11 is a chance per step, with which lives would scale with sqrt(dt).
double burstExposure(const FoamParams& params, double gas, double time);

/// The inverse: time in the open [s] after which the integral is `exposure`.
double timeOfExposure(const FoamParams& params, double gas, double exposure);

/// E ~ Exp(1), the exposure at which bubble `id` bursts: drawn from (seed, id) alone.
double burstThreshold(std::uint64_t seed, std::uint64_t id);

/// A bubble whose time has come within the step.
struct EndedLife {
  std::size_t index;
  double age;                ///< since birth, at the moment itself, not at the end of the step [s]
  std::ptrdiff_t heir = -1;  ///< index of the bubble that takes its gas, or -1: it bursts into the open
};

/// Share of its normal speed at which the clock of a bubble runs whose centre is `psi` [m] from a solid: from
/// burstWallFactor where it touches to 1 at burstWallDistance.
double burstClockSpeed(const FoamParams& params, double psi, double radius);

/// Advances the clocks by dt [s] (`age` always; `exposure` only while surface or air, slower near solids if
/// asked) and returns the lives that end, ordered by id. `psi` = distances to the solids [m]. One with
/// free area bursts; one enclosed by others leaves its gas to the neighbour with the largest film (ties: the
/// lower id), unless that one ends in this step too: then it waits for the next step. `supported` from
/// supportedBubbles(): air clusters without support end within kUnsupportedLife.
std::vector<EndedLife> endLives(const FoamParams& params, const FoamTopology& topology,
                                const std::vector<std::uint8_t>& supported, const Eigen::VectorXd& psi,
                                double dt, BubbleStore& bubbles);

/// Longest life of an air cluster that touches neither surface nor wall [s] (model, "Bursting").
inline constexpr double kUnsupportedLife = 0.1;

/// 1 for every bubble joined by a chain of contacts to one that is not in the air or has psi <= r.
std::vector<std::uint8_t> supportedBubbles(const FoamTopology& topology, const Eigen::VectorXd& psi,
                                           const BubbleStore& bubbles);

/// Gives gas, momentum and place of `from` to `to` [model, "coalesces"]: gas summed, position weighted by
/// gas, velocity by `mass` [kg], radius grown with the gas. `from` keeps its row; the caller removes it.
void coalesce(std::size_t from, std::size_t to, const std::vector<double>& mass, BubbleStore& bubbles);

}  // namespace spume::foam
