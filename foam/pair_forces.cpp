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

/// What the laws ask of the two bubbles of each pair, column by column.
struct PairColumns {
  using Column = PairForces::Column;
  Column ri, rj;    ///< radii [m]
  Column mi, mj;    ///< inertia [kg]
  Column wetness;   ///< of the pair [-]
  Column distance;  ///< [m]
  Column filmArea;  ///< [m^2], 0 without a film
  Column hasFilm;   ///< 1 or 0

  PairColumns(const PairForces::Foam& foam, std::size_t first, std::size_t count, PairForces& forces) {
    const std::vector<double>& own = foam.bubbles.wetness;
    for (std::size_t k = 0; k < count; ++k) {
      const OverlapPair& pair = foam.topology.overlaps[first + k];
      const bool film = pair.film >= 0;
      const PairedBubble &i = foam.paired[pair.i], &j = foam.paired[pair.j];
      ri[k] = i.radius, rj[k] = j.radius, mi[k] = i.mass, mj[k] = j.mass;
      wetness[k] = 0.5 * (own[pair.i] + own[pair.j]);
      distance[k] = pair.distance;
      filmArea[k] = film ? foam.topology.films[pair.film].area : 0;
      hasFilm[k] = film;
      for (int axis = 0; axis < 3; ++axis) {
        forces.direction[axis][k] = j.position[axis] - i.position[axis];
        forces.approach[axis][k] = i.velocity[axis] - j.velocity[axis];
      }
    }
    for (std::size_t k = count; k < PairForces::kMost; ++k) fill(k, forces);
  }

  /// A pair that takes the place of none.
  void fill(std::size_t k, PairForces& forces) {
    ri[k] = rj[k] = mi[k] = mj[k] = wetness[k] = distance[k] = 1, filmArea[k] = hasFilm[k] = 0;
    for (int axis = 0; axis < 3; ++axis) forces.direction[axis][k] = forces.approach[axis][k] = 0;
  }
};

/// Gives pairs whose centres coincide a direction.
void partCoincident(const PairForces::Foam& foam, const PairColumns& of, std::size_t first, std::size_t count,
                    PairForces& forces) {
  for (std::size_t k = 0; k < count; ++k) {
    if (of.distance[k] > kCoincident * std::max(of.ri[k], of.rj[k])) continue;
    const OverlapPair& pair = foam.topology.overlaps[first + k];
    const std::vector<std::uint64_t>& id = foam.bubbles.id;
    const Eigen::Vector3d drawn = drawnDirection(foam.params.seed, id[pair.i], id[pair.j]);
    for (int axis = 0; axis < 3; ++axis) forces.direction[axis][k] = drawn[axis];
  }
}

/// The response of bubbles that hold their volumes.
void stiffenSqueezed(const PairForces::Foam& foam, const PairColumns& of, std::size_t first,
                     std::size_t count, PairForces& forces) {
  const FoamTopology& topology = foam.topology;
  for (std::size_t k = 0; k < count; ++k) {
    const OverlapPair& pair = topology.overlaps[first + k];
    if (pair.film < 0) continue;
    const SqueezedBubble i = {of.ri[k], topology.filmArea[pair.i], topology.freeArea[pair.i]};
    const SqueezedBubble j = {of.rj[k], topology.filmArea[pair.j], topology.freeArea[pair.j]};
    forces.along[k] *= 1 + volumeResponse(i, j, of.wetness[k]);
  }
}

}  // namespace

void PairForces::find(const Foam& foam, std::size_t first, std::size_t count) {
  const PairColumns of(foam, first, count, *this);
  const SpringLaw spring = foam.spring;
  const double zeta = foam.params.contactDamping;
  for (std::size_t k = 0; k < kMost; ++k) {
    const double stiffness = spring(of.ri[k], of.rj[k]);
    const PairSpring pull =
        strongSpring(stiffness, of.ri[k], of.rj[k], of.wetness[k], of.distance[k], of.filmArea[k]);
    tension[k] = pull.tension, along[k] = pull.along, across[k] = pull.across;
    damping[k] = of.hasFilm[k] * contactDamping(zeta, stiffness, of.mi[k], of.mj[k]);
    const double inverse = 1 / of.distance[k];
    for (Column& column : direction) column[k] *= inverse;
  }
  partCoincident(foam, of, first, count, *this);
  if (holdsVolumes(foam.params)) stiffenSqueezed(foam, of, first, count, *this);
}

}  // namespace spume::foam
