// Threads that share rounds of the same tasks.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numeric>

#include "foam/crew.h"

namespace spume::foam {
namespace {

TEST(Crew, DoesEveryTaskOnceARoundHoweverManyComeToHelp) {
  constexpr int kRounds = 2000;
  for (const std::size_t threads : {1, 2, 4, 8}) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    for (const std::size_t tasks : {1, 2, 3, 7}) {
      std::vector<int> done(tasks, 0);
      bool inStep = true;
      Crew::lead(tasks, [&](Crew& crew) {
        EXPECT_EQ(crew.tasks(), tasks);
        for (int round = 1; round <= kRounds; ++round) {
          crew.forEachTask([&](std::size_t task) { ++done[task]; });
          inStep = inStep && std::accumulate(done.begin(), done.end(), 0) == round * static_cast<int>(tasks);
        }
      });
      EXPECT_TRUE(inStep) << threads << " threads, " << tasks << " tasks";
      EXPECT_EQ(done, std::vector<int>(tasks, kRounds));
    }
  }
}

/// What a round has written the next one reads, whoever does its tasks.
TEST(Crew, ARoundSeesWhatTheLastOneWrote) {
  constexpr std::size_t kTasks = 3;
  std::vector<long> here(kTasks, 1), there(kTasks, 0);
  Crew::lead(kTasks, [&](Crew& crew) {
    for (int round = 0; round < 40; ++round) {
      crew.forEachTask([&](std::size_t task) { there[task] = here[(task + 1) % kTasks] + 1; });
      std::swap(here, there);
    }
  });
  EXPECT_EQ(here, std::vector<long>(kTasks, 41));
}

}  // namespace
}  // namespace spume::foam
