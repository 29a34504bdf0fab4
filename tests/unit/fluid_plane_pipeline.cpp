#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <vector>

#include "fluid/plane_pipeline.h"

namespace spume::fluid {
namespace {

/// Runs the pipeline and counts what breaks the order that a stencil of one plane needs.
int faults(int stages, int planes) {
  std::vector<std::atomic<int>> done(planes);  // stages that have been on each plane
  std::atomic<int> faults = 0;
  const auto isOff = [&](int plane, int low, int high) {
    return plane >= 0 && plane < planes && (done[plane] < low || done[plane] > high);
  };
  pipelinePlanes(stages, planes, [&](int stage, int plane) {
    const bool wrong = isOff(plane, stage, stage) || isOff(plane - 1, stage, stage + 1) ||
                       isOff(plane + 1, stage, stage + 1);
    faults += wrong;
    ++done[plane];
  });
  for (const std::atomic<int>& count : done) faults += count != stages;
  return faults;
}

TEST(PlanePipeline, KeepsTheOrderThatSweepsNeed) {
  for (const int threads : {1, 2, 7}) {
    tbb::task_arena arena(threads);
    for (const int stages : {1, 4, 6})
      for (const int planes : {1, 5, 12, 64, 131})
        arena.execute(
            [&] { EXPECT_EQ(faults(stages, planes), 0) << threads << " " << stages << " " << planes; });
  }
}

}  // namespace
}  // namespace spume::fluid
