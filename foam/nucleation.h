#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "foam/bubble_store.h"
#include "foam/liquid_sampler.h"
#include "foam/radius_distribution.h"

namespace spume::foam {

/// Places on solids where bubbles come out of solution.
struct NucleationParams {
  static constexpr int kAnySolid = -2;
  int solid = kAnySolid;  ///< index of the solid, -1: walls of the domain, kAnySolid: all of them
  double density = 1e4;   ///< of the sites [1/m^2], >= 0
  double waiting =
      0.5;  ///< mean time from a bubble's leaving to the next one [s], > 0; exponentially distributed
  RadiusDistribution radius;     ///< of a bubble when it appears
  double start = 0, stop = 1e9;  ///< active between [s]
};

/// A scratch or a fibre that breeds one bubble after the other.
struct NucleationSite {
  static constexpr std::uint64_t kFree = std::numeric_limits<std::uint64_t>::max();
  Eigen::Vector3d position;      ///< on the solid [m]
  Eigen::Vector3d away;          ///< unit vector away from it
  std::uint64_t bubble = kFree;  ///< id of the bubble that sits on it
  double ready = 0;              ///< time from which the next one may appear [s]
  std::uint64_t births = 0;      ///< bubbles so far; numbers the next one
  int params = 0;                ///< index of its parameters
};

/// A bubble that appears at a site.
struct Nucleated {
  NewBubble bubble;
  std::size_t site;
};

/// The sites of one set of parameters in the box from `lower` to `upper`: points of a Poisson process in a
/// thin layer in front of the solids, moved onto them, so that they lie at `density` on flat and curved walls
/// alike. They follow from the arguments alone. O(density x volume of the box / layer).
std::vector<NucleationSite> findNucleationSites(const NucleationParams& params, int index,
                                                const LiquidSampler& liquid, const Eigen::Vector3d& lower,
                                                const Eigen::Vector3d& upper, std::uint64_t seed);

/// Bubbles that appear by time `now` [s], by site: where a site is under the liquid, its last bubble is gone
/// (further from it than its own diameter, or no more) and its waiting time is over. They touch the solid;
/// whether they stick, and how large they get before they leave, is up to adhesion and growth. Waiting times
/// and radii are drawn from (seed, site, number of the birth). The caller notes the ids of the new bubbles in
/// the sites.
std::vector<Nucleated> nucleate(const std::vector<NucleationParams>& params, const LiquidSampler& liquid,
                                const BubbleStore& bubbles, double now, std::uint64_t seed,
                                std::vector<NucleationSite>& sites);

}  // namespace spume::foam
