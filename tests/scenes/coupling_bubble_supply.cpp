// A pool at rest with everything that makes and takes bubbles: books, events, resume.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "coupling/simulation.h"
#include "coupling/state_archive.h"
#include "tests/support/coupling_shapes.h"

namespace spume::coupling {
namespace {

constexpr double kBooks = 1e-12;  // model, Section 4: share of the gas that entered

/// Fizz in a box of 6 cm: a source, nucleation on the floor and walls, growth, and a region that takes
/// bubbles.
Scene fizz() {
  Scene scene;
  scene.domain.size = {0.06, 0.06, 0.06};
  scene.domain.resolution = 12;
  scene.stillPool = {true, 0.04};
  scene.foam.burstMedianLife = 0.3;
  scene.foam.walls.detachRadius = 0.4e-3;
  BubbleSourceSpec source;
  source.shape = test::ballShape({0.03, 0.01, 0.03}, 0.008);
  source.rate = 150;
  source.radius = {foam::RadiusLaw::powerLaw, 0, 0, -3, 0.4e-3, 1e-3};
  scene.bubbleSources = {source};
  NucleationSpec scratches;
  scratches.density = 1e4, scratches.waiting = 0.2;
  scratches.radius = {foam::RadiusLaw::uniform, 0, 0, 0, 0.2e-3, 0.3e-3};
  scene.nucleation = {scratches};
  scene.dissolvedGas.enabled = true;
  BubbleKillSpec corner;
  corner.shape = test::boxShape({0.03, 0.03, 0.03}, {0.07, 0.07, 0.07});
  scene.bubbleKills = {corner};
  scene.bubbles = {{"", {{0.02, 0.02, 0.02}, {0, 0, 0}, 1e-3, {}}}};
  return scene;
}

TEST(BubbleSupply, BooksCloseAndEveryBubbleHasItsEvents) {
  Simulation simulation(fizz());
  std::map<EventCause, int> causes;
  std::set<std::uint64_t> alive;
  double solution = 0;
  StepReport last;
  for (int frame = 0; frame < 60; ++frame)
    simulation.advanceFrame([&](const StepReport& step) {
      if (solution == 0) solution = step.gasInSolution + step.gas.grown + step.gas.bornNucleation;
      EXPECT_LE(std::abs(step.gas.imbalance()), kBooks * step.gas.entered());
      // accuracy, K3: what bubbles took is missing in the liquid.
      EXPECT_NEAR(step.gasInSolution + step.gas.grown + step.gas.bornNucleation, solution, 1e-10 * solution);
      for (const Event& event : step.events) {
        ++causes[event.cause];
        if (event.kind == Event::Kind::birth) {
          EXPECT_TRUE(alive.insert(event.id).second);
        }
        if (event.kind != Event::Kind::birth && event.kind != Event::Kind::classChange) {
          EXPECT_EQ(alive.erase(event.id), 1u);
          EXPECT_NE(event.cause, EventCause::none);
        }
        EXPECT_EQ(event.origin >= 0, event.cause == EventCause::source ||
                                         event.cause == EventCause::nucleation ||
                                         event.cause == EventCause::region);
      }
      last = step;
    });
  EXPECT_EQ(alive.size(), simulation.bubbles().size());
  EXPECT_EQ(causes[EventCause::scene], 1);
  EXPECT_NEAR(causes[EventCause::source], 300, 1);
  for (const EventCause cause : {EventCause::nucleation, EventCause::region, EventCause::age})
    EXPECT_GT(causes[cause], 10) << static_cast<int>(cause);
  EXPECT_GT(last.gas.grown, 0);
  EXPECT_GT(last.gas.killed, 0);
  for (const Eigen::Vector3d& x : simulation.bubbles().position)
    EXPECT_FALSE((x.array() > 0.036).all())
        << "a bubble further inside than a step takes it, in the region that removes them";
}

TEST(BubbleSupply, AResumedRunIsTheUninterruptedOne) {
  const Scene scene = fizz();
  Simulation whole(scene);
  for (int frame = 0; frame < 6; ++frame) whole.advanceFrame();
  Simulation resumed(scene, whole.state());
  for (int frame = 0; frame < 6; ++frame) whole.advanceFrame(), resumed.advanceFrame();
  SimulationState expected = whole.state(), got = resumed.state();
  ArchiveWriter first, second;
  archive(first, expected), archive(second, got);
  EXPECT_EQ(first.bytes, second.bytes);
  EXPECT_GT(whole.bubbles().size(), 50u);
}

/// In water that hardly covers it a source loses bubbles: their gas is booked, but not as born.
TEST(BubbleSupply, BubblesWithoutAPlaceAreBookedApart) {
  Scene scene = fizz();
  scene.stillPool.level = 0.005;
  scene.bubbles.clear();
  Simulation whole(scene);
  FrameReport last;
  for (int frame = 0; frame < 5; ++frame) whole.advanceFrame();
  Simulation resumed(scene, whole.state());
  for (int frame = 0; frame < 5; ++frame) last = whole.advanceFrame();
  const StepReport step = last.steps.back();
  const SourceProgress& source = whole.supply().sources.at(0);
  EXPECT_GT(step.sourceUnplaced, 5u);
  EXPECT_LT(step.sourceUnplaced, source.births);
  EXPECT_EQ(step.sourceUnplaced, source.unplaced);
  EXPECT_NEAR(step.gas.bornSources + step.gas.unplaced, source.gas, kBooks * source.gas);
  EXPECT_LE(std::abs(step.gas.imbalance()), kBooks * step.gas.entered());
  for (int frame = 0; frame < 5; ++frame) last = resumed.advanceFrame();
  EXPECT_EQ(last.steps.back().sourceUnplaced, step.sourceUnplaced);
  EXPECT_EQ(last.steps.back().gas.unplaced, step.gas.unplaced);
}

TEST(BubbleSupply, BubblesThatStickGrowUntilTheyLeave) {
  Scene scene = fizz();
  scene.bubbleSources.clear(), scene.bubbleKills.clear(), scene.bubbles.clear();
  scene.foam.bursting = false;
  scene.dissolvedGas.concentration = 500;  // champagne and more: they leave within the run
  scene.nucleation[0].density = 4e3;
  Simulation simulation(scene);
  for (int frame = 0; frame < 120; ++frame) simulation.advanceFrame();
  const foam::BubbleStore& bubbles = simulation.bubbles();
  std::size_t held = 0, gone = 0;
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    const double r = std::cbrt(3 * bubbles.gas[i] / (4 * std::numbers::pi));
    const bool holds = bubbles.touchedSolid[i] && bubbles.type[i] == foam::BubbleClass::liquid;
    held += holds;
    if (holds) {
      EXPECT_LE(r, 1.05 * 0.4e-3);  // detach radius; a step of growth on top
    }
    gone += bubbles.type[i] != foam::BubbleClass::liquid;
  }
  EXPECT_GT(held, 10u);
  EXPECT_GT(gone, 10u);
}

}  // namespace
}  // namespace spume::coupling
