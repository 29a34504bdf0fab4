#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "coupling/first_bubbles.h"
#include "coupling/foam_objects.h"
#include "coupling/nearest_key.h"
#include "coupling/scene_keys.h"
#include "coupling/scene_toml.h"
#include "coupling/toml_slot.h"
#include "foam/presets.h"
#include "tests/support/temporary_path.h"

namespace spume::coupling {
namespace {

Scene readText(const std::string& text, const Overrides& overrides = {}) {
  const std::string path = temporaryPath("good_scene.toml");
  std::ofstream(path) << text;
  const Scene scene = readScene(path, overrides);
  std::remove(path.c_str());
  return scene;
}

const std::string kDomain = "[domain]\nsize = [1, 1, 1]\n";

/// Every value different from its default, so that a key which is not read or not written shows.
Scene unusualScene() {
  Scene scene = readText(kDomain);
  for (const KeyTable& table : sceneTables()) {
    if (table.isArray()) table.resize(scene, table.path == "bubbles" ? 0 : 1);
    for (const KeyRow& row : table.keys) {
      if (table.isArray() && !table.count(scene)) continue;
      const Slot slot = row.slot(scene, 0);
      const double between = row.range.least + 0.123456789012345678 * (row.range.most - row.range.least);
      if (auto* value = std::get_if<double*>(&slot)) **value = between;
      if (auto* value = std::get_if<int*>(&slot)) **value = static_cast<int>(between);
      if (auto* value = std::get_if<bool*>(&slot)) **value = !**value;
      if (auto* value = std::get_if<Animated*>(&slot)) (*value)->keys = {{0.1, 1.0 / 3}, {0.7, between}};
      if (auto* value = std::get_if<AnimatedVector*>(&slot))
        (*value)->keys = {{0.1, {1.0 / 3, 0, 1}}, {0.7, {between, between, 1.0 / 7}}};
    }
  }
  return scene;
}

TEST(SceneToml, MinimalSceneTakesAllDefaults) {
  const Scene scene = readText(kDomain);
  EXPECT_EQ(scene.name, "good_scene");
  EXPECT_EQ(scene.domain.resolution, DomainSpec().resolution);
  EXPECT_EQ(scene.time.frames, TimeSpec().frames);
  EXPECT_EQ(scene.foam.wetness, foam::makePreset(scene.preset).wetness);
  EXPECT_TRUE(scene.inflows.empty());
}

TEST(SceneToml, ValuesReachTheirFields) {
  const Scene scene =
      readText("[scene]\nname = 'pour'\nseed = 7\ngravity = [0, -1.5, 0]\n" + kDomain +
               "walls = ['+y']\n[liquid]\ndensity = 900\n[foam]\npreset = 'paper'\nwetness = 0.25\n"
               "[[inflow]]\ndirection = [1, 0, 0]\ncentre = [0.5, 0.5, 0.5]\nradius = 0.1\nspeed = { keys = "
               "[[1, 2], [3, 4]] }\n"
               "[[solid]]\nshape = 'cylinder'\nradius = 0.25\nheight = 1\n");
  EXPECT_EQ(scene.name, "pour");
  EXPECT_EQ(scene.domain.closed, (std::array<bool, 6>{false, false, false, true, false, false}));
  EXPECT_EQ(scene.preset, foam::Preset::paper);
  EXPECT_EQ(scene.foam.wetness, 0.25);
  EXPECT_EQ(scene.inflows.at(0).speed.keys, (std::vector<std::pair<double, double>>{{1, 2}, {3, 4}}));
  EXPECT_EQ(scene.solids.at(0).shape.kind, ShapeKind::cylinder);
  EXPECT_EQ(scene.solids.at(0).shape.radius, 0.25);
}

TEST(SceneToml, SharedValuesReachBothModules) {
  const Scene scene =
      readText("[scene]\nseed = 7\ngravity = [0, -1.5, 0]\n" + kDomain + "[liquid]\ndensity = 900\n");
  EXPECT_EQ(scene.liquid.seed, 7u);
  EXPECT_EQ(scene.foam.seed, 7u);
  EXPECT_EQ(scene.foam.gravity, Eigen::Vector3d(0, -1.5, 0));
  EXPECT_EQ(scene.foam.density, 900);
}

TEST(SceneToml, PresetIsOverriddenByKeysWhateverTheirOrder) {
  const foam::FoamParams physical = foam::makePreset(foam::Preset::physical);
  const Scene scene = readText(kDomain + "[foam]\nwetness = 0.75\npreset = 'physical'\n");
  EXPECT_EQ(scene.foam.wetness, 0.75);
  EXPECT_EQ(scene.foam.springFromSurfaceTension, physical.springFromSurfaceTension);
}

TEST(SceneToml, SolidsAndWallsSayHowBubblesTakeToThem) {
  const Scene scene =
      readText(kDomain +
               "[foam]\npreset = 'paper'\nattraction_law = 'capillary'\nweak_pairs = false\n"
               "[foam.walls]\ndetach_radius = 1e-3\ncontact_angle = 70\n"
               "[[solid]]\nshape = 'sphere'\nradius = 0.1\nadhesion = 0.2\nattraction = 3e-7\n");
  const foam::FoamParams params = foamParamsOf(scene);
  EXPECT_EQ(params.attractionLaw, foam::AttractionLaw::capillary);
  EXPECT_FALSE(params.weakPairs);
  EXPECT_EQ(params.walls.detachRadius, 1e-3);
  EXPECT_EQ(params.walls.contactAngle, 70);
  ASSERT_EQ(params.solids.size(), 1u);
  EXPECT_EQ(params.surfaceOf(0).adhesion, 0.2);
  EXPECT_EQ(params.surfaceOf(0).attraction, 3e-7);
  EXPECT_EQ(params.surfaceOf(0).detachRadius, 0);
}

TEST(SceneToml, BubblesMayHaveTheirOwnWetness) {
  const std::string bubble = "[[bubbles]]\nposition = [0.5, 0.5, 0.5]\nradius = 1e-3\n";
  const std::string law = "[foam]\nwetness_law = 'per_bubble'\nwetness = 0.3\n";
  const Scene scene = readText(kDomain + law + bubble + "wetness = 0.7\n" + bubble);
  const foam::BubbleStore bubbles = initialBubbles(scene);
  EXPECT_EQ(bubbles.wetness, (std::vector<double>{0.7, 0.3}));
}

TEST(SceneToml, BubblesOfAFileComeWithTheirVelocities) {
  const std::string path = temporaryPath("bubbles.csv");
  std::ofstream(path) << "id,x,y,z,r,vx,vy,vz\r\n7,0.1,0.2,0.3,1e-3,1,2,3\r\n3,0.4,0.5,0.6,2e-3,0,0,0\r\n";
  const Scene scene = readText(kDomain + "[[bubbles]]\nfile = 'bubbles.csv'\n");
  EXPECT_EQ(scene.bubbles.at(0).file, path);
  const foam::BubbleStore bubbles = initialBubbles(scene);
  ASSERT_EQ(bubbles.size(), 2u);
  EXPECT_EQ(bubbles.id, (std::vector<std::uint64_t>{3, 7}));
  EXPECT_EQ(bubbles.position[1], Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(bubbles.velocity[1], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(bubbles.radius[0], 2e-3);
  EXPECT_EQ(writeScene(readText(writeScene(scene))), writeScene(scene));
  std::remove(path.c_str());
}

TEST(SceneToml, WrittenSceneReadsBackToTheSameBits) {
  Scene scene = unusualScene();
  scene.title = "quotes \" and \\ and\ttabs";
  scene.domain.lower = {-3, -3, -3};
  scene.domain.size = {6.5, 6.25, 6};
  scene.domain.resolution = 37;
  scene.time.minDt = 0.1 + 0.2;
  scene.time.maxDt = 0.7;
  scene.coupling.entrainment.minRadius = 1e-3 / 3;
  scene.coupling.entrainment.medianRadius = 2e-3 / 3;
  scene.coupling.entrainment.maxRadius = 4e-3 / 3;
  scene.solids[0].shape = {ShapeKind::box, {-1, -1, -1}, {1. / 3, 1, 1}, {0, 0, 0}, {0, 1, 0}, 0, 0};
  scene.liquidBodies[0].shape = {ShapeKind::box, {-1, -1, -1}, {1. / 7, 1, 1}, {0, 0, 0}, {0, 1, 0}, 0, 0};
  scene.outflows[0].shape = {ShapeKind::sphere, {0, 0, 0}, {0, 0, 0}, {1, 1, 1}, {0, 1, 0}, 1. / 3, 0};
  scene.outflows[0].mode = DrainMode::rate;
  scene.outflows[0].start = 0.125;
  scene.probes[0] = {"depth", ProbeKind::height, {1. / 3, 1, 1}, {}};
  scene.inflows[0] = {"jet", {2, 2, 2}, {0, 0.1, 0.3}, 0.3, scene.inflows[0].speed, 0.1, 1. / 3, 2};
  scene.liquid.markerRadiusMin = 0.2;
  scene.bubbles = {{"", {{0.1, 2, 2.5}, {1. / 3, 0, 0}, 1e-3 / 7, {}}}};
  scene.bubbleSources[0].shape = scene.solids[0].shape;
  scene.bubbleSources[0].shape.upper.x() = 2. / 3;
  scene.bubbleKills[0].shape = scene.bubbleSources[0].shape;
  scene.stillPool.enabled = false;
  const std::string text = writeScene(scene);
  EXPECT_EQ(writeScene(readText(text)), text);
}

TEST(SceneToml, ExactTextReadsBackToTheSameDouble) {
  for (const double value : {0.1, 1.0 / 3, 1e-300, 123456789.123456789, -2.5e17, 5e-324})
    EXPECT_EQ(std::strtod(exactText(value).c_str(), nullptr), value);
}

TEST(SceneToml, ShippedScenesReadAndRoundTrip) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SPUME_SOURCE_DIR "/data/scenes")) {
    const std::string text = writeScene(readScene(entry.path().string()));
    EXPECT_EQ(writeScene(readText(text)), text) << entry.path();
    ++scenes;
  }
  EXPECT_GT(scenes, 0);
}

TEST(SceneToml, OverridesActAsIfWrittenInTheFile) {
  const std::string text = kDomain + "[[inflow]]\ncentre = [0.5, 0.5, 0.5]\nradius = 0.1\n";
  const Scene scene = readText(text, {{"inflow.0.speed", "2.5"},
                                      {"scene.name", "bare_word"},
                                      {"domain.size", "[2, 1, 1]"},
                                      {"coupling.entrainment.onset", "0.75"}});
  EXPECT_EQ(scene.inflows.at(0).speed.at(0), 2.5);
  EXPECT_EQ(scene.name, "bare_word");
  EXPECT_EQ(scene.domain.size.x(), 2);
  EXPECT_EQ(scene.coupling.entrainment.onset, 0.75);
}

TEST(SceneToml, EveryKeyIsDocumented) {
  const std::string text = describeSceneKeys();
  for (const KeyTable& table : sceneTables()) {
    EXPECT_NE(text.find("[" + table.path + "]"), std::string::npos) << table.path;
    for (const KeyRow& row : table.keys) {
      EXPECT_NE(text.find("  " + row.name + ": "), std::string::npos) << table.path << "." << row.name;
      EXPECT_FALSE(row.meaning.empty()) << table.path << "." << row.name;
    }
  }
}

TEST(SceneToml, DocumentedDefaultsOfTheFoamAreThoseOfItsPresets) {
  const std::string text = describeSceneKeys();
  EXPECT_NE(text.find("spring_from_surface_tension: true or false, default true (preset paper: false)"),
            std::string::npos);
  EXPECT_NE(text.find("default \"pressure_gradient\" (preset paper: \"hydrostatic\")"), std::string::npos);
}

TEST(Animated, IsLinearBetweenKeysAndHeldBeyond) {
  Animated animated;
  animated.keys = {{1, 10}, {3, 20}, {4, 0}};
  EXPECT_EQ(animated.at(0), 10);
  EXPECT_EQ(animated.at(1), 10);
  EXPECT_EQ(animated.at(2), 15);
  EXPECT_EQ(animated.at(3.75), 5);
  EXPECT_EQ(animated.at(9), 0);
  EXPECT_EQ(animated.largest(), 20);
  EXPECT_DOUBLE_EQ(animated.integral(0, 9), 10 + 30 + 10 + 0);
  EXPECT_DOUBLE_EQ(animated.integral(2, 3.5), 17.5 + 7.5);
  EXPECT_DOUBLE_EQ(Animated(3).integral(-1, 4), 15);
}

TEST(NearestKey, EditDistanceCountsChangesAndSwaps) {
  EXPECT_EQ(editDistance("size", "size"), 0);
  EXPECT_EQ(editDistance("size", "siez"), 1);
  EXPECT_EQ(editDistance("", "abc"), 3);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3);
  EXPECT_EQ(nearestOf("resolutoin", {"fps", "resolution", "radius"}), "resolution");
  EXPECT_EQ(nearestOf("x", {}), "");
}

}  // namespace
}  // namespace spume::coupling
