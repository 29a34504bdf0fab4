#pragma once

#include "foam/foam_params.h"

namespace spume::foam {

/// Length over which a liquid surface levels out, sqrt(sigma / (rho g)) [m]; infinite without gravity.
double capillaryLength(const FoamParams& params);

/// Beyond this many capillary lengths neither attraction is felt.
inline constexpr double kAttractionRange = 5;

/// Vertical pull of a floating bubble on the surface [N], min(buoyancy, 0.4 pi sigma r): the weight that
/// dents it.
double surfaceLoad(const FoamParams& params, double gas, double radius);

/// Modified Bessel function K1 of x > 0, within 2e-7 of itself [Abramowitz and Stegun
/// 1964, 9.8.3, 9.8.7, 9.8.8].
double besselK1(double x);

/// Pull of two surface bubbles on each other at distance d [m] [N], before their surface weights: 0 beyond
/// the range. capillary: f_i f_j K1(d / L_c) / (2 pi sigma L_c) [Vella and Mahadevan 2005]; coefficient:
/// alpha sqrt(r_i r_j) / d. Deviation: [Busaryev 2012, Eq. 6] gives i and j different forces; these are
/// symmetric. Its alpha serves bubbles of one size alone: here it shrinks with r^3 below 1 mm, as buoyancy
/// does.
double weakAttraction(const FoamParams& params, double gasI, double radiusI, double gasJ, double radiusJ,
                      double distance);

}  // namespace spume::foam
