#include <gtest/gtest.h>

#include <cmath>

#include "apps/reproduce/scene_figures.h"

namespace spume::apps {
namespace {

TEST(SceneFigures, TheLatePartIsAThirdAndOneMoreAndNeverMoreThanAll) {
  const std::size_t kBegins[][2] = {{0, 0}, {1, 0}, {2, 1}, {3, 1}, {4, 2}, {6, 3}, {60, 39}, {240, 159}};
  for (const auto& [size, begin] : kBegins) EXPECT_EQ(lateBegin(size), begin) << size;
}

TEST(SceneFigures, MeansAreOverAllOrOverTheLatePart) {
  EXPECT_EQ(meanOf({1, 2, 6}), 3);
  EXPECT_EQ(meanOf({}), 0);
  EXPECT_EQ(lateMean({1, 2, 6}), 4);
  EXPECT_EQ(lateMean({100, 100, 100, 4, 6, 8}), 6);
  EXPECT_TRUE(std::isnan(lateMean({})));
  EXPECT_EQ(earlyMean({3, 2, 6}), 3);
  EXPECT_EQ(earlyMean({4, 6, 100, 100}), 5);
  EXPECT_TRUE(std::isnan(earlyMean({})));
}

}  // namespace
}  // namespace spume::apps
