#include <gtest/gtest.h>

#include <random>

#include "coupling/vdb_liquid_sampler.h"

namespace spume::coupling {
namespace {

constexpr double kFloatError = 1e-6;  // fields of order 1 stored as float, eight of them combined
constexpr double kSlopeError = 1e-5;  // the same divided by dx 0.1
constexpr double kDifferenceStep = 1e-7;
constexpr double kDifferenceError =
    1e-7;  // round-off 1e-16 / step of a function that is linear along each axis

const Eigen::Vector3d kSlope{0.3, -0.7, 0.2};
const Eigen::Matrix3d kShear =
    (Eigen::Matrix3d() << 0.1, 0.2, 0.3, -0.4, 0.5, 0.6, 0.7, -0.8, 0.9).finished();

double linear(const Eigen::Vector3d& x) { return kSlope.dot(x) - 10; }  // liquid everywhere
Eigen::Vector3d linearVelocity(const Eigen::Vector3d& x) { return kShear * x; }

/// A grid of 8 x 10 x 6 cells whose fields `field` and `faces` fill, all faces open.
struct Liquid {
  fluid::LiquidState state;
  fluid::SolidBoundary solids;

  template <typename Field, typename Faces>
  Liquid(const Field& field, const Faces& faces) {
    state.grid = {{8, 10, 6}, 0.1, {-0.2, 0.3, 0.5}};
    const auto& grid = state.grid;
    state.phi = solids.psi = fluid::DenseField<float>(grid.cells);
    solids.object = fluid::DenseField<std::int16_t>(grid.cells, -1);
    state.velocity = state.pressureGradient = fluid::MacField<float>(grid.cells);
    solids.open = fluid::MacField<float>(grid.cells, 1.0f);
    eachPoint(grid.cells, [&](int i, int j, int k) {
      state.phi(i, j, k) = static_cast<float>(field(grid.cellCentre(i, j, k)));
    });
    eachPoint(grid.cells + Eigen::Vector3i::Constant(2), [&](int i, int j, int k) {  // ghosts, too
      solids.psi(i - 1, j - 1, k - 1) = static_cast<float>(field(grid.cellCentre(i - 1, j - 1, k - 1)));
    });
    for (int axis = 0; axis < 3; ++axis)
      eachPoint(state.velocity[axis].size(), [&](int i, int j, int k) {
        const auto value = static_cast<float>(faces(grid.faceCentre(axis, i, j, k))[axis]);
        state.velocity[axis](i, j, k) = state.pressureGradient[axis](i, j, k) = value;
      });
  }

  template <typename Body>
  static void eachPoint(const Eigen::Vector3i& size, const Body& body) {
    for (int i = 0; i < size.x(); ++i)
      for (int j = 0; j < size.y(); ++j)
        for (int k = 0; k < size.z(); ++k) body(i, j, k);
  }

