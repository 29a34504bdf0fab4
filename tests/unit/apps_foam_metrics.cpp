#include <gtest/gtest.h>

#include "apps/reproduce/foam_metrics.h"
#include "coupling/errors.h"
#include "foam/power_cells.h"
#include "tests/support/apps_program.h"

namespace spume::apps {
namespace {

foam::BubbleStore storeOf(const std::vector<Eigen::Vector3d>& places, foam::BubbleClass type) {
  foam::BubbleStore bubbles;
  for (const Eigen::Vector3d& place : places) {
    foam::NewBubble bubble;
    bubble.position = place;
    bubble.radius = 1;
    bubble.type = type;
    bubbles.add(bubble);
  }
  return bubbles;
}

foam::FoamTopology topologyOf(const foam::BubbleStore& bubbles) {
  foam::FoamTopology topology;
  foam::PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, topology);
  return topology;
}

TEST(SurfaceCensus, CountsContactsAndNeighboursOfWalls) {
  foam::BubbleStore bubbles =
      storeOf({{0, 0, 0}, {1.8, 0, 0}, {6, 0, 0}, {9, 0, 0}}, foam::BubbleClass::surface);
  bubbles.type[3] = foam::BubbleClass::liquid;
  Eigen::VectorXd toSolids(4);
  toSolids << 5, 3, 1, 1.2;
  const SurfaceCensus census = surfaceCensus(bubbles, toSolids);
  EXPECT_EQ(census.floating, 3u);
  EXPECT_DOUBLE_EQ(census.clustered, 2.0 / 3);
  EXPECT_DOUBLE_EQ(census.atWalls, 1.0 / 3);
  EXPECT_DOUBLE_EQ(census.clinging, 1);
}

TEST(LayersAlong, CountsTheCellsOfAColumnAndNoLoneBubble) {
  const foam::BubbleStore column = storeOf(
      {{0, 0, 0}, {0, 1.5, 0}, {0, 3, 0}, {0, 4.5, 0}, {0, 9, 0}, {1.6, 1.5, 0}}, foam::BubbleClass::air);
  EXPECT_EQ(layersAlong(column, topologyOf(column), 0, 0), 4);    // the lone one above touches nobody
  EXPECT_EQ(layersAlong(column, topologyOf(column), 0.7, 0), 4);  // the neighbour's cell starts at 0.8
  EXPECT_EQ(layersAlong(column, topologyOf(column), 2, 0), 1);
  EXPECT_EQ(layersAlong(column, topologyOf(column), 5, 0), 0);
}

TEST(InsideSolids, CountsCentresDeeperThanHalfTheRadius) {
  const foam::BubbleStore bubbles = storeOf({{0, 0, 0}, {3, 0, 0}, {6, 0, 0}}, foam::BubbleClass::liquid);
  Eigen::VectorXd toSolids(3);
  toSolids << 0.5, -0.4, -0.6;
  EXPECT_EQ(insideSolids(bubbles, toSolids), 1u);
  EXPECT_DOUBLE_EQ(deepestInSolids(bubbles, toSolids), 0.6);
}

TEST(BubbleBooks, AddUpTheTimeOutOfTheWater) {
  const test::Scratch scratch;
  const std::string events = scratch.write("events.csv",
                                           "step,time,kind,id,cause,to\n"
                                           "1,0,birth,0,marker,liquid\n"
                                           "1,0,birth,1,marker,surface\n"
                                           "2,1,class,0,,surface\n"
                                           "3,2,class,0,,liquid\n"
                                           "4,3,class,0,,surface\n"
                                           "5,3.5,class,0,,air\n"
                                           "6,4,burst,0,age,air\n"
                                           "7,5,leave,1,border,surface\n");
  const BubbleBooks books = readBooks(events);
  EXPECT_EQ(books.born, 2u);
  EXPECT_EQ(books.ended, 2u);
  EXPECT_EQ(books.left, 1u);
  ASSERT_EQ(books.surfaceLives.size(), 1u);
  EXPECT_DOUBLE_EQ(books.surfaceLives[0], 2);  // 1 to 2 s and 3 to 4 s
}

TEST(BubbleBooks, RefuseAFileThatIsNoListOfEvents) {
  const test::Scratch scratch;
  EXPECT_THROW(readBooks(scratch.write("a.csv", "step,time\n1,2\n")), coupling::SceneError);
  EXPECT_THROW(readBooks(scratch.write("b.csv", "step,time,kind,id,cause,to\n1,2\n")), coupling::SceneError);
  EXPECT_THROW(readBooks(scratch / "none.csv"), coupling::FileError);
}

}  // namespace
}  // namespace spume::apps
