#include <gtest/gtest.h>

#include "fluid/air_pockets.h"
#include "fluid/level_set.h"
#include "fluid/liquid_bodies.h"
#include "tests/fluid_scenery.h"

namespace spume::fluid {
namespace {

using namespace testing;

/// Liquid up to the middle of the box, with single cells of air dug out of it.
DenseField<float> poolWithHoles(const GridSpec& grid, const std::vector<Eigen::Vector3i>& holes) {
  auto phi = sampleCells(grid, [](const Eigen::Vector3d& x) { return x.y() - 0.08; });
  for (const Eigen::Vector3i& c : holes) phi(c) = static_cast<float>(0.2 * grid.dx);
  return phi;
}

TEST(AirPockets, FillsUpToFourCellsAndKeepsTheRest) {
  const GridSpec grid = boxGrid(16);
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  DenseField<float> phi = poolWithHoles(grid, {{3, 2, 3},  // one cell
                                               {6, 2, 6},
                                               {6, 2, 7},
                                               {7, 2, 7},  // three, an L
                                               {9, 3, 3},
                                               {10, 3, 3},
                                               {11, 3, 3},
                                               {12, 3, 3},
                                               {13, 3, 3}});  // five
  AirPockets pockets;
  MacVelocity velocity(grid.cells);
  velocity[0].fill(0.5f);
  pockets.find(grid, phi, boundary);
  const double before = liquidVolume(grid, phi, boundary);
  const auto filled = pockets.fillSmall(grid, boundary, velocity, phi);
  ASSERT_EQ(filled.size(), 2u);
  EXPECT_EQ(filled[0].pocket.cells.size(), 1u);
  EXPECT_EQ(filled[1].pocket.cells.size(), 3u);
  EXPECT_TRUE(filled[1].pocket.centroid.isApprox(
      (grid.cellCentre(6, 2, 6) + grid.cellCentre(6, 2, 7) + grid.cellCentre(7, 2, 7)) / 3));
  EXPECT_TRUE(filled[1].velocity.isApprox(Eigen::Vector3d(0.5, 0, 0)));
  for (const FilledPocket& pocket : filled) {
    for (const Eigen::Vector3i& c : pocket.pocket.cells) EXPECT_LT(phi(c), 0);
  }
  EXPECT_NEAR(filled[0].pocket.gas + filled[1].pocket.gas, liquidVolume(grid, phi, boundary) - before, 1e-12);
  EXPECT_GT(phi(11, 3, 3), 0);
  pockets.find(grid, phi, boundary);
  ASSERT_EQ(pockets.pockets().size(), 1u);
  EXPECT_EQ(pockets.pockets()[0].cells.size(), 5u);
  EXPECT_EQ(pockets.label()(11, 3, 3), 0);
  EXPECT_EQ(pockets.label()(3, 12, 3), -1);
}

/// Two cubes of air side by side, the film between them `film` cells thick and in the middle of a cell.
DenseField<float> twoPockets(const GridSpec& grid, double film) {
  const Eigen::Vector3d middle = grid.cellCentre(16, 10, 16), half = Eigen::Vector3d::Constant(3.2 * grid.dx);
  const Eigen::Vector3d apart = Eigen::Vector3d::UnitX() * (half.x() + 0.5 * film * grid.dx);
  return sampleCells(grid, [&](const Eigen::Vector3d& x) {
    const auto depthIn = [&](const Eigen::Vector3d& centre) {
      return (half - (x - centre).cwiseAbs()).minCoeff();
    };
    return std::max({x.y() - 0.14, depthIn(middle - apart), depthIn(middle + apart)});
  });
}

TEST(AirPockets, AFilmThinnerThanACellPartsNoPockets) {
  const GridSpec grid = boxGrid(32);
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  AirPockets thin, thick;
  thin.find(grid, twoPockets(grid, 0.9), boundary);
  thick.find(grid, twoPockets(grid, 1.1), boundary);
  ASSERT_EQ(thin.pockets().size(), 1u);
  ASSERT_EQ(thick.pockets().size(), 2u);
  EXPECT_EQ(thin.label()(13, 10, 16), thin.label()(19, 10, 16));
  EXPECT_NE(thick.label()(13, 10, 16), thick.label()(19, 10, 16));
  EXPECT_EQ(thin.pockets()[0].cells.size(),
            thick.pockets()[0].cells.size() + thick.pockets()[1].cells.size());
}

TEST(AirPockets, APocketUnderAFilmThinnerThanACellIsOpen) {
  const GridSpec grid = boxGrid(32);
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  const auto pocketUnder = [&](double film) {
    const double top = grid.cellCentre(0, 20, 0).y() + 0.5 * film * grid.dx;
    const auto phi = sampleCells(grid, [&](const Eigen::Vector3d& x) {
      const Eigen::Vector3d from = (x - Eigen::Vector3d(0.08, top - (film + 3.2) * grid.dx, 0.08)).cwiseAbs();
      return std::max(x.y() - top, 3.2 * grid.dx - from.maxCoeff());
    });
    AirPockets pockets;
    pockets.find(grid, phi, boundary);
    return pockets.pockets().size();
  };
  EXPECT_EQ(pocketUnder(0.9), 0u);
  EXPECT_EQ(pocketUnder(1.1), 1u);
}

TEST(AirPockets, TheHeadspaceOfASealedBoxIsOpenAirThatStays) {
  const GridSpec grid = boxGrid(8);
  const SolidBoundary boundary = buildSolidBoundary(grid, sealed(), {}, 0);
  DenseField<float> phi(grid.cells, static_cast<float>(-grid.dx));
  phi(4, 7, 4) = phi(4, 7, 5) = static_cast<float>(0.5 * grid.dx);
  AirPockets pockets;
  pockets.find(grid, phi, boundary);
  EXPECT_TRUE(pockets.fillSmall(grid, boundary, MacVelocity(grid.cells), phi).empty());
  EXPECT_TRUE(pockets.pockets().empty());
}

/// A ball of air in liquid, its centre anywhere in a cell: its gas counts the cut cells on both sides.
TEST(AirPockets, MeasuresTheGasOfABallWhateverItsPlace) {
  const GridSpec grid = boxGrid(32);
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  const double radius = 0.02, ball = 4.18879020 * radius * radius * radius;
  for (const double shift : {0.0, 0.0013, 0.0024, 0.0037}) {
    const auto phi = sampleCells(grid, [&](const Eigen::Vector3d& x) {
      return std::max(x.y() - 0.12, radius - (x - Eigen::Vector3d(0.08 + shift, 0.06, 0.08 - shift)).norm());
    });
    AirPockets pockets;
    pockets.find(grid, phi, boundary);
    ASSERT_EQ(pockets.pockets().size(), 1u);
    EXPECT_NEAR(pockets.pockets()[0].gas / ball, 1, 0.5 / 16);  // planes in cells: (dx/R)^2/2 at R = 4 dx
  }
}

TEST(LiquidBodies, DropsAndPoolAreSeparateWithTheirVolumes) {
  const GridSpec grid = boxGrid(32);
  const SolidBoundary boundary = buildSolidBoundary(grid, DomainWalls{}, {}, 0);
  const double radius = 0.02;
  const auto phi = sampleCells(grid, [&](const Eigen::Vector3d& x) {
    return std::min(x.y() - 0.0517, (x - Eigen::Vector3d(0.08, 0.11, 0.08)).norm() - radius);
  });
  LiquidBodies liquid;
  liquid.find(grid, phi, boundary);
  ASSERT_EQ(liquid.bodies.size(), 2u);
  EXPECT_NEAR(liquid.bodies[0].volume, 0.16 * 0.16 * 0.0517, 1e-7 * 0.16 * 0.16);  // phi is rounded to float
  const double sphere = 4.18879020 * radius * radius * radius;
  EXPECT_NEAR(liquid.bodies[1].volume / sphere, 1, 0.5 / 16);  // planes in cells: (dx/R)^2/2 at R = 4 dx
  EXPECT_NEAR(liquid.volume, liquid.bodies[0].volume + liquid.bodies[1].volume, 1e-12);
  EXPECT_NEAR(liquid.volume, liquidVolume(grid, phi, boundary), 1e-15);
  EXPECT_TRUE(liquid.bodies[0].touchesAir && liquid.bodies[1].touchesAir);
}

}  // namespace
}  // namespace spume::fluid
