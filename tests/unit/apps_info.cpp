// What `spume info` says of caches, whatever they are called.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "coupling/bubble_cache.h"
#include "coupling/drop_cache.h"
#include "coupling/film_cache.h"
#include "tests/support/apps_program.h"

namespace spume::apps::test {
namespace {

namespace fs = std::filesystem;
using coupling::FrameStamp;

const FrameStamp kStamp{7, 0.25, 28};

/// Two under water, one at the surface, none in the air.
foam::BubbleStore threeBubbles() {
  foam::BubbleStore bubbles;
  for (const double r : {1e-3, 2e-3, 4e-3}) bubbles.add({.position = {0.01, r, 0.02}, .radius = r});
  bubbles.type[2] = foam::BubbleClass::surface;
  return bubbles;
}

/// Of 1 and 3 mm^3.
std::vector<fluid::Drop> twoDrops() {
  return {{{0.01, 0.02, 0.03}, {0, 1, 0}, 1e-9, 4}, {{0.02, 0.02, 0.03}, {0, 1, 0}, 3e-9, 5}};
}

template <typename Value>
void put(std::string& out, Value value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A square of 2 mm, of two triangles; each is a film of bubble 1.
std::string twoFilms() {
  std::string ply =
      "ply\nformat binary_little_endian 1.0\ncomment frame 7\ncomment time 0.25\ncomment fps 28\n"
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
      "property list uchar int vertex_indices\nproperty double id_a\nproperty double id_b\n"
      "property float curvature\nend_header\n";
  for (const auto& [x, z] : {std::pair{0.f, 0.f}, {2e-3f, 0.f}, {2e-3f, 2e-3f}, {0.f, 2e-3f}})
    put(ply, x), put(ply, 0.5f), put(ply, z);
  for (const std::int32_t corner : {1, 2}) {
    put(ply, std::uint8_t{3});
    for (const std::int32_t vertex : {0, corner, corner + 1}) put(ply, vertex);
    put(ply, 1.0), put(ply, 1.0 + corner), put(ply, 0.0f);
  }
  return ply;
}

/// The value that `spume info` gives a key.
std::string valueOf(const Outcome& outcome, const std::string& key) {
  std::istringstream lines(outcome.output);
  std::string name, value;
  for (std::string line; std::getline(lines, line);)
    if (std::istringstream(line) >> name >> value && name == key) return value;
  return "";
}

void expectStamp(const Outcome& outcome) {
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_EQ(valueOf(outcome, "frame"), "7") << outcome.output;
  EXPECT_EQ(valueOf(outcome, "time"), "0.25");
  EXPECT_EQ(valueOf(outcome, "fps"), "28");
}

TEST(Info, TellsCachesApartByTheirContents) {
  constexpr double kVoxel = 0.002;
  const Scratch scratch;
  coupling::writeBubblesVdb(scratch / "a.vdb", threeBubbles(), kStamp, kVoxel);
  coupling::writeBubblesPly(scratch / "a.ply", threeBubbles(), kStamp);
  coupling::writeDropsVdb(scratch / "bubbles.0001.vdb", twoDrops(), kStamp, kVoxel);
  coupling::writeDropsPly(scratch / "bubbles.0001.ply", twoDrops(), kStamp);
  scratch.write("liquid.ply", twoFilms());
  for (const std::string name : {"a.vdb", "a.ply"}) {
    const Outcome bubbles = runSpume("info " + (scratch / name));
    expectStamp(bubbles);
    EXPECT_EQ(valueOf(bubbles, "bubbles"), "3");
    EXPECT_EQ(valueOf(bubbles, "bubbles_liquid"), "2");
    EXPECT_EQ(valueOf(bubbles, "bubbles_surface"), "1");
    EXPECT_NEAR(std::stod(valueOf(bubbles, "radius_max")), 4e-3, 1e-9);
  }
  for (const std::string name : {"bubbles.0001.vdb", "bubbles.0001.ply"}) {
    const Outcome drops = runSpume("info " + (scratch / name));
    expectStamp(drops);
    EXPECT_EQ(valueOf(drops, "drops"), "2");
    EXPECT_NEAR(std::stod(valueOf(drops, "drop_volume")), 4e-9, 1e-15);
    EXPECT_NEAR(std::stod(valueOf(drops, "drop_radius_min")), std::cbrt(0.75e-9 / M_PI), 1e-9);
  }
  const Outcome films = runSpume("info " + (scratch / "liquid.ply"));
  expectStamp(films);
  EXPECT_EQ(valueOf(films, "films"), "2");
  EXPECT_EQ(valueOf(films, "triangles"), "2");
  EXPECT_EQ(valueOf(films, "vertices"), "4");
  EXPECT_NEAR(std::stod(valueOf(films, "film_area")), 4e-6, 1e-12);
}

TEST(Info, RefusesWhatIsNoneOfThem) {
  const Scratch scratch;
  expectRefused(runSpume("info " + scratch.write("a.ply",
                                                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                                 "end_header\n1\n")),
                2, "holds x; expected the bubbles, drops or films");
  expectRefused(runSpume("info " + scratch.write("b.ply", twoFilms().substr(0, twoFilms().size() - 1))), 2,
                "cut off");
}

TEST(Info, OfAFolderCountsFromTheFilesThatAreThere) {
  const Scratch scratch;
  for (const char* folder : {"bubbles", "drops", "checkpoint"}) fs::create_directory(scratch / folder);
  coupling::writeBubblesPly(scratch / "bubbles/bubbles.0007.ply", threeBubbles(), kStamp);
  coupling::writeDropsPly(scratch / "drops/drops.0007.ply", twoDrops(), kStamp);
  scratch.write("checkpoint/checkpoint.000005.bin", std::string(1000, 'x'));
  const Outcome info = runSpume("info " + (scratch / "."));
  expectStamp(info);
  EXPECT_EQ(valueOf(info, "bubble_frames"), "7-7");
  EXPECT_EQ(valueOf(info, "drop_frames"), "7-7");
  EXPECT_EQ(valueOf(info, "checkpoints"), "5");
  EXPECT_EQ(valueOf(info, "bubbles"), "3");
  EXPECT_EQ(valueOf(info, "drops"), "2");
  const auto bytes = 1000 + fs::file_size(scratch / "bubbles/bubbles.0007.ply") +
                     fs::file_size(scratch / "drops/drops.0007.ply");
  EXPECT_EQ(valueOf(info, "bytes"), std::to_string(bytes));
}

}  // namespace
}  // namespace spume::apps::test
