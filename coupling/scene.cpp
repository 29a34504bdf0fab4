#include "coupling/scene.h"

#include <algorithm>

namespace spume::coupling {

double Animated::at(double t) const {
  const auto after = std::upper_bound(keys.begin(), keys.end(), t,
                                      [](double time, const auto& key) { return time < key.first; });
  if (after == keys.begin()) return keys.front().second;
  if (after == keys.end()) return keys.back().second;
  const auto& [t0, value0] = *std::prev(after);
  const auto& [t1, value1] = *after;
  return value0 + (value1 - value0) * (t - t0) / (t1 - t0);
}

double Animated::integral(double from, double to) const {
  double sum = 0, time = from;
  for (const auto& key : keys) {
    const double next = std::clamp(key.first, time, to);
    sum += 0.5 * (at(time) + at(next)) * (next - time);
    time = next;
  }
  return sum + keys.back().second * (to - time);
}

double Animated::largest() const {
  const auto byValue = [](const auto& a, const auto& b) { return a.second < b.second; };
  return std::max_element(keys.begin(), keys.end(), byValue)->second;
}

}  // namespace spume::coupling
