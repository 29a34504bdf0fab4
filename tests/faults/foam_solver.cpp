// What must be refused, and that a refused step changes nothing.
#include <gtest/gtest.h>

#include <limits>

#include "foam/errors.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A pool that answers one question with nonsense.
class BrokenPool : public StillPool {
 public:
  explicit BrokenPool(const StillPoolParams& params) : StillPool(params) {}
  void velocity(Points x, Vectors out) const override {
    StillPool::velocity(x, out);
    out(1, 0) = kNan;
  }
};

/// A pool whose walls move by nonsense where they are seen from over 1 mm above the floor.
class BrokenWalls : public StillPool {
 public:
  explicit BrokenWalls(const StillPoolParams& params) : StillPool(params), floor_(params.lower.y()) {}
  void solidVelocity(Points x, Vectors out) const override {
    StillPool::solidVelocity(x, out);
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      if (x(1, i) > floor_ + 1e-3) out(0, i) = kNan;
  }

 private:
  double floor_;
};

BubbleStore threeBubbles() {
  BubbleStore bubbles;
  for (int i = 0; i < 3; ++i) bubbles.add(bubbleAt({1.5e-3 * i, -5e-3, 0}, 1e-3));
  return bubbles;
}

/// Steps and expects `Error`; the store must be as before, NaN included.
template <typename Error>
void expectRefusal(BubbleStore bubbles, const LiquidSampler& pool, double dt, const char* reason) {
  FoamSolver solver(makePreset(Preset::physical));
  const BubbleStore before = bubbles;
  try {
    solver.step(bubbles, pool, dt);
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
  EXPECT_EQ(bubbles.id, before.id);
  EXPECT_EQ(bubbles.position[1], before.position[1]);
  EXPECT_EQ(bubbles.radius[2], before.radius[2]);
  EXPECT_EQ(bubbles.age, before.age);
}

TEST(FoamFaults, NanInTheStoreIsNamedAndNothingChanges) {
  const StillPool pool = openPool(makePreset(Preset::physical));
  const char* const kReasons[] = {
      "bubble 0 at [nan, -0.005, 0] m at the start of a step of 0.01 s: its place is not finite",
      "its velocity of [0, 0, nan] m/s is not finite", "its radius of nan m is not positive",
      "its gas of -1e-09 m^3 is not positive"};
  for (int column = 0; column < 4; ++column) {
    BubbleStore bubbles = threeBubbles();
    if (column == 0) bubbles.position[0].x() = kNan;
    if (column == 1) bubbles.velocity[0].z() = kNan;
    if (column == 2) bubbles.radius[0] = kNan;
    if (column == 3) bubbles.gas[0] = -1e-9;
    expectRefusal<NumericalFailure>(bubbles, pool, 0.01, kReasons[column]);
  }
}

TEST(FoamFaults, NanFromTheLiquidIsRefused) {
  expectRefusal<NumericalFailure>(threeBubbles(), BrokenPool(StillPoolParams()), 0.01, "velocity = ");
  expectRefusal<NumericalFailure>(threeBubbles(), BrokenPool(StillPoolParams()), 0.01, ", -0.005, 0] m");
}

/// From its wall a bubble looks a radius up for another one, and is told nonsense there.
TEST(FoamFaults, NanFromTheLiquidWhereABubbleLooksForWallsIsRefused) {
  StillPoolParams params;
  params.lower = {-1, -0.01, -1}, params.upper = {1, 1, 1};
  params.closed = {true, true, true, true, true, true};
  BubbleStore bubbles;
  for (int i = 0; i < 3; ++i) bubbles.add(bubbleAt({5e-3 * i, -9.5e-3, 0}, 1e-3));
  const char* const kParts[] = {"solidVelocity = [nan, 0, 0], not all finite, at [",
                                ", -0.0085, 0] m, where bubble ", ", -0.0095, 0] m looks for walls"};
  for (const char* part : kParts) expectRefusal<NumericalFailure>(bubbles, BrokenWalls(params), 0.01, part);
}

TEST(FoamFaults, AStepMustBePositiveAndFinite) {
  const StillPool pool = openPool(makePreset(Preset::physical));
  for (const double dt : {0.0, -0.01, kNan, std::numeric_limits<double>::infinity()})
    expectRefusal<InvalidParameter>(threeBubbles(), pool, dt, "dt");
}

TEST(FoamFaults, ASolveThatRunsOutOfIterationsIsTakenOverByTheDirectSolverAndSaysSo) {
  FoamParams params = makePreset(Preset::physical);
  params.solverIterations = 1, params.solverTolerance = 1e-12;
  FoamSolver solver(params);
  BubbleStore bubbles = threeBubbles();
  const FoamStepReport report = solver.step(bubbles, openPool(params), 0.01);
  EXPECT_TRUE(report.solverFellBack);
  EXPECT_TRUE(bubbles.position[0].allFinite());
}

/// A step so long that its square overflows leaves no solver a chance.
TEST(FoamFaults, ASolveThatDoesNotConvergeIsReportedAndChangesNothing) {
  const StillPool pool = openPool(makePreset(Preset::physical));
  expectRefusal<NumericalFailure>(threeBubbles(), pool, 1e200, "did not converge");
  expectRefusal<NumericalFailure>(threeBubbles(), pool, 1e200, ", worst for bubble ");
}

TEST(FoamFaults, EveryParameterOutOfRangeIsNamed) {
  const auto refused = [](auto change, const char* name) {
    FoamParams params;
    change(params);
    try {
      FoamSolver solver(params);
      ADD_FAILURE() << name << " was accepted";
    } catch (const InvalidParameter& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  };
  refused([](FoamParams& p) { p.wetness = 1.2; }, "wetness");
  refused([](FoamParams& p) { p.density = 0; }, "density");
  refused([](FoamParams& p) { p.springStiffness = -1; }, "springStiffness");
  refused([](FoamParams& p) { p.viscosity = kNan; }, "viscosity");
  refused([](FoamParams& p) { p.gravity.x() = kNan; }, "gravity");
  refused([](FoamParams& p) { p.solverIterations = 0; }, "solverIterations");
  refused([](FoamParams& p) { p.gasDensity = 0, p.addedMass = 0; }, "inertia");
}

}  // namespace
}  // namespace spume::foam::test
