#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "coupling/bubble_cache.h"
#include "coupling/bubble_table.h"

namespace spume::coupling {
namespace {

using Eigen::Vector3d;

const std::string kPlain = "id,x,y,z,r\n7,0.1,0.2,0.3,0.001\n3,-1,2e-3,0,1.5E-3\n";

void expectSame(const BubbleTable& a, const BubbleTable& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.wetness, b.wetness);
}

TEST(BubbleTable, CsvRowsKeepTheirOrder) {
  const BubbleTable bubbles = parseBubbleCsv("b.csv", kPlain);
  EXPECT_EQ(bubbles.id, (std::vector<std::uint64_t>{7, 3}));
  EXPECT_EQ(bubbles.position, (std::vector<Vector3d>{{.1, .2, .3}, {-1, 2e-3, 0}}));
  EXPECT_EQ(bubbles.radius, (std::vector<double>{.001, 1.5e-3}));
  EXPECT_EQ(bubbles.velocity, (std::vector<Vector3d>{Vector3d::Zero(), Vector3d::Zero()}));
}

TEST(BubbleTable, FormOfTheCsvDoesNotMatter) {
  const BubbleTable plain = parseBubbleCsv("b.csv", kPlain);
  const std::string forms[] = {
      "id,x,y,z,r\r\n7,0.1,0.2,0.3,0.001\r\n3,-1,2e-3,0,1.5E-3\r\n",
      "id,x,y,z,r\n7,0.1,0.2,0.3,0.001\n3,-1,2e-3,0,1.5E-3",
      "id,x,y,z,r\n7,0.1,0.2,0.3,0.001\n3,-1,2e-3,0,1.5E-3\n\n \t\r\n\n",
      "# made by hand\n\nid,x,y,z,r\n # first\n7,0.1,0.2,0.3,0.001\n\n3,-1,2e-3,0,1.5E-3\n",
      " id , x ,\ty, z , r\n 7 , 0.1 , 0.2 ,0.3\t, 0.001 \n3,-1,+2e-3,+0,.15E-2\n",
      "r,age,z,y,x,name,id\n0.001,5,0.3,0.2,0.1,big one,7\n1.5E-3,,0,2e-3,-1,,3\n",
      "\xef\xbb\xbf\"id\",\"x\",\"y\",\"z\",\"r\"\n7,0.1,0.2,0.3,0.001\n3.0,-1,2e-3,0,1.5E-3\n"};
  for (const std::string& form : forms) {
    SCOPED_TRACE(form);
    expectSame(parseBubbleCsv("b.csv", form), plain);
  }
}

TEST(BubbleTable, CsvVelocitiesAreRead) {
  const BubbleTable bubbles = parseBubbleCsv("b.csv", "vz,vy,vx,id,x,y,z,r\n3,2,1,0,0,0,0,1\n");
  EXPECT_EQ(bubbles.velocity, (std::vector<Vector3d>{{1, 2, 3}}));
}

TEST(BubbleTable, WetnessIsReadWhereItIsGiven) {
  EXPECT_TRUE(parseBubbleCsv("b.csv", kPlain).wetness.empty());
  EXPECT_EQ(parseBubbleCsv("b.csv", "id,x,wetness,y,z,r\n0,0,0.25,0,0,1\n1,0,1,0,0,1\n").wetness,
            (std::vector<double>{.25, 1}));
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "property float wetness\nproperty float radius\nend_header\n";
  EXPECT_EQ(parseBubblePly("b.ply", head + "0 0 0 0.25 1\n0 0 0 1 1\n").wetness,
            (std::vector<double>{.25, 1}));
}

TEST(BubbleTable, ColumnsThatAreNotReadAreNamed) {
  EXPECT_EQ(wordsOnUnread("b.csv", parseBubbleCsv("b.csv", kPlain)), "");
  EXPECT_EQ(wordsOnUnread("b.csv", parseBubbleCsv("b.csv", "id,x,lambda,y,z,r,\n0,0,0.5,0,0,1,\n")),
            "b.csv: column 'lambda' is not read; those that are: id, x, y, z, r, vx, vy, vz, wetness");
  EXPECT_EQ(wordsOnUnread("b.csv", parseBubbleCsv("b.csv", "age,id,x,y,z,r,type\n1,0,0,0,0,1,2\n"))
                .rfind("b.csv: columns 'age', 'type' are not read;", 0),
            0u);
}

TEST(BubbleTable, CsvNumbersAreExact) {
  const BubbleTable bubbles = parseBubbleCsv("b.csv",
                                             "id,x,y,z,r\n18446744073709551615,0.10000000000000001,4."
                                             "9406564584124654e-324,-0,1.0000000000000001e-3\n");
  EXPECT_EQ(bubbles.id[0], ~std::uint64_t{0});
  EXPECT_EQ(bubbles.position[0].x(), .1);
  EXPECT_EQ(bubbles.position[0].y(), std::numeric_limits<double>::denorm_min());
  EXPECT_TRUE(std::signbit(bubbles.position[0].z()));
  EXPECT_EQ(bubbles.radius[0], 1e-3);
}

std::string asciiPly(const std::string& radius) {
  return "ply\nformat ascii 1.0\ncomment a\nelement vertex 2\nproperty float x\nproperty double y\n"
         "property double z\nproperty double " +
         radius +
         "\nproperty uint id\nelement face 0\nproperty list uchar int i\nend_header\n"
         "0.1 0.2 0.3 0.001 7\n-1 2e-3 0 1.5E-3 3\n";
}

TEST(BubbleTable, AsciiPlyReadsLikeCsv) {
  for (const char* radius : {"radius", "pscale", "r"})
    expectSame(parseBubblePly("b.ply", asciiPly(radius)), parseBubbleCsv("b.csv", kPlain));
}

template <typename Value>
void append(std::string& bytes, Value value) {  // test machines are little endian
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

TEST(BubbleTable, BinaryPlyReadsEveryType) {
  std::string bytes =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 2\r\nproperty char x\r\nproperty ushort y\r\n"
      "property int32 z\r\nproperty float32 pscale\r\nproperty double id\r\nproperty short vx\r\n"
      "property uchar vy\r\nproperty uint vz\r\nend_header\r\n";
  for (int sign : {-1, 1}) {
    append(bytes, static_cast<std::int8_t>(100 * sign));
    append(bytes, static_cast<std::uint16_t>(60000 + sign));
    append(bytes, static_cast<std::int32_t>(2000000000 * sign));
    append(bytes, 1.5f + sign);
    append(bytes, 9007199254740990.0 + sign);
    append(bytes, static_cast<std::int16_t>(30000 * sign));
    append(bytes, static_cast<std::uint8_t>(200 + sign));
    append(bytes, static_cast<std::uint32_t>(4000000000u + sign));
  }
  const BubbleTable bubbles = parseBubblePly("b.ply", bytes);
  EXPECT_EQ(bubbles.id, (std::vector<std::uint64_t>{9007199254740989, 9007199254740991}));
  EXPECT_EQ(bubbles.position, (std::vector<Vector3d>{{-100, 59999, -2e9}, {100, 60001, 2e9}}));
  EXPECT_EQ(bubbles.radius, (std::vector<double>{.5, 2.5}));
  EXPECT_EQ(bubbles.velocity, (std::vector<Vector3d>{{-30000, 199, 3999999999.}, {30000, 201, 4000000001.}}));
}

TEST(BubbleTable, PlyWithoutIdsIsNumbered) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float radius\nend_header\n";
  EXPECT_EQ(parseBubblePly("b.ply", header + "0 0 0 1\n0 0 0 1\n0 0 0 1").id,
            (std::vector<std::uint64_t>{0, 1, 2}));
}

TEST(BubbleTable, PlyWithoutVerticesIsEmpty) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
      "property float z\nproperty float radius\nend_header\n";
  EXPECT_EQ(parseBubblePly("b.ply", header).size(), 0u);
}

/// Both caches of a run are read back; they hold float numbers, which those given here are exactly.
TEST(BubbleTable, CachesOfARunReadBack) {
  foam::BubbleStore bubbles;
  bubbles.add({{.5, .25, -.125}, {1, 2, 3}, .0625});
  bubbles.add({{1.5, 0, 2}, {0, -1, 0}, .5});
  bubbles.id = {5, 8};
  bubbles.wetness = {.25, 1};
  const std::string base = testing::TempDir() + "bubble_table_" + std::to_string(getpid());
  writeBubblesVdb(base + ".vdb", bubbles, {}, 1);
  writeBubblesPly(base + ".ply", bubbles, {});
  for (const std::string ending : {".vdb", ".ply"}) {
    SCOPED_TRACE(ending);
    BubbleTable same;
    same.id = bubbles.id, same.position = bubbles.position, same.radius = {.0625, .5};
    same.velocity = bubbles.velocity, same.wetness = bubbles.wetness;
    expectSame(readBubbleTable(base + ending), same);
    std::remove((base + ending).c_str());
  }
}

}  // namespace
}  // namespace spume::coupling
