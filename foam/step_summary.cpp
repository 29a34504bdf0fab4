#include "foam/step_summary.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace spume::foam {
namespace {

void sumUp(const BubbleStore& bubbles, FoamStepReport& report) {
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    report.liquid += bubbles.type[i] == BubbleClass::liquid;
    report.surface += bubbles.type[i] == BubbleClass::surface;
    report.air += bubbles.type[i] == BubbleClass::air;
    report.hidden += bubbles.hidden[i], report.clamped += bubbles.clamped[i];
    report.gas += bubbles.gas[i];
    report.maxSpeed = std::max(report.maxSpeed, bubbles.velocity[i].norm());
  }
}

void summariseVolumes(const BubbleStore& bubbles, FoamStepReport& report) {
  std::vector<double> error;
  error.reserve(bubbles.size());
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    if (!bubbles.hidden[i] && !bubbles.clamped[i])
      error.push_back(std::abs(bubbles.volume[i] / bubbles.gas[i] - 1));
  if (error.empty()) return;
  const auto middle = error.begin() + static_cast<std::ptrdiff_t>(error.size() / 2);
  std::nth_element(error.begin(), middle, error.end());
  report.volumeErrorMedian = *middle;
  report.volumeErrorMax = *std::max_element(middle, error.end());
}

}  // namespace

void summarise(const BubbleStore& bubbles, const FoamTopology& topology, FoamStepReport& report) {
  report.bubbles = bubbles.size();
  report.contacts = topology.films.size(), report.overlaps = topology.overlaps.size();
  tbb::parallel_invoke([&] { sumUp(bubbles, report); }, [&] { summariseVolumes(bubbles, report); });
}

}  // namespace spume::foam
