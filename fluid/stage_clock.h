#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace spume::fluid {

struct StageTime {
  std::string stage;
  double seconds;
};

/// Adds up the wall time of named stages over the sub-steps of a step.
class StageClock {
 public:
  /// Runs `work` and adds its time to `stage`.
  template <typename Work>
  void time(const char* stage, const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    for (StageTime& t : stages_)
      if (t.stage == stage) {
        t.seconds += spent.count();
        return;
      }
    stages_.push_back({stage, spent.count()});
  }
  const std::vector<StageTime>& stages() const { return stages_; }

 private:
  std::vector<StageTime> stages_;
};

}  // namespace spume::fluid
