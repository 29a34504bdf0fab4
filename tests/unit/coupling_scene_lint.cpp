#include <gtest/gtest.h>

#include <numbers>

#include "coupling/foam_objects.h"
#include "coupling/room_lint.h"
#include "coupling/scene_lint.h"
#include "coupling/scene_toml.h"
#include "coupling/scene_volumes.h"
#include "coupling/unused_keys.h"
#include "tests/support/coupling_shapes.h"

namespace spume::coupling {
namespace {

Scene pouring() { return readScene(SPUME_SOURCE_DIR "/data/scenes/pouring.toml"); }

bool mentions(const std::vector<Finding>& findings, const std::string& object, const std::string& words) {
  for (const Finding& finding : findings)
    if (finding.object == object && finding.message.find(words) != std::string::npos) return true;
  return false;
}

std::vector<Finding> lintRoomOf(const Scene& scene) {
  FindingList findings;
  lintRoom(scene, findings);
  return findings.take();
}

std::vector<Finding> notesOn(const Scene& scene) {
  FindingList findings;
  noteUnusedKeys(scene, findings);
  return findings.take();
}

TEST(SceneLint, ShippedPouringHasNoWarning) {
  for (const Finding& finding : lintScene(pouring()))
    EXPECT_NE(finding.severity, Severity::warning) << finding.object << " " << finding.message;
}

TEST(SceneLint, ThinSolidIsNamedWithTheResolutionItNeeds) {
  Scene scene = pouring();
  scene.solids.push_back(
      {"slab", {ShapeKind::box, {0, 0.125, 0}, {0.16, 0.126953125, 0.16}, {0, 0, 0}, {0, 1, 0}, 0, 0}});
  EXPECT_TRUE(mentions(lintScene(scene), "solid 'slab'", "at least 82"));  // 0.16 m / (1/512 m), up
}

TEST(SceneLint, OverlapsThinVesselsAndBuriedProbesAreNamed) {
  Scene scene = pouring();  // cells of 2.5 mm
  SolidSpec mug;
  mug.name = "mug";
  mug.shape.kind = ShapeKind::vessel;
  mug.shape.centre = {0.08, 0.02, 0.08};
  mug.shape.wallThickness = 0.0021;
  scene.solids = {mug};
  EXPECT_TRUE(mentions(lintScene(scene), "solid 'mug'", "at least 77"));  // 0.16 m / 2.1 mm, up
  EXPECT_FALSE(mentions(lintScene(scene), "solid 'mug'", "overlaps"));
  SolidSpec ball;
  ball.name = "ball";
  ball.shape.kind = ShapeKind::sphere;
  ball.shape.centre = {0.08, 0.02, 0.08};
  ball.shape.radius = 0.01;
  scene.solids.push_back(ball);
  EXPECT_TRUE(mentions(lintScene(scene), "solid 'mug'", "overlaps solid 'ball'"));
  scene.solids[1].motion.position = Eigen::Vector3d(0, 0.05, 0);  // in the room of the mug
  EXPECT_FALSE(mentions(lintScene(scene), "solid 'mug'", "overlaps"));
  scene.probes.resize(1);
  scene.probes[0].position = {0.08, 0.07, 0.08};
  EXPECT_TRUE(mentions(lintScene(scene), "probe 0", "lies in a solid"));
}

TEST(SceneLint, WhatHasNoRoomOnTheGridIsNamed) {
  Scene scene = pouring();  // cells of 2.5 mm
  scene.liquidBodies[0].shape.upper.y() = 0.001;
  EXPECT_TRUE(mentions(lintScene(scene), "liquid_body 'pool'", "no free centre of a cell"));
  scene.liquidBodies[0].shape.upper.y() = 0.002;
  EXPECT_FALSE(mentions(lintScene(scene), "liquid_body 'pool'", "no free centre of a cell"));
  scene.outflows.resize(1);
  scene.outflows[0].name = "drain";
  scene.outflows[0].shape = test::boxShape({0.06, 0, 0.06}, {0.1, 0.02, 0.1});
  EXPECT_FALSE(mentions(lintScene(scene), "outflow 'drain'", "inside a solid"));
  scene.solids = {test::solidOf("floor", test::boxShape({0, 0, 0}, {0.16, 0.02, 0.16}))};
  EXPECT_TRUE(mentions(lintScene(scene), "outflow 'drain'", "inside a solid"));
  scene.inflows.clear();
  scene.solids[0].shape = test::boxShape({-1, -1, -1}, {1, 1, 1});
  EXPECT_TRUE(mentions(lintScene(scene), "domain", "all solid"));
}

/// Of 16 places a bubble finds none outside the solid in 0.75^16 = 1 % of all cases.
TEST(SceneLint, SourcesThatLieMostlyInSolidsAreNamed) {
  Scene scene = pouring();
  scene.bubbleSources.resize(1);
  scene.bubbleSources[0].shape = test::boxShape({0.06, 0.02, 0.06}, {0.1, 0.06, 0.1});
  scene.solids = {test::solidOf("slab", test::boxShape({0, 0, 0}, {0.16, 0.036, 0.16}))};
  EXPECT_FALSE(mentions(lintScene(scene), "bubble_source 0", "outside solids"));
  scene.solids[0].shape.upper.y() = 0.05;
  EXPECT_TRUE(mentions(lintScene(scene), "bubble_source 0", "of its bubbles will find no place"));
  const DomainBox domain(scene);
  const double share = roomShare(scene.bubbleSources[0].shape, domain, solidDistance(scene));
  EXPECT_NEAR(share, 0.25, 0.03);  // three deviations of 2000 points
}

TEST(SceneLint, EdgesThatRoundingChangesAreNamed) {
  Scene scene = pouring();
  EXPECT_FALSE(mentions(lintScene(scene), "domain.size", ""));
  scene.domain.size = {0.16, 0.16, 0.001};  // four cells of 2.5 mm at least
  EXPECT_TRUE(mentions(lintRoomOf(scene), "domain.size", "0.001 m along z becomes 0.01 m"));
}

TEST(SceneLint, SolidsThatJumpRaceOrStayOutsideAreNamed) {
  Scene scene = pouring();
  scene.solids = {test::solidOf("paddle", test::boxShape({0.02, 0.02, 0.02}, {0.05, 0.05, 0.05}))};
  EXPECT_FALSE(mentions(lintScene(scene), "solid 'paddle'", ""));
  scene.solids[0].motion.position.keys = {{0, {0, 0, 0}}, {0.001, {0.1, 0, 0}}};
  EXPECT_TRUE(mentions(lintScene(scene), "solid 'paddle'", "40 cells between its keys"));
  scene.solids[0].motion.position.keys = {{0, {0, 0, 0}}, {0.1, {0.1, 0, 0}}};  // 1 m/s
  EXPECT_FALSE(mentions(lintScene(scene), "solid 'paddle'", ""));
  scene.solids[0].motion.position.keys = {{0, {0, 0, 0}}, {0.02, {0.1, 0, 0}}};
  EXPECT_TRUE(mentions(lintScene(scene), "solid 'paddle'", "5 m/s"));
  scene.solids[0].motion = {};
  scene.solids[0].motion.rotationAxis = {0, 1, 0};
  scene.solids[0].motion.rotation.keys = {{0, 0}, {1, 36000}};  // 628 rad/s, at least 0.02 m from the axis
  EXPECT_TRUE(mentions(lintScene(scene), "solid 'paddle'", "moves at up to"));
  scene.solids[0].motion = {};
  scene.solids[0].motion.position = Eigen::Vector3d(5, 5, 5);
  EXPECT_TRUE(mentions(lintScene(scene), "solid 'paddle'", "no point of the grid"));
}

TEST(SceneLint, KeysThatDoNothingAreNoted) {
  Scene scene = pouring();
  EXPECT_FALSE(mentions(lintScene(scene), "foam.drag_coefficient", ""));
  scene.foam.dragCoefficient = 100;
  EXPECT_TRUE(mentions(lintScene(scene), "foam.drag_coefficient", "foam.drag_law"));
  scene.foam.dragLaw = foam::DragLaw::coefficient;
  EXPECT_FALSE(mentions(lintScene(scene), "foam.drag_coefficient", ""));
  scene.stillPool.level = 0.05;
  EXPECT_TRUE(mentions(lintScene(scene), "still_pool.level", "still_pool.enabled"));
}

/// A key, a change of the scene that sets it in vain, the key that is to blame, and one that makes it count.
struct VainKey {
  std::string key;
  void (*set)(Scene&);
  std::string blames;
  void (*use)(Scene&);
};

TEST(SceneLint, EveryKeyOfTheFoamThatAnotherSwitchesOffIsNoted) {
  using foam::AttractionLaw;
  const VainKey kKeys[] = {
      {"foam.spring_surface_tension_factor",
       [](Scene& s) { s.foam.springSurfaceTensionFactor = 0.6, s.foam.springFromSurfaceTension = false; },
       "foam.spring_from_surface_tension", [](Scene& s) { s.foam.springFromSurfaceTension = true; }},
      {"foam.gas_viscosity",
       [](Scene& s) { s.foam.gasViscosity = 1e-5, s.foam.airDragLaw = foam::AirDragLaw::coefficient; },
       "foam.air_drag_law", [](Scene& s) { s.foam.airDragLaw = foam::AirDragLaw::stokes; }},
      {"foam.weak_pairs", [](Scene& s) { s.foam.weakPairs = false; }, "foam.attraction_law",
       [](Scene& s) { s.foam.attractionLaw = AttractionLaw::capillary; }},
      {"foam.burst_reference_radius",
       [](Scene& s) { s.foam.burstReferenceRadius = 2e-3, s.foam.bursting = false; }, "foam.bursting",
       [](Scene& s) { s.foam.bursting = true; }},
      {"foam.burst_shape", [](Scene& s) { s.foam.burstShape = 1, s.foam.bursting = false; }, "foam.bursting",
       [](Scene& s) { s.foam.bursting = true; }},
      {"foam.burst_wall_factor", [](Scene& s) { s.foam.burstWallFactor = 0.5, s.foam.bursting = false; },
       "foam.bursting", [](Scene& s) { s.foam.bursting = true; }},
      {"foam.burst_wall_distance", [](Scene& s) { s.foam.burstWallDistance = 0.02, s.foam.bursting = true; },
       "foam.burst_wall_factor", [](Scene& s) { s.foam.burstWallFactor = 0.5; }},
      {"foam.walls.adhesion", [](Scene& s) { s.foam.walls.adhesion = 1; }, "foam.walls.detach_radius",
       [](Scene& s) { s.foam.walls.detachRadius = 1e-3; }},
      {"foam.walls.detach_radius",
       [](Scene& s) { s.foam.walls.detachRadius = 1e-3, s.foam.walls.adhesion = 0; }, "foam.walls.adhesion",
       [](Scene& s) { s.foam.walls.adhesion = 1; }},
      {"foam.walls.attraction", [](Scene& s) { s.foam.walls.attraction = 1e-7; }, "foam.attraction_law",
       [](Scene& s) { s.foam.attractionLaw = AttractionLaw::coefficient; }},
      {"foam.walls.contact_angle", [](Scene& s) { s.foam.walls.contactAngle = 30; }, "foam.attraction_law",
       [](Scene& s) { s.foam.attractionLaw = AttractionLaw::capillary; }},
      {"solid.0.adhesion", [](Scene& s) { s.solids[0].surface.adhesion = 1; }, "solid.0.detach_radius",
       [](Scene& s) { s.solids[0].surface.detachRadius = 1e-3; }},
      {"solid.0.contact_angle", [](Scene& s) { s.solids[0].surface.contactAngle = 30; },
       "foam.attraction_law", [](Scene& s) { s.foam.attractionLaw = AttractionLaw::capillary; }}};
  Scene plain = pouring();
  plain.foam.attractionLaw = AttractionLaw::none;
  plain.foam.walls = {};
  plain.solids = {test::solidOf("block", test::boxShape({0.02, 0.02, 0.02}, {0.05, 0.05, 0.05}))};
  for (const VainKey& vain : kKeys) {
    Scene scene = plain;
    EXPECT_FALSE(mentions(notesOn(scene), vain.key, "")) << vain.key;
    vain.set(scene);
    EXPECT_TRUE(mentions(notesOn(scene), vain.key, vain.blames)) << vain.key;
    vain.use(scene);
    EXPECT_FALSE(mentions(notesOn(scene), vain.key, "")) << vain.key;
  }
}

TEST(SceneLint, CrowdedBubblesAndManySitesAreNamed) {
  Scene scene = pouring();
  BubblesSpec one;
  one.bubble.position = {0.08, 0.02, 0.08};
  one.bubble.radius = 1e-3;
  scene.bubbles.assign(30, one);
  EXPECT_FALSE(mentions(lintScene(scene), "bubbles", "slow"));  // 30 x 4.19 mm^3 in 8 mm^3
  scene.bubbles.assign(50, one);
  EXPECT_TRUE(mentions(lintScene(scene), "bubbles", "slow"));
  scene.nucleation.resize(1);
  scene.nucleation[0].density = 1e8;
  EXPECT_TRUE(mentions(lintScene(scene), "nucleation 0", "1.28e+07 sites"));  // five walls of 0.0256 m^2
}

TEST(SceneLint, LargeBubblesThinJetsAndFastJetsAreFound) {
  Scene scene = pouring();
  scene.coupling.entrainment.maxRadius = 0.005;
  EXPECT_TRUE(mentions(lintScene(scene), "bubbles", "2 cells"));
  scene = pouring();
  scene.inflows[0].radius = 0.003;
  EXPECT_TRUE(mentions(lintScene(scene), "inflow 'jet'", "1.2 cells"));
  scene = pouring();
  scene.inflows[0].speed = 20;
  scene.time.minDt = 0.005;
  EXPECT_TRUE(mentions(lintScene(scene), "inflow 'jet'", "40 cells"));  // 20 m/s x 5 ms / 2.5 mm
}

TEST(SceneLint, OverfullAndEmptyDomainsAreFound) {
  Scene scene = pouring();
  scene.inflows[0].stop = 1e9;
  scene.time.frames = 3000;
  EXPECT_TRUE(mentions(lintScene(scene), "inflow", "run over"));
  scene.inflows.clear();
  scene.liquidBodies.clear();
  EXPECT_TRUE(mentions(lintScene(scene), "scene", "no liquid"));
}

TEST(SceneLint, ADomainWithoutAirIsFound) {
  Scene scene = pouring();
  scene.liquidBodies[0].shape.upper.setConstant(1);
  EXPECT_TRUE(mentions(lintScene(scene), "domain", "full of liquid"));
}

TEST(SceneVolumes, PouredVolumeIsTheIntegralOfTheFlux) {
  Scene scene = pouring();
  scene.inflows[0].speed.keys = {{1, 0}, {3, 1}};
  const double area = std::numbers::pi * 0.01 * 0.01;
  constexpr double kMidpointError = 1e-6;  // relative, of a thousand midpoints of a piecewise linear speed
  EXPECT_NEAR(pouredUntil(scene, 10), area * 1.5,
              kMidpointError * area);  // a ramp of 2 s, then 0.5 s at 1 m/s
  EXPECT_EQ(pouredUntil(scene, 0), 0);
}

TEST(SceneVolumes, WetShareOfAQuarterFullBoxIsAQuarter) {
  EXPECT_EQ(initialWetShare(pouring()), 0.25);  // 4 cm of 16 cm: eight of 32 layers of points
}

TEST(SceneVolumes, WetShareOfAPoolAtRestIsThatUnderItsLevel) {
  Scene scene = pouring();
  scene.stillPool.enabled = true;
  scene.stillPool.level = 0.08;
  EXPECT_EQ(initialWetShare(scene), 0.5);
}

TEST(CostEstimate, GrowsWithTheScene) {
  const Scene scene = pouring();
  Scene finer = scene, longer = scene;
  finer.domain.resolution = 128;
  longer.time.frames *= 2;
  const CostEstimate cost = estimateCost(scene), fine = estimateCost(finer), longRun = estimateCost(longer);
  EXPECT_EQ(cost.cells, 64 * 64 * 64);
  EXPECT_EQ(fine.cells, 8 * cost.cells);
  EXPECT_GT(fine.secondsPerFrame, 8 * cost.secondsPerFrame);  // more cells, and more sub-steps
  EXPECT_GT(fine.memoryBytes, cost.memoryBytes);
  EXPECT_NEAR(longRun.diskBytes / cost.diskBytes, 2, 0.01);  // the pour has stopped by then
}

}  // namespace
}  // namespace spume::coupling
