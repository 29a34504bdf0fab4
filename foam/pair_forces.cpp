#include "foam/pair_forces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foam/counter_random.h"
#include "foam/forces/contact_damping.h"
#include "foam/forces/strong_spring.h"
#include "foam/forces/volume_response.h"
#include "foam/volume_correction.h"

namespace spume::foam {
namespace {

/// Distance, as a share of the larger radius, below which two centres give no direction worth following.
constexpr double kCoincident = 1e-9;

Eigen::Vector3d drawnDirection(std::uint64_t seed, std::uint64_t idI, std::uint64_t idJ) {
  CounterRandom random(seed, idI, idJ ^ 0x70617274ull);  // purpose: parting of coincident bubbles
  const double y = 2 * random.uniform() - 1, angle = 2 * std::numbers::pi * random.uniform();
  const double across = std::sqrt(1 - y * y);
  return {across * std::cos(angle), y, across * std::sin(angle)};
}

Eigen::Vector3d pairDirection(const FoamParams& params, const BubbleStore& bubbles, const OverlapPair& pair) {
  const double larger = std::max(bubbles.radius[pair.i], bubbles.radius[pair.j]);
  if (pair.distance <= kCoincident * larger)
    return drawnDirection(params.seed, bubbles.id[pair.i], bubbles.id[pair.j]);
  return (bubbles.position[pair.j] - bubbles.position[pair.i]) / pair.distance;
}

}  // namespace

PairForce pairForce(const FoamParams& params, const BubbleStore& bubbles, const FoamTopology& topology,
                    const std::vector<double>& mass, const OverlapPair& pair) {
  const double ri = bubbles.radius[pair.i], rj = bubbles.radius[pair.j];
  const double stiffness = springStiffness(params, ri, rj);
  const double wetness = 0.5 * (bubbles.wetness[pair.i] + bubbles.wetness[pair.j]);
  const double filmArea = pair.film >= 0 ? topology.films[pair.film].area : 0;
  const PairSpring spring = strongSpring(stiffness, ri, rj, wetness, pair.distance, filmArea);
  PairForce force;
  force.direction = pairDirection(params, bubbles, pair);
  force.tension = spring.tension, force.along = spring.along, force.across = spring.across;
  if (pair.film >= 0 && holdsVolumes(params)) {
    const auto squeezed = [&](std::int32_t b) {
      return SqueezedBubble{bubbles.radius[b], topology.filmArea[b], topology.freeArea[b]};
    };
    force.along *= 1 + volumeResponse(squeezed(pair.i), squeezed(pair.j), wetness);
  }
  if (pair.film >= 0)
    force.damping = contactDamping(params.contactDamping, stiffness, mass[pair.i], mass[pair.j]);
  return force;
}

}  // namespace spume::foam
