#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>

#include "apps/reproduce/svg_plot.h"

namespace spume::apps {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Ticks, AreRoundAndCoverTheRange) {
  EXPECT_EQ(ticksOver(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(ticksOver(1, 1700, 6).back(), 2000);
  EXPECT_EQ(ticksOver(-3, 7, 5), (std::vector<double>{-4, -2, 0, 2, 4, 6, 8}));
  for (const double value : {0.0, 5.0, -2.0}) {  // no extent
    const std::vector<double> ticks = ticksOver(value, value, 5);
    EXPECT_LE(ticks.front(), value);
    EXPECT_GT(ticks.back(), value);
  }
}

TEST(Plot, ShowsEveryPanelCurveLabelAndName) {
  const Plot plot{
      "Title", "frame", "time [s]", {{"one", {0, 1, 2}, {0, 1, 4}}, {"two", {0, 1, 2}, {3, 2, 1}}}};
  const std::string svg = svgOf({plot, plot});
  EXPECT_EQ(svg.rfind("<svg", 0), 0u);
  EXPECT_EQ(count(svg, "<path"), 4u);
  for (const char* words : {"Title", "frame", "time [s]", "one", "two"})
    EXPECT_EQ(count(svg, std::string(">") + words + "<"), 2u) << words;
}

TEST(Plot, MarksThePointsOfACurveThatAsksForIt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string svg =
      svgOf({{"t", "x", "y", {{"plain", {0, 1}, {0, 1}}, {"dotted", {0, 1, 2}, {1, nan, 2}, true}}}});
  EXPECT_EQ(count(svg, "<circle"), 2u) << "of the points that can be shown";
}

TEST(Plot, BreaksTheLineWhereNothingCanBeShown) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string svg = svgOf({{"t", "x", "y", {{"c", {0, 1, 2, 3}, {1, nan, 2, 3}}}}});
  EXPECT_EQ(std::regex_search(svg, std::regex("d=\"M[0-9. ]+M[0-9. ]+L[0-9. ]+\"")), true) << svg;
  EXPECT_EQ(count(svg, "nan"), 0u);
}

TEST(Plot, LogarithmicAxisLeavesOutZeros) {
  const std::string svg = svgOf({{"t", "x", "y", {{"c", {0, 1, 2}, {0, 1e-3, 1}}}, true}});
  EXPECT_EQ(count(svg, "inf") + count(svg, "nan"), 0u);
  EXPECT_EQ(count(svg, ">0.001<"), 1u);
}

TEST(Plot, EmptyCurvesAndMarkupAreHarmless) {
  const std::string svg = svgOf({{"a < b & c", "x", "y", {{"none", {}, {}}}}});
  EXPECT_EQ(count(svg, "a &lt; b &amp; c"), 1u);
  EXPECT_EQ(count(svg, "nan") + count(svg, "inf"), 0u);
}

}  // namespace
}  // namespace spume::apps
