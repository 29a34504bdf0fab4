// Moved, turned or seen at another scale a foam has the same cells (accuracy, 5), from both engines.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "foam/power_diagram.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;

constexpr double kInvariance = 1e-9;  // accuracy, 5; of a ball's volume, sphere and radius

/// x -> scale (turn x + shift).
struct Similarity {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vector3d shift = Vector3d::Zero();
  double scale = 1;

  Balls of(Balls balls) const {
    for (Vector3d& x : balls.position) x = scale * (turn * x + shift);
    for (double& r : balls.radius) r *= scale;
    return balls;
  }
};

/// A turn about a random axis by a random angle, and a shift of up to a thousand radii of the median ball.
Similarity randomMotion(std::uint64_t seed) {
  constexpr double kFarthest = 1e3;
  CounterRandom random(seed, 0, 7);
  const auto between = [&random] { return 2 * random.uniform() - 1; };
  const double w = between(), x = between(), y = between(), z = between();
  Similarity motion;
  motion.turn = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  for (double& component : motion.shift) component = kFarthest * between();
  return motion;
}

template <typename Engine>
FoamTopology cellsOf(const Balls& balls) {
  FoamTopology topology;
  Engine().compute(balls.position, balls.radius, balls.id, topology);
  return topology;
}

void expectSameFilms(const FoamTopology& moved, const FoamTopology& still, const Balls& balls, double scale) {
  ASSERT_EQ(moved.films.size(), still.films.size());
  for (std::size_t f = 0; f < still.films.size(); ++f) {
    const Film &a = moved.films[f], &b = still.films[f];
    ASSERT_TRUE(a.i == b.i && a.j == b.j) << "film " << f;
    const double r = std::min(balls.radius[b.i], balls.radius[b.j]), disc = std::numbers::pi * r * r;
    EXPECT_NEAR(a.distance / scale, b.distance, kInvariance * r);
    EXPECT_NEAR(a.height / scale, b.height, kInvariance * r);
    EXPECT_NEAR(a.area / (scale * scale), b.area, kInvariance * disc) << b.i << "," << b.j;
  }
}

template <typename Engine>
class Invariance : public testing::Test {
 protected:
  Invariance() : still_(cellsOf<Engine>(balls_)) {}

  void expectSame(const Similarity& change) const {
    const FoamTopology moved = cellsOf<Engine>(change.of(balls_));
    const double s = change.scale;
    EXPECT_EQ(moved.hidden, still_.hidden);
    expectSameFilms(moved, still_, balls_, s);
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      const double r = balls_.radius[i], sphere = 4 * std::numbers::pi * r * r;
      EXPECT_NEAR(moved.volume[i] / (s * s * s), still_.volume[i], kInvariance * ballVolume(r)) << i;
      EXPECT_NEAR(moved.freeArea[i] / (s * s), still_.freeArea[i], kInvariance * sphere) << i;
      EXPECT_NEAR(moved.filmArea[i] / (s * s), still_.filmArea[i], kInvariance * sphere) << i;
    }
  }

 private:
  Balls balls_ = randomFoam(500, .5, 4, 1, 51);
  FoamTopology still_;
};

using Engines = testing::Types<PowerCells, PowerDiagram>;
TYPED_TEST_SUITE(Invariance, Engines);

TYPED_TEST(Invariance, UnderTurnsAndShifts) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    this->expectSame(randomMotion(seed));
  }
}

TYPED_TEST(Invariance, UnderAChangeOfUnits) {
  for (const double scale : {1e-4, 1e-3, .3, 7., 1e2}) {
    SCOPED_TRACE(scale);
    this->expectSame({.scale = scale});
  }
}

}  // namespace
}  // namespace spume::foam::test
