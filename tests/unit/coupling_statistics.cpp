#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "coupling/atomic_file.h"
#include "coupling/statistics.h"
#include "tests/support/temporary_path.h"

namespace spume::coupling {
namespace {

namespace fs = std::filesystem;

class Statistics : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  static std::vector<std::vector<std::string>> rows(const std::string& path) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(readFile(path));
    for (std::string line; std::getline(lines, line);) {
      rows.emplace_back();
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
  }

  static StepReport step(int number) {
    StepReport report;
    report.step = number;
    report.time = number / 3.0;
    report.liquid.stages = {{"advect", 0.25}, {"solve pressure", 0.5}};
    report.foam.stages = {{"geometry", 0.125}};
    report.foam.bubbles = static_cast<std::size_t>(10 * number);
    report.foam.hidden = static_cast<std::size_t>(number), report.foam.clamped = 3;
    report.births = 2;
    report.events.push_back({.kind = Event::Kind::birth, .time = report.time, .id = 100u + number});
    return report;
  }
  static FrameReport frame(int number) {
    FrameReport report;
    report.frame = number;
    report.steps = {step(2 * number - 1), step(2 * number)};
    return report;
  }
  static void addFrames(StatisticsWriter& writer, int first, int last) {
    for (int n = first; n <= last; ++n) {
      const FrameReport report = frame(n);
      for (const StepReport& s : report.steps) writer.add(s);
      writer.add(report);
    }
  }

  std::string folder_ = temporaryPath("spume_statistics");
};

TEST_F(Statistics, RowsHaveTheDocumentedColumns) {
  StatisticsWriter writer(folder_);
  addFrames(writer, 1, 2);
  const auto steps = rows(folder_ + "/steps.csv"), frames = rows(folder_ + "/frames.csv");
  const auto events = rows(folder_ + "/events.csv");
  ASSERT_EQ(steps.size(), 5u);
  ASSERT_EQ(frames.size(), 3u);
  ASSERT_EQ(events.size(), 5u);
  EXPECT_EQ(steps[0].size(), stepColumns().size() + 3);  // three stages
  for (const auto& row : steps) EXPECT_EQ(row.size(), steps[0].size());
  for (std::size_t n = 0; n < stepColumns().size(); ++n) EXPECT_EQ(steps[0][n], stepColumns()[n].name);
  for (std::size_t n = 0; n < frameColumns().size(); ++n) EXPECT_EQ(frames[0][n], frameColumns()[n].name);
  for (std::size_t n = 0; n < eventColumns().size(); ++n) EXPECT_EQ(events[0][n], eventColumns()[n].name);
  EXPECT_EQ(steps[0][stepColumns().size() + 1], "seconds_liquid_solve_pressure");
  EXPECT_EQ(steps[1].back(), "0.125");
  EXPECT_EQ(std::stod(steps[1][1]), 1 / 3.0);
  EXPECT_EQ(events[2][3], "102");
}

TEST_F(Statistics, FramesSumUpTheirSteps) {
  StatisticsWriter writer(folder_);
  addFrames(writer, 1, 1);
  const auto frames = rows(folder_ + "/frames.csv");
  const auto cell = [&](const std::string& name) {
    const auto found = std::find(frames[0].begin(), frames[0].end(), name);
    return frames[1].at(found - frames[0].begin());
  };
  EXPECT_EQ(cell("steps"), "2");
  EXPECT_EQ(cell("births"), "4");
  EXPECT_EQ(cell("bubbles"), "20");
  EXPECT_EQ(cell("hidden"), "2");
  EXPECT_EQ(cell("clamped"), "3");
}

TEST_F(Statistics, ResumeCutsBackAndContinuesAsIfNeverStopped) {
  {
    StatisticsWriter writer(folder_);
    addFrames(writer, 1, 6);
  }
  const std::string steps = readFile(folder_ + "/steps.csv"), frames = readFile(folder_ + "/frames.csv");
  const std::string events = readFile(folder_ + "/events.csv");
  replaceFile(folder_ + "/steps.csv", steps + "13,0.1");  // a row that was cut off
  {
    StatisticsWriter writer(folder_, 6, 3);
    addFrames(writer, 4, 6);
  }
  EXPECT_EQ(readFile(folder_ + "/steps.csv"), steps);
  EXPECT_EQ(readFile(folder_ + "/frames.csv"), frames);
  EXPECT_EQ(readFile(folder_ + "/events.csv"), events);
}

TEST_F(Statistics, NewRunStartsNewFiles) {
  {
    StatisticsWriter writer(folder_);
    addFrames(writer, 1, 3);
  }
  {
    StatisticsWriter writer(folder_);
    addFrames(writer, 1, 1);
  }
  EXPECT_EQ(rows(folder_ + "/frames.csv").size(), 2u);
}

}  // namespace
}  // namespace spume::coupling
