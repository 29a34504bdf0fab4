#include <gtest/gtest.h>

#include "foam/power_cells.h"
#include "foam/topology_part.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {
namespace {

/// A foam of several pieces, and a part of it that is measured with other radii: the rows around one corner,
/// and around them those that only cut.
struct Changed {
  static constexpr double kSide = 0.7;  ///< of the foam's

  Balls balls = randomFoam(3000, .5, 2, 1, 51), part;
  std::vector<std::int32_t> rows;
  std::vector<std::uint8_t> whole;
  FoamTopology before, after;

  Changed() {
    before = powerCellsOf(balls);
    double side = 0, widest = 0;
    for (std::size_t i = 0; i < balls.size(); ++i)
      side = std::max(side, balls.position[i].maxCoeff()), widest = std::max(widest, balls.radius[i]);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const double far = balls.position[i].maxCoeff();
      if (far < kSide * side - 5 * widest) balls.radius[i] *= 0.97;
      if (far >= kSide * side) continue;
      rows.push_back(static_cast<std::int32_t>(i));
      whole.push_back(far < kSide * side - 2 * widest);
      part.add(balls.position[i], balls.radius[i]), part.id.back() = balls.id[i];
    }
    after = powerCellsOf(balls);
  }
};

void expectSame(const FoamTopology& a, const FoamTopology& b) {
  constexpr double kRoundOff = 1e-12;  // of a sum over a dozen films, in another order
  ASSERT_EQ(a.overlaps.size(), b.overlaps.size());
  ASSERT_EQ(a.films.size(), b.films.size());
  EXPECT_EQ(a.hidden, b.hidden);
  for (std::size_t p = 0; p < a.overlaps.size(); ++p) {
    EXPECT_EQ(std::tie(a.overlaps[p].i, a.overlaps[p].j, a.overlaps[p].film),
              std::tie(b.overlaps[p].i, b.overlaps[p].j, b.overlaps[p].film));
    if (const std::int32_t f = a.overlaps[p].film; f >= 0) {
      EXPECT_EQ(std::tie(a.films[f].i, a.films[f].j), std::tie(a.overlaps[p].i, a.overlaps[p].j));
      EXPECT_NEAR(a.films[f].area, b.films[f].area, kRoundOff * std::pow(a.films[f].distance, 2));
    }
  }
  for (std::size_t i = 0; i < a.volume.size(); ++i)
    EXPECT_NEAR(a.volume[i], b.volume[i], kRoundOff * std::max(b.volume[i], 1e-3));
}

TEST(PartReplacer, APartPutBackIsTheWholeMeasuredAnew) {
  const Changed foam;
  ASSERT_GT(std::count(foam.whole.begin(), foam.whole.end(), 1), 50);
  EXPECT_NE(foam.before.overlaps.size(), foam.after.overlaps.size());
  const FoamTopology part = powerCellsOf(foam.part);
  FoamTopology all = foam.before;
  PartReplacer replacer;
  replacer.putBack(part, foam.rows, foam.whole, all);
  expectSame(all, foam.after);
  replacer.putBack(part, foam.rows, foam.whole, all);  // again, in the memory of the first time
  expectSame(all, foam.after);
}

TEST(PowerCells, ListsTheNeighboursThatItsPairsMake) {
  constexpr std::size_t kCutters = 700;
  const Balls balls = randomFoam(3000, .5, 4, 1, 53);
  PowerCells cells;
  FoamTopology topology;
  Neighbours listed, built;
  for (const std::size_t cutters : {std::size_t{0}, kCutters}) {
    cells.compute(balls.position, balls.radius, balls.id, topology, cutters);
    cells.listNeighbours(listed);
    built.build(balls.size() - cutters, topology.overlaps);
    EXPECT_EQ(listed.start, built.start);
    EXPECT_EQ(listed.other, built.other);
    EXPECT_EQ(listed.pair, built.pair);
  }
}

}  // namespace
}  // namespace spume::foam::test
