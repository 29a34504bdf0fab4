#include <gtest/gtest.h>

#include "fluid/extrapolation.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace test;

TEST(VelocityExtrapolator, ContinuesAConstantFieldExactly) {
  const GridSpec grid = unitCube(24);
  const SolidBoundary solids = buildSolidBoundary(grid, openWalls(), {}, 0);
  const DenseField<float> phi =
      levelSet(grid, [](const auto& x) { return (x - Eigen::Vector3d::Constant(0.5)).norm() - 0.2; });
  MacVelocity u = macField(grid, [&](const Eigen::Vector3d& x) {
    const bool wet = (x - Eigen::Vector3d::Constant(0.5)).norm() < 0.2 + grid.dx;
    return wet ? Eigen::Vector3d(1, 2, 3) : Eigen::Vector3d::Constant(1e6);
  });
  VelocityExtrapolator(grid).apply(phi, solids, 6, u);
  int reached = 0;
  forEachInner(grid.cells, 0, [&](int i, int j, int k) {
    if (phi(i, j, k) > 3 * grid.dx) return;  // 6 steps along the axes reach 3.4 cells along a diagonal
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(u[a](i, j, k), a + 1, 1e-5) << i << ' ' << j << ' ' << k;
    ++reached;
  });
  EXPECT_GT(reached, 1000);
  EXPECT_EQ(u[0](0, 0, 0), 0);  // out of reach
}

TEST(VelocityExtrapolator, IsConstantAlongTheNormalOfAFlatSurface) {
  const GridSpec grid = unitCube(24);
  const SolidBoundary solids = buildSolidBoundary(grid, openWalls(), {}, 0);
  const DenseField<float> phi = levelSet(grid, [](const auto& x) { return x.y() - 0.51; });
  MacVelocity u = macField(grid, [&](const Eigen::Vector3d& x) {
    return x.y() < 0.51 + grid.dx ? Eigen::Vector3d(x.z(), x.x(), x.x() + x.z()) : Eigen::Vector3d::Zero();
  });
  VelocityExtrapolator(grid).apply(phi, solids, 5, u);
  for (int j = 13; j < 17; ++j) {
    const Eigen::Vector3d x = grid.cellCentre(9, j, 14);
    // The small sideways weight acts on neighbours of the same layer: none is known, so nothing leaks in.
    EXPECT_NEAR(u[0](9, j, 14), x.z(), 1e-5);
    EXPECT_NEAR(u[2](9, j, 14), grid.faceCentre(2, 9, j, 14).z() + x.x(), 1e-5);
  }
}

void continued(const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& solids,
               MacVelocity& u) {
  VelocityExtrapolator extrapolator(grid);
  extrapolator.apply(phi, solids, 5, u);
  extrapolator.goOn(phi, solids, u);
}

/// Flow towards a wall below the surface: u = (-x, y, 0) has no divergence and grows towards the surface.
Eigen::Vector3d spreading(const Eigen::Vector3d& x) { return {-x.x(), x.y(), 0}; }

TEST(VelocityExtrapolator, GoesOnWithoutDivergenceInTheFirstCellOfAir) {
  const GridSpec grid = unitCube(24);
  const SolidBoundary solids = buildSolidBoundary(grid, openWalls(), {}, 0);
  const DenseField<float> phi = levelSet(grid, [](const auto& x) { return x.y() - 0.51; });
  MacVelocity u = macField(grid, spreading);
  continued(grid, phi, solids, u);
  // Cells below 12 are wet; the face under cell 12 is known, the one above it is not.
  EXPECT_NEAR(u[1](9, 13, 14), grid.faceCentre(1, 9, 13, 14).y(), 1e-5);
}

TEST(VelocityExtrapolator, GoesNoFurtherThanTheFlowInsideChanges) {
  const GridSpec grid = unitCube(24);
  const SolidBoundary solids = buildSolidBoundary(grid, openWalls(), {}, 0);
  const DenseField<float> phi = levelSet(grid, [](const auto& x) { return x.y() - 0.51; });
  MacVelocity u = macField(grid, [](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(-x.x(), 0.25 * x.y(), 0);  // asks for four times the change inside
  });
  continued(grid, phi, solids, u);
  EXPECT_NEAR(u[1](9, 13, 14), 0.25 * grid.faceCentre(1, 9, 13, 14).y(), 1e-5);
}

TEST(VelocityExtrapolator, LeavesAGapThatClosesAlone) {
  const GridSpec grid = unitCube(24);
  const SolidBoundary solids = buildSolidBoundary(grid, openWalls(), {}, 0);
  const DenseField<float> phi =  // two cells of air, 12 and 13, between bodies that meet
      levelSet(grid, [](const auto& x) { return 1.0 / 24 - std::abs(x.y() - 13.0 / 24); });
  MacVelocity u = macField(grid, [](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(-x.x(), x.y() < 13.0 / 24 ? x.y() : 1 - x.y(), 0);
  });
  const float below = u[1](9, 12, 14), above = u[1](9, 14, 14);
  continued(grid, phi, solids, u);
  EXPECT_NEAR(u[1](9, 13, 14), 0.5f * (below + above), 1e-5);
}

TEST(VelocityExtrapolator, RespectsMirrorSymmetry) {
  const GridSpec grid = unitCube(20);
  const SolidBoundary solids = buildSolidBoundary(grid, openWalls(), {}, 0);
  const DenseField<float> phi =
      levelSet(grid, [](const Eigen::Vector3d& x) { return x.y() - 0.4 - 0.1 * std::abs(x.x() - 0.5); });
  MacVelocity u = macField(grid, [](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(x.x() - 0.5, std::abs(x.x() - 0.5), x.y());
  });
  VelocityExtrapolator(grid).apply(phi, solids, 6, u);
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 20; ++j) {
      EXPECT_NEAR(u[1](i, j, 7), u[1](19 - i, j, 7), 1e-6);  // sums in another order
      EXPECT_NEAR(u[0](i, j, 7), -u[0](20 - i, j, 7), 1e-6);
    }
}

TEST(ConstrainToSolids, GivesClosedFacesTheVelocityOfTheirSolid) {
  const GridSpec grid = unitCube(12);
  const SolidObject block{"block", [](const Eigen::Vector3d& x, double) { return x.y() - 0.4; },
                          [](const Eigen::Vector3d&, double) { return Eigen::Vector3d(0, 0.7, 0); }, true};
  const SolidBoundary solids = buildSolidBoundary(grid, openWalls(), {block}, 0);
  MacVelocity u = macField(grid, [](const auto&) { return Eigen::Vector3d(1, 1, 1); });
  constrainToSolids(solids, u);
  EXPECT_FLOAT_EQ(u[1](5, 2, 5), 0.7f);  // deep inside
  EXPECT_FLOAT_EQ(u[1](5, 8, 5), 1);     // free
}

}  // namespace
}  // namespace spume::fluid