  Eigen::Matrix3Xd points(int count, double margin = 0) const {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    Eigen::Matrix3Xd points(3, count);
    for (int i = 0; i < count; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        const double low = state.grid.origin[axis] - margin, high = state.grid.upper()[axis] + margin;
        points(axis, i) = low + (high - low) * unit(random);
      }
    return points;
  }
};

Liquid linearLiquid() { return {linear, linearVelocity}; }

TEST(VdbLiquidSampler, LinearFieldsAreExactUpToTheWalls) {
  const Liquid liquid = linearLiquid();
  const VdbLiquidSampler sampler(liquid.state, liquid.solids);
  const Eigen::Matrix3Xd x = liquid.points(2000);
  Eigen::VectorXd phi(x.cols()), psi(x.cols());
  Eigen::Matrix3Xd gradPhi(3, x.cols()), gradPsi(3, x.cols()), velocity(3, x.cols()), pressure(3, x.cols());
  sampler.phi(x, phi);
  sampler.psi(x, psi);
  sampler.gradPhi(x, gradPhi);
  sampler.gradPsi(x, gradPsi);
  sampler.velocity(x, velocity);
  sampler.gradPressure(x, pressure);
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    EXPECT_NEAR(phi[i], linear(x.col(i)), 10 * kFloatError);  // phi is about -10
    EXPECT_NEAR(psi[i], linear(x.col(i)), 10 * kFloatError);
    EXPECT_LT((gradPhi.col(i) - kSlope).norm(), 10 * kSlopeError);
    EXPECT_LT((gradPsi.col(i) - kSlope).norm(), 10 * kSlopeError);
    EXPECT_LT((velocity.col(i) - linearVelocity(x.col(i))).norm(), kFloatError);
    EXPECT_LT((pressure.col(i) - linearVelocity(x.col(i))).norm(), kFloatError);
  }
}

TEST(VdbLiquidSampler, GradientsAreTheDerivativesOfTheInterpolants) {
  const Liquid liquid([](const Eigen::Vector3d& x) { return std::sin(5 * x.x()) * x.y() + x.z() * x.z(); },
                      linearVelocity);
  const VdbLiquidSampler sampler(liquid.state, liquid.solids);
  const Eigen::Matrix3Xd x = liquid.points(500, 0.15);
  Eigen::Matrix3Xd gradPhi(3, x.cols()), gradPsi(3, x.cols());
  sampler.gradPhi(x, gradPhi);
  sampler.gradPsi(x, gradPsi);
  const auto inside = [&](Eigen::Index i) {
    const auto& grid = liquid.state.grid;
    return (x.col(i).array() > grid.origin.array()).all() && (x.col(i).array() < grid.upper().array()).all();
  };
  Eigen::VectorXd plus(x.cols()), minus(x.cols());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kDifferenceStep * Eigen::Vector3d::Unit(axis);
    const Eigen::Matrix3Xd after = x.colwise() + step, before = x.colwise() - step;
    sampler.phi(after, plus);
    sampler.phi(before, minus);
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      if (!inside(i))
        continue;  // there phi is continued along a gradient that itself changes along the border
      EXPECT_NEAR(gradPhi(axis, i), (plus[i] - minus[i]) / (2 * kDifferenceStep), kDifferenceError);
    }
    sampler.psi(after, plus);
    sampler.psi(before, minus);
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      EXPECT_NEAR(gradPsi(axis, i), (plus[i] - minus[i]) / (2 * kDifferenceStep), kDifferenceError);
  }
}

TEST(VdbLiquidSampler, OutsideTheGridWallsAreDeepAndFieldsAreHeld) {
  const Liquid liquid = linearLiquid();
  const VdbLiquidSampler sampler(liquid.state, liquid.solids);
  const Eigen::Vector3d border(0.1, liquid.state.grid.origin.y(), 0.7);
  Eigen::Matrix3Xd x(3, 2);
  x << border, border - Eigen::Vector3d(0, 0.25, 0);
  Eigen::VectorXd phi(2), psi(2);
  Eigen::Matrix3Xd velocity(3, 2);
  sampler.phi(x, phi);
  sampler.psi(x, psi);
  sampler.velocity(x, velocity);
  EXPECT_NEAR(psi[1], psi[0] - 0.25, kFloatError);
  EXPECT_NEAR(phi[1], linear(x.col(1)), 10 * kFloatError);
  EXPECT_EQ(velocity.col(1), velocity.col(0));
}

/// Along an edge the distance is that to the nearer wall, in the last half cell as well.
TEST(VdbLiquidSampler, EdgesOfTheDomainKeepBothWalls) {
  const Eigen::Vector3d corner(-0.2, 0.3, 0);
  const auto edge = [&](const Eigen::Vector3d& x) {
    return std::min(x.x() - corner.x(), x.y() - corner.y());
  };
  const Liquid liquid(edge, linearVelocity);
  const VdbLiquidSampler sampler(liquid.state, liquid.solids);
  Eigen::Matrix3Xd x(3, 2);
  x.col(0) = Eigen::Vector3d(-0.2, 0.39, 0.8);  // on one wall, 0.9 cells from the other
  x.col(1) = Eigen::Vector3d(-0.21, 0.39, 0.8);
  Eigen::VectorXd psi(2);
  sampler.psi(x, psi);
  EXPECT_NEAR(psi[0], 0, kFloatError);
  EXPECT_NEAR(psi[1], -0.01, kFloatError);
}

