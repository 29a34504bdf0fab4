#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>

#include "coupling/atomic_file.h"
#include "coupling/bubble_cache.h"
#include "coupling/drop_cache.h"
#include "coupling/film_cache.h"
#include "coupling/liquid_cache.h"
#include "fluid/parallel.h"
#include "tests/support/temporary_path.h"

namespace spume::coupling {
namespace {

constexpr FrameStamp kStamp{17, 0.5666, 30};
constexpr double kVoxel = 2.5e-3;

std::string fileIn(const std::string& name) { return temporaryPath(name); }

foam::BubbleStore someBubbles(int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  foam::BubbleStore bubbles;
  for (int n = 0; n < count; ++n) {
    bubbles.add({{0.16 * unit(random), 0.16 * unit(random), 0.16 * unit(random)},
                 {unit(random), -unit(random), 0},
                 1e-3 * (0.5 + unit(random)),
                 static_cast<foam::BubbleClass>(n % 3)});
    bubbles.age.back() = unit(random);
    bubbles.wetness.back() = unit(random);
    bubbles.hidden.back() = n % 7 == 0, bubbles.clamped.back() = n % 3 == 0;
  }
  std::vector<std::uint8_t> gone(count, 0);  // so that ids have gaps
  for (int n = 0; n < count; n += 5) gone[n] = 1;
  bubbles.remove(gone);
  return bubbles;
}

void expectSameBubbles(const foam::BubbleStore& read, const foam::BubbleStore& written, double placeError) {
  ASSERT_EQ(read.id, written.id);
  EXPECT_EQ(read.type, written.type);
  EXPECT_EQ(read.hidden, written.hidden);
  EXPECT_EQ(read.clamped, written.clamped);
  for (std::size_t n = 0; n < read.size(); ++n) {
    EXPECT_LE((read.position[n] - written.position[n]).cwiseAbs().maxCoeff(), placeError);
    EXPECT_EQ(read.velocity[n].cast<float>(), written.velocity[n].cast<float>());
    EXPECT_EQ(static_cast<float>(read.radius[n]), static_cast<float>(written.radius[n]));
    EXPECT_EQ(static_cast<float>(read.gas[n]), static_cast<float>(written.gas[n]));
    EXPECT_EQ(static_cast<float>(read.age[n]), static_cast<float>(written.age[n]));
    EXPECT_EQ(static_cast<float>(read.wetness[n]), static_cast<float>(written.wetness[n]));
  }
}

void expectSameStamp(const FrameStamp& stamp) {
  EXPECT_EQ(stamp.frame, kStamp.frame);
  EXPECT_EQ(stamp.time, kStamp.time);
  EXPECT_EQ(stamp.fps, kStamp.fps);
}

TEST(BubbleCache, VdbPointsReadBackByIdToFloatPrecision) {
  constexpr double kOffsetError =
      0.5 * kVoxel * 6e-8;  // half a float ulp of an offset of at most half a voxel
  const foam::BubbleStore bubbles = someBubbles(1000);
  const std::string path = fileIn("bubbles.0017.vdb");
  writeBubblesVdb(path, bubbles, kStamp, kVoxel);
  const BubbleFrame frame = readBubblesVdb(path);
  expectSameBubbles(frame.bubbles, bubbles, kOffsetError);
  expectSameStamp(frame.stamp);
  std::remove(path.c_str());
}

TEST(BubbleCache, PlyReadsBackByIdToFloatPrecision) {
  constexpr double kFloatError = 0.16 * 6e-8;  // half an ulp of a place in a box of 0.16 m
  const foam::BubbleStore bubbles = someBubbles(1000);
  const std::string path = fileIn("bubbles.0017.ply");
  writeBubblesPly(path, bubbles, kStamp);
  const BubbleFrame frame = readBubblesPly(path);
  expectSameBubbles(frame.bubbles, bubbles, kFloatError);
  expectSameStamp(frame.stamp);
  std::remove(path.c_str());
}

TEST(BubbleCache, NoBubblesMakeFilesToo) {
  const std::string vdb = fileIn("none.vdb"), ply = fileIn("none.ply");
  writeBubblesVdb(vdb, {}, kStamp, kVoxel);
  writeBubblesPly(ply, {}, kStamp);
  EXPECT_EQ(readBubblesVdb(vdb).bubbles.size(), 0u);
  EXPECT_EQ(readBubblesPly(ply).bubbles.size(), 0u);
  std::remove(vdb.c_str());
  std::remove(ply.c_str());
}

/// The same file without its last property, as earlier versions wrote it.
TEST(BubbleCache, PlyWithoutFlagsIsReadAndNoneIsSet) {
  foam::BubbleStore bubbles = someBubbles(3);
  const std::string path = fileIn("older.ply"), property = "property int flags\n", end = "end_header\n";
  writeBubblesPly(path, bubbles, kStamp);
  std::string bytes = readFile(path);
  bytes.erase(bytes.find(property), property.size());
  const std::size_t body = bytes.find(end) + end.size(), record = (bytes.size() - body) / bubbles.size();
  for (std::size_t n = bubbles.size(); n-- > 0;) bytes.erase(body + (n + 1) * record - 4, 4);
  replaceFile(path, bytes);
  bubbles.hidden.assign(bubbles.size(), 0), bubbles.clamped.assign(bubbles.size(), 0);
  expectSameBubbles(readBubblesPly(path).bubbles, bubbles, 0.16 * 6e-8);
  bytes.replace(bytes.find("property int type"), 17, "property int kind");
  replaceFile(path, bytes);
  EXPECT_THROW(readBubblesPly(path), SceneError);
  std::remove(path.c_str());
}

TEST(BubbleCache, UnknownFlagsAreRefused) {
  const std::string path = fileIn("flags.ply");
  writeBubblesPly(path, someBubbles(3), kStamp);
  std::string bytes = readFile(path);
  bytes[bytes.size() - 4] = 4;
  replaceFile(path, bytes);
  EXPECT_THROW(readBubblesPly(path), SceneError);
  std::remove(path.c_str());
}

TEST(BubbleCache, CutOffPlyIsRefusedWithItsPath) {
  const std::string path = fileIn("cut.ply");
  writeBubblesPly(path, someBubbles(10), kStamp);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  try {
    readBubblesPly(path);
    FAIL() << "a cut file was read";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
  }
  std::remove(path.c_str());
}

TEST(DropCache, VdbAndPlyReadBackByIdToFloatPrecision) {
  constexpr double kFloatError = 6e-8;  // half an ulp, relative
  std::vector<fluid::Drop> drops;
  for (std::uint64_t n = 0; n < 100; ++n)
    drops.push_back({{0.001 * n, 0.16 - 0.0007 * n, 0.05}, {0.1 * n, -3, 1}, 1e-9 * (n + 1), 3 * n});
  const std::string vdb = fileIn("drops.vdb"), ply = fileIn("drops.ply");
  writeDropsVdb(vdb, drops, kStamp, kVoxel);
  writeDropsPly(ply, drops, kStamp);
  for (const std::vector<fluid::Drop>& read : {readDropsVdb(vdb), readDropsPly(ply)}) {
    ASSERT_EQ(read.size(), drops.size());
    for (std::size_t n = 0; n < drops.size(); ++n) {
      EXPECT_EQ(read[n].id, drops[n].id);
      EXPECT_LE((read[n].position - drops[n].position).cwiseAbs().maxCoeff(), kFloatError * 0.16);
      EXPECT_LE((read[n].velocity - drops[n].velocity).cwiseAbs().maxCoeff(), kFloatError * 10);
      EXPECT_NEAR(read[n].volume, drops[n].volume, kFloatError * drops[n].volume);
    }
  }
  std::filesystem::resize_file(ply, std::filesystem::file_size(ply) - 1);
  EXPECT_THROW(readDropsPly(ply), SceneError);
  std::remove(vdb.c_str());
  std::remove(ply.c_str());
}

fluid::LiquidState pool() {
  fluid::LiquidState liquid;
  liquid.grid = {{16, 12, 10}, kVoxel, {0, 0, 0}};
  liquid.phi = fluid::DenseField<float>(liquid.grid.cells);
  liquid.velocity = fluid::MacVelocity(liquid.grid.cells, 0.25f);
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 12; ++j)
      for (int k = 0; k < 10; ++k)
        liquid.phi(i, j, k) = static_cast<float>(liquid.grid.cellCentre(i, j, k).y() - 5.3 * kVoxel);
  return liquid;
}

/// The bytes of a file after its PLY header, and the lines of that.
struct PlyFile {
  std::string header, body;
  explicit PlyFile(const std::string& path) {
    const std::string all = readFile(path), end = "end_header\n";
    const std::size_t at = all.find(end) + end.size();
    header = all.substr(0, at), body = all.substr(at);
  }
  template <typename Value>
  Value at(std::size_t offset) const {
    Value value;
    std::memcpy(&value, body.data() + offset, sizeof value);
    return value;
  }
};

TEST(FilmCache, PlyHoldsTheMeshWithTheIdsAndTheCurvatureOfEveryFilm) {
  const std::string path = fileIn("films.ply");
  foam::BubbleStore bubbles;
  const Eigen::Vector3d centre[] = {{0, 0, 0}, {1.5, 0, 0}, {0.75, 1.3, 0}, {0.75, 0.43, 1.22}};
  for (const Eigen::Vector3d& x : centre) bubbles.add({.position = x, .radius = 1});
  for (std::uint64_t& id : bubbles.id) id += 40;
  foam::SoapFilms films = foam::soapFilms(bubbles);
  films.report.pressure = {3, 1, 1, 1};
  writeFilmsPly(path, films, bubbles.id, {7, 0.5, 30});

  const PlyFile ply(path);
  EXPECT_NE(ply.header.find("comment frame 7\n"), std::string::npos);
  const std::size_t nodes = films.network.nodes.size(), faces = films.network.triangles.size();
  EXPECT_NE(ply.header.find("element vertex " + std::to_string(nodes) + "\n"), std::string::npos);
  EXPECT_NE(ply.header.find("element face " + std::to_string(faces) + "\n"), std::string::npos);
  constexpr std::size_t kNode = 3 * sizeof(float), kFace = 1 + 3 * 4 + 2 * 8 + 4;
  ASSERT_EQ(ply.body.size(), nodes * kNode + faces * kFace);
  std::map<std::pair<int, int>, float> curvature;
  for (std::size_t f = 0; f < faces; ++f) {
    const std::size_t face = nodes * kNode + f * kFace;
    ASSERT_EQ(ply.at<std::uint8_t>(face), 3);
    std::array<Eigen::Vector3d, 3> corner;
    for (int c = 0; c < 3; ++c) {
      const auto node = static_cast<std::size_t>(ply.at<std::int32_t>(face + 1 + 4 * c));
      ASSERT_LT(node, nodes);
      for (int a = 0; a < 3; ++a) corner[c][a] = ply.at<float>(node * kNode + sizeof(float) * a);
    }
    const int a = static_cast<int>(ply.at<double>(face + 13)),
              b = static_cast<int>(ply.at<double>(face + 21));
    const Eigen::Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    EXPECT_GT(normal.dot(bubbles.position[b - 40] - bubbles.position[a - 40]), 0);
    curvature[{a, b}] = ply.at<float>(face + 29);
  }
  ASSERT_EQ(curvature.size(), 6u);
  EXPECT_EQ((curvature[{40, 42}]), 1);
  EXPECT_EQ((curvature[{41, 43}]), 0);
}

TEST(LiquidCache, FrameReadsBack) {
  const fluid::LiquidState liquid = pool();
  fluid::SolidBoundary solids;
  solids.psi = fluid::DenseField<float>(liquid.grid.cells, 0.125f);
  const std::string path = fileIn("liquid.0017.vdb");
  writeLiquidFrame(path, liquid, solids, kStamp, {true, true});
  const LiquidFrame frame = readLiquidFrame(path);
  expectSameStamp(frame.stamp);
  EXPECT_TRUE(frame.hasSolid);
  EXPECT_EQ(frame.liquid.grid.cells, liquid.grid.cells);
  EXPECT_EQ(frame.psi(3, 4, 5), 0.125f);
  EXPECT_EQ(frame.liquid.phi(8, 5, 5), liquid.phi(8, 5, 5));
  EXPECT_EQ(frame.liquid.velocity[1](8, 5, 5), 0.25f);
  std::remove(path.c_str());
}

std::string bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(LiquidCache, TheSameFrameMakesTheSameBytesAndAnotherDoesNot) {
  fluid::LiquidState liquid = pool();
  fluid::SolidBoundary solids;
  solids.psi = fluid::DenseField<float>(liquid.grid.cells, 0.125f);
  const std::string a = fileIn("same_a.vdb"), b = fileIn("same_b.vdb"), c = fileIn("other.vdb");
  writeLiquidFrame(a, liquid, solids, kStamp, {});
  writeLiquidFrame(b, liquid, solids, kStamp, {});
  liquid.velocity[1](8, 5, 5) = 0.5f;
  writeLiquidFrame(c, liquid, solids, kStamp, {});
  EXPECT_FALSE(bytesOf(a).empty());
  EXPECT_EQ(bytesOf(a), bytesOf(b));
  constexpr std::size_t kIdentity = 21, kLength = 36;  // where OpenVDB keeps the identity of a file
  EXPECT_NE(bytesOf(a).substr(kIdentity, kLength), bytesOf(c).substr(kIdentity, kLength));
  for (const std::string& path : {a, b, c}) std::remove(path.c_str());
}

TEST(LiquidCache, LiquidBehindAThinWallStaysThere) {
  fluid::LiquidState liquid = pool();
  liquid.grid.cells = {32, 32, 16};
  liquid.phi = fluid::DenseField<float>(liquid.grid.cells);
  liquid.velocity = fluid::MacVelocity(liquid.grid.cells, 0.0f);
  fluid::SolidBoundary solids;
  solids.psi = fluid::DenseField<float>(liquid.grid.cells);
  constexpr double kMiddle = 12, kHalf = 1;  // of a wall two cells thick, in the middle of an 8-cell leaf
  fluid::forEachCell(liquid.grid.cells, [&](int i, int j, int k) {
    solids.psi(i, j, k) = static_cast<float>((std::abs(i + 0.5 - kMiddle) - kHalf) * kVoxel);
    liquid.phi(i, j, k) = static_cast<float>((i + 0.5 < kMiddle ? -10 : 10) * kVoxel);  // as it is continued
  });
  const std::string path = fileIn("thin.vdb");
  writeLiquidFrame(path, liquid, solids, kStamp, {});
  const fluid::DenseField<float> phi = readLiquidFrame(path).liquid.phi;
  std::remove(path.c_str());
  constexpr int kInner = 4;  // away from the walls of the domain, where the surface is closed, too
  for (int i = kInner; i < 32 - kInner; ++i)
    if (std::abs(i + 0.5 - kMiddle) > kHalf) {
      EXPECT_EQ(phi(i, 16, 8) < 0, i + 0.5 < kMiddle) << i;
    }
}

TEST(LiquidCache, WithoutSolidPsiIsTheDistanceToTheBox) {
  const std::string path = fileIn("liquid_only.vdb");
  writeLiquidFrame(path, pool(), {}, kStamp, {false, false});
  const LiquidFrame frame = readLiquidFrame(path);
  EXPECT_FALSE(frame.hasSolid);
  EXPECT_FLOAT_EQ(frame.psi(0, 5, 5), 0.5f * static_cast<float>(kVoxel));
  EXPECT_FLOAT_EQ(frame.psi(8, 5, 5), 4.5f * static_cast<float>(kVoxel));
  std::remove(path.c_str());
}

TEST(LiquidCache, OtherFilesAreRefusedWithTheirPath) {
  const std::string path = fileIn("no.vdb");
  replaceFile(path, "this is no VDB file");
  EXPECT_THROW(readLiquidFrame(path), FileError);
  EXPECT_THROW(readLiquidFrame("/no/such.vdb"), FileError);
  writeBubblesVdb(path, someBubbles(3), kStamp, kVoxel);
  EXPECT_THROW(readLiquidFrame(path), SceneError);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace spume::coupling
