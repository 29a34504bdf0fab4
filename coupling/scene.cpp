#include "coupling/scene.h"

#include <algorithm>

namespace spume::coupling {

namespace {

/// The stretch between two keys that ends at t or contains it; first == last beyond the keys.
template <typename Keys>
auto stretchAt(const Keys& keys, double t) {
  const auto next = std::lower_bound(keys.begin(), keys.end(), t,
                                     [](const auto& key, double time) { return key.first < time; });
  if (next == keys.begin()) return std::pair(keys.front(), keys.front());
  if (next == keys.end()) return std::pair(keys.back(), keys.back());
  return std::pair(*std::prev(next), *next);
}

template <typename Keys>
auto valueAt(const Keys& keys, double t) {
  const auto [start, end] = stretchAt(keys, t);
  using Value = decltype(keys.front().second);
  if (t >= end.first) return Value(end.second);
  if (t <= start.first) return Value(start.second);
  return Value(start.second + (end.second - start.second) * ((t - start.first) / (end.first - start.first)));
}

template <typename Keys>
auto rateAt(const Keys& keys, double t) {
  const auto [start, end] = stretchAt(keys, t);
  const double length = end.first > start.first ? end.first - start.first : 1;
  using Value = decltype(keys.front().second);
  return Value((end.second - start.second) / length);
}

}  // namespace

double Animated::at(double t) const { return valueAt(keys, t); }
double Animated::rate(double t) const { return rateAt(keys, t); }
Eigen::Vector3d AnimatedVector::at(double t) const { return valueAt(keys, t); }
Eigen::Vector3d AnimatedVector::rate(double t) const { return rateAt(keys, t); }

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