constexpr double kWeight = 9800;  // rho g

/// Water at rest on a closed floor, its surface inside a cell.
Liquid restingWater() {
  constexpr double kSurface = 0.8317;
  Liquid liquid([&](const Eigen::Vector3d& x) { return x.y() - kSurface; },
                [&](const Eigen::Vector3d&) { return Eigen::Vector3d(0, -kWeight, 0); });
  for (int axis = 0; axis < 3; ++axis) {  // the solver knows no pressure in the air, nor across closed faces
    auto& field = liquid.state.pressureGradient[axis];
    Liquid::eachPoint(field.size(), [&](int i, int j, int k) {
      const bool wall = axis == 1 && j == 0;
      if (wall) liquid.solids.open[axis](i, j, k) = 0;
      if (wall || liquid.state.grid.faceCentre(axis, i, j, k).y() > kSurface + 0.1) field(i, j, k) = 0;
    });
  }
  return liquid;
}

TEST(VdbLiquidSampler, PressureGradientIsContinuedAboveTheSurface) {
  const Liquid liquid = restingWater();
  const VdbLiquidSampler sampler(liquid.state, liquid.solids);
  for (const int points : {500, 5000}) {  // the faces of the grid are looked at one by one, or all first
    const Eigen::Matrix3Xd x = liquid.points(points, 0.1);
    Eigen::Matrix3Xd pressure(3, x.cols());
    sampler.gradPressure(x, pressure);
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      EXPECT_LT((pressure.col(i) - Eigen::Vector3d(0, -kWeight, 0)).norm(), kFloatError * kWeight)
          << x.col(i).transpose();
  }
}

TEST(VdbLiquidSampler, SolidsAnswerWithTheirIndexAndVelocity) {
  Liquid liquid = linearLiquid();
  liquid.solids.object(3, 4, 5) = 2;
  const VdbLiquidSampler sampler(liquid.state, liquid.solids, [](int object, const Eigen::Vector3d& x) {
    return object < 0 ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(object, x.x(), 0);
  });
  Eigen::Matrix3Xd x(3, 2);
  x << liquid.state.grid.cellCentre(3, 4, 5), liquid.state.grid.cellCentre(0, 0, 0);
  Eigen::VectorXi index(2);
  Eigen::Matrix3Xd velocity(3, 2);
  sampler.solidIndex(x, index);
  sampler.solidVelocity(x, velocity);
  EXPECT_EQ(index[0], 2);
  EXPECT_EQ(index[1], -1);
  EXPECT_EQ(velocity.col(0), Eigen::Vector3d(2, x(0, 0), 0));
  EXPECT_EQ(velocity.col(1), Eigen::Vector3d(0, 0, 0));
}

TEST(VdbLiquidSampler, AnswerDoesNotDependOnTheBatch) {
  Liquid liquid = restingWater();
  std::mt19937 random(5);
  for (int axis = 0; axis < 3; ++axis) {  // no two faces alike, and closed ones anywhere
    auto& field = liquid.state.pressureGradient[axis];
    Liquid::eachPoint(field.size(), [&](int i, int j, int k) {
      field(i, j, k) = static_cast<float>(random() % 1000);
      liquid.solids.open[axis](i, j, k) = static_cast<float>(random() % 4 != 0);
    });
  }
  const VdbLiquidSampler sampler(liquid.state, liquid.solids);
  const Eigen::Matrix3Xd x = liquid.points(5000, 0.3);
  Eigen::VectorXd together(x.cols()), alone(1);
  Eigen::Matrix3Xd pressure(3, x.cols()), pressureAlone(3, 1);
  sampler.phi(x, together), sampler.gradPressure(x, pressure);
  for (Eigen::Index i = 0; i < x.cols(); i += 97) {
    sampler.phi(x.col(i), alone), sampler.gradPressure(x.col(i), pressureAlone);
    EXPECT_EQ(alone[0], together[i]);
    EXPECT_EQ(pressureAlone.col(0), pressure.col(i));
  }
}

}  // namespace
}  // namespace spume::coupling
