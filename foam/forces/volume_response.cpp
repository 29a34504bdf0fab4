#include "foam/forces/volume_response.h"

#include <algorithm>

#include "foam/forces/strong_spring.h"

namespace spume::foam {
namespace {

/// Neighbours that swell in turn push back. Found by trial on froths between plates and rafts, dt 5 to 20 ms:
/// at 1 they shake, at 3 one of 40 bubbles kept bobbing at 20 ms, at 6 all came to rest.
constexpr double kJointResponse = 6;
/// Largest response. A matter of how fast enclosed bubbles settle: 20 to 200 all hold.
constexpr double kLargest = 100;

/// Change of the rest length when every film of bubble i moves in by 1: d l / d r_i times d r_i.
double swelling(const SqueezedBubble& i, const SqueezedBubble& j, double wetness, double rest) {
  const double byRadius = (i.radius + (3 * wetness - 1) / 2 * j.radius) / rest;
  // Each film moves by half of what the distance changes; the volume lost there is gained at the free
  // surface.
  return i.freeArea > 0 ? std::max(0.0, byRadius) * i.filmArea / (2 * i.freeArea) : kLargest;
}

}  // namespace

double volumeResponse(const SqueezedBubble& i, const SqueezedBubble& j, double wetness) {
  const double rest = restLength(i.radius, j.radius, wetness);
  return std::min(kLargest, kJointResponse * (swelling(i, j, wetness, rest) + swelling(j, i, wetness, rest)));
}

}  // namespace spume::foam
