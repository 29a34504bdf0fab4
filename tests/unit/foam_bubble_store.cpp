#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "foam/bubble_store.h"
#include "foam/errors.h"

namespace spume::foam {
namespace {

BubbleStore storeOf(int count) {
  BubbleStore store;
  for (int i = 0; i < count; ++i) store.add({.position = {1.0 * i, 0, 0}, .radius = 1e-3 * (i + 1)});
  return store;
}

TEST(BubbleStore, ANewBubbleHoldsTheGasOfItsBall) {
  BubbleStore store;
  EXPECT_EQ(store.add({.position = {1, 2, 3}, .velocity = {0, 4, 0}, .radius = 2e-3}), 0u);
  EXPECT_DOUBLE_EQ(store.gas[0], 4 * std::numbers::pi / 3 * 8e-9);
  EXPECT_EQ(store.volume[0], store.gas[0]);
  EXPECT_EQ(store.velocity[0].y(), 4);
  EXPECT_EQ(store.age[0], 0);
  EXPECT_EQ(store.positions()(2, 0), 3);
}

TEST(BubbleStore, RemovalKeepsOrderAndEveryColumn) {
  BubbleStore store = storeOf(5);
  store.remove({1, 0, 0, 1, 0});
  EXPECT_EQ(store.id, (std::vector<std::uint64_t>{1, 2, 4}));
  for (std::size_t i = 0; i < store.size(); ++i) {
    EXPECT_EQ(store.position[i].x(), static_cast<double>(store.id[i]));
    EXPECT_DOUBLE_EQ(store.radius[i], 1e-3 * static_cast<double>(store.id[i] + 1));
  }
  for (std::size_t length : {store.gas.size(), store.age.size(), store.exposure.size(), store.volume.size(),
                             store.wetness.size(), store.surfaceWeight.size(), store.type.size(),
                             store.hidden.size(), store.clamped.size(), store.touchedSolid.size()})
    EXPECT_EQ(length, 3u);
}

TEST(BubbleStore, IdsAreNeverUsedTwice) {
  BubbleStore store = storeOf(3);
  store.remove({0, 0, 1});
  EXPECT_EQ(store.add({.radius = 1e-3}), 3u);
  EXPECT_EQ(store.find(3), 2);
  EXPECT_EQ(store.find(2), -1);
  EXPECT_EQ(store.find(99), -1);
}

TEST(BubbleStore, RejectsWhatIsNoBubble) {
  BubbleStore store;
  EXPECT_THROW(store.add({.radius = 0}), InvalidParameter);
  EXPECT_THROW(store.add({.radius = std::numeric_limits<double>::quiet_NaN()}), InvalidParameter);
  EXPECT_THROW(store.add({.position = {0, std::numeric_limits<double>::infinity(), 0}, .radius = 1}),
               InvalidParameter);
  EXPECT_EQ(store.size(), 0u);
  EXPECT_THROW(store.remove({1}), InvalidParameter);
}

}  // namespace
}  // namespace spume::foam
