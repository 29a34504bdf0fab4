// The forces of pairs found side by side, against the laws of one pair.
#include <gtest/gtest.h>

#include "foam/counter_random.h"
#include "foam/forces/contact_damping.h"
#include "foam/pair_forces.h"
#include "foam/presets.h"

namespace spume::foam {
namespace {

constexpr int kPairs = 70;  ///< more than one group takes
constexpr double kRoundOff = 1e-14;

/// Bubbles in a row, each overlapping the next; every third pair has no film.
struct Row {
  FoamParams params = makePreset(Preset::physical);
  BubbleStore bubbles;
  FoamTopology topology;
  std::vector<PairedBubble> paired;

  Row() {
    double end = 0;
    for (int b = 0; b <= kPairs; ++b) {
      CounterRandom random(5, static_cast<std::uint64_t>(b), 0);
      const double radius = 1e-3 * (0.5 + random.uniform());
      end += 1.2 * radius;
      bubbles.add({.position = {end, 0.2 * radius, 0}, .radius = radius, .wetness = random.uniform()});
      const Eigen::Vector3d x = bubbles.position.back();
      paired.push_back({{x.x(), x.y(), x.z()}, {random.uniform(), -1, 0.5}, radius, 1e-6 * (1 + b % 4)});
    }
    for (int p = 0; p < kPairs; ++p) {
      const double distance = (bubbles.position[p + 1] - bubbles.position[p]).norm();
      const int film = p % 3 == 0 ? -1 : static_cast<int>(topology.films.size());
      topology.overlaps.push_back({p, p + 1, distance, film});
      if (film >= 0) topology.films.push_back({p, p + 1, distance, 0.5 * distance, 1e-8 * p});
    }
  }
  PairForces forces(std::size_t first, std::size_t count) const {
    PairForces found;
    found.find({params, SpringLaw(params), bubbles, topology, paired}, first, count);
    return found;
  }
};

TEST(PairForces, AreThoseOfTheLawsOfOnePair) {
  const Row row;
  const PairForces found = row.forces(3, PairForces::kMost);
  for (std::size_t k = 0; k < PairForces::kMost; ++k) {
    const OverlapPair& pair = row.topology.overlaps[3 + k];
    const PairedBubble &i = row.paired[pair.i], &j = row.paired[pair.j];
    const bool film = pair.film >= 0;
    const double stiffness = springStiffness(row.params, i.radius, j.radius);
    const double wetness = 0.5 * (row.bubbles.wetness[pair.i] + row.bubbles.wetness[pair.j]);
    const PairSpring spring = strongSpring(stiffness, i.radius, j.radius, wetness, pair.distance,
                                           film ? row.topology.films[pair.film].area : 0);
    const double damping = film ? contactDamping(row.params.contactDamping, stiffness, i.mass, j.mass) : 0.0;
    EXPECT_NEAR(found.tension[k], spring.tension, kRoundOff * stiffness * pair.distance);
    EXPECT_NEAR(found.along[k], spring.along, kRoundOff * stiffness);
    EXPECT_NEAR(found.across[k], spring.across, kRoundOff * stiffness);
    EXPECT_NEAR(found.damping[k], damping, kRoundOff * damping);
    const Eigen::Vector3d apart = row.bubbles.position[pair.j] - row.bubbles.position[pair.i];
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(found.direction[axis][k], apart[axis] / pair.distance, kRoundOff);
      EXPECT_EQ(found.approach[axis][k], i.velocity[axis] - j.velocity[axis]);
    }
  }
}

TEST(PairForces, DoNotDependOnWhichPairsAreFoundTogether) {
  const Row row;
  const PairForces together = row.forces(0, PairForces::kMost);
  for (std::size_t k = 0; k < PairForces::kMost; ++k) {
    const PairForces alone = row.forces(k, 1);
    EXPECT_EQ(alone.tension[0], together.tension[k]);
    EXPECT_EQ(alone.along[0], together.along[k]);
    EXPECT_EQ(alone.across[0], together.across[k]);
    EXPECT_EQ(alone.damping[0], together.damping[k]);
    EXPECT_EQ(alone.direction[0][0], together.direction[0][k]);
  }
}

TEST(PairForces, PartCoincidentCentresInAUnitDirection) {
  Row row;
  row.bubbles.position[1] = row.bubbles.position[0];
  row.paired[1].position = row.paired[0].position;
  row.topology.overlaps[0].distance = 0;
  const PairForces found = row.forces(0, 2);
  const Eigen::Vector3d drawn(found.direction[0][0], found.direction[1][0], found.direction[2][0]);
  EXPECT_NEAR(drawn.norm(), 1, kRoundOff);
  EXPECT_LT(found.tension[0], 0);
}

}  // namespace
}  // namespace spume::foam
