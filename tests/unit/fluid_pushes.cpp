#include <gtest/gtest.h>

#include "fluid/pushes.h"
#include "tests/support/fluid_fields.h"

namespace spume::fluid {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr double kDensity = 1000;
constexpr double kSingle = 1e-6;  ///< velocities are kept in single precision

/// A cube of 8 cells an edge under a flat surface, liquid at rest.
struct Pool {
  explicit Pool(double surface) : phi(levelSet(grid, [=](const auto& x) { return x.y() - surface; })) {}

  GridSpec grid = unitCube(8);
  SolidBoundary solids = buildSolidBoundary(grid, openWalls(), {}, 0);
  DenseField<float> phi;
  MacVelocity velocity = macField(grid, [](const auto&) { return Vector3d::Zero(); });

  PushReport push(const std::vector<Push>& pushes) {
    return Pushes().apply(grid, kDensity, phi, solids.open, pushes, velocity);
  }
  double cellMass() const { return kDensity * grid.cellVolume(); }
  Vector3d momentum() const {
    Vector3d sum = Vector3d::Zero();
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3i n = velocity[a].size();
      for (int i = 0; i < n.x(); ++i)
        for (int j = 0; j < n.y(); ++j)
          for (int k = 0; k < n.z(); ++k) sum[a] += cellMass() * velocity[a](i, j, k);
    }
    return sum;
  }
};

TEST(Pushes, BecomeMomentumOfTheLiquid) {
  Pool pool(2);  // nothing but liquid
  const std::vector<Push> pushes = {{{0.5, 0.45, 0.55}, {1e-3, -2e-3, 3e-3}, 1e-3},
                                    {{0.51, 0.45, 0.3}, {4e-3, 1e-3, 0}, 1e-3},
                                    {{0.31, 0.77, 0.3}, {-1e-3, 0, 5e-3}, 1e-3}};
  const PushReport report = pool.push(pushes);
  const Vector3d given{4e-3, -1e-3, 8e-3};
  EXPECT_LT((report.given - given).norm(), 1e-15);
  EXPECT_LT(report.withheld.norm(), 1e-15);
  EXPECT_LT((pool.momentum() - given).norm(), kSingle * given.norm());
}

TEST(Pushes, AtTheSurfaceGoToTheLiquidAlone) {
  Pool pool(0.5);
  const Vector3d impulse{1e-3, 2e-3, 0};
  pool.push({{{0.4, 0.48, 0.5}, impulse, 1e-3}});
  EXPECT_LT((pool.momentum() - impulse).norm(), kSingle * impulse.norm());
  for (int j = 5; j < 8; ++j) EXPECT_EQ(pool.velocity[1](3, j, 3), 0) << j;
}

TEST(Pushes, FarFromTheLiquidAreWithheld) {
  Pool pool(0.2);
  const PushReport report = pool.push({{{0.4, 0.8, 0.5}, {1, 2, 3}, 1}});
  EXPECT_EQ(report.given, Vector3d::Zero());
  EXPECT_EQ(report.withheld, Vector3d(1, 2, 3));
  EXPECT_EQ(pool.momentum(), Vector3d::Zero());
}

/// A crowd ten times as heavy as the liquid it pushes takes the liquid along, no faster than it moves itself.
TEST(Pushes, NeverThrowTheLiquidBeyondWhatPushesIt) {
  constexpr double kSlip = 0.3;  // [m/s]
  Pool pool(2);
  const double resistance = 10 * pool.cellMass();
  const Vector3d face = pool.grid.faceCentre(0, 4, 4, 4);
  const PushReport report = pool.push({{face, {resistance * kSlip, 0, 0}, resistance}});
  EXPECT_NEAR(pool.velocity[0](4, 4, 4), kSlip, kSingle);
  EXPECT_NEAR(report.given.x(), pool.cellMass() * kSlip, 1e-12);
  EXPECT_NEAR(report.withheld.x(), (resistance - pool.cellMass()) * kSlip, 1e-12);
}

}  // namespace
}  // namespace spume::fluid
