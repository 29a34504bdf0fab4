// One box of the domain for the grid's walls, the checks, what leaves and what is said of a scene.
#include <gtest/gtest.h>

#include <algorithm>

#include "coupling/domain_box.h"
#include "coupling/scene_builder.h"
#include "coupling/scene_lint.h"
#include "coupling/simulation.h"
#include "tests/support/coupling_shapes.h"

namespace spume::coupling {
namespace {

/// 5.6 cells along z become 6: the box ends at 37.5 mm, not at 35 mm.
Scene roundedScene() {
  Scene scene;
  scene.domain.size = {0.1, 0.1, 0.035};
  scene.domain.resolution = 16;
  scene.stillPool = {true, 0.08};
  return scene;
}

bool speaksOf(const std::vector<Finding>& findings, const std::string& object) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& f) { return f.object == object; });
}

TEST(DomainBox, IsThatOfTheGrid) {
  const DomainBox box(roundedScene());
  EXPECT_NEAR(box.upper.z(), 0.0375, 1e-15);
  EXPECT_TRUE(box.holds({0.05, 0.05, 0.0371}));
  EXPECT_FALSE(box.holds({0.05, 0.05, 0.0376}));
  EXPECT_TRUE(box.reaches({0.05, 0.05, 0.0376}, 0.2e-3));
  EXPECT_FALSE(box.reaches({0.05, 0.05, 0.0378}, 0.2e-3));
}

TEST(DomainBox, NoBubbleInItLeavesThroughItsWall) {
  Scene scene = roundedScene();
  BubblesSpec spec;
  spec.bubble.position = {0.05, 0.05, 0.0371};
  spec.bubble.radius = 0.4e-3;
  scene.bubbles = {spec};
  ASSERT_NO_THROW(checkObjects(scene));
  Simulation simulation(scene);
  const StepReport report = simulation.step(0.005);
  EXPECT_EQ(simulation.bubbles().size(), 1u);
  EXPECT_EQ(report.gas.left, 0);
}

/// A level between the size that is written and the wall that is there lies in the domain.
TEST(DomainBox, IsTheOneThatLintSpeaksOf) {
  Scene scene = roundedScene();
  scene.domain.size = {0.1, 0.035, 0.1};
  scene.stillPool.level = 0.037;
  EXPECT_FALSE(speaksOf(lintScene(scene), "still_pool.level"));
  scene.stillPool.level = 0.038;
  EXPECT_TRUE(speaksOf(lintScene(scene), "still_pool.level"));
}

/// 1e6 sites are worth a word: the closed walls are 0.01 m^2 at the bottom and 4 of 0.1 x 0.0375 m^2.
TEST(DomainBox, HasTheWallsThatNucleationIsScatteredOver) {
  Scene scene = roundedScene();
  scene.domain.size = {0.1, 0.035, 0.1};
  NucleationSpec spec;
  spec.solid = "walls";
  constexpr double kSites = 1e6, kArea = 0.01 + 4 * 0.1 * 0.0375;
  for (const double part : {0.99, 1.01}) {
    spec.density = part * kSites / kArea;
    scene.nucleation = {spec};
    const std::vector<Finding> findings = lintScene(scene);
    const bool warned = std::any_of(findings.begin(), findings.end(), [](const Finding& f) {
      return f.message.find("sites over the walls") != std::string::npos;
    });
    EXPECT_EQ(warned, part > 1) << part;
  }
}

}  // namespace
}  // namespace spume::coupling
