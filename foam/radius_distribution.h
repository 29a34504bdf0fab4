#pragma once

#include "foam/counter_random.h"

namespace spume::foam {

enum class RadiusLaw { uniform, lognormal, powerLaw };

/// How large new bubbles are: a density of the radius, cut to least .. most.
struct RadiusDistribution {
  RadiusLaw law = RadiusLaw::lognormal;
  double median = 0.75e-3;  ///< lognormal: of r before the cut [m]
  double sigma = 0.3;       ///< lognormal: standard deviation of ln r [-]; 0: all alike
  double exponent = -3;     ///< powerLaw: density ~ r^exponent [-]
  double least = 0.375e-3;  ///< [m], > 0
  double most = 1.25e-3;    ///< [m], >= least

  /// The next radius [m] of a stream of random numbers. Uniform and power law by their inverse distributions,
  /// lognormal redrawn until it is inside the cut.
  double draw(CounterRandom& random) const;
};

/// Standard normal by Box and Muller, two numbers of the stream.
double drawNormal(CounterRandom& random);

}  // namespace spume::foam
