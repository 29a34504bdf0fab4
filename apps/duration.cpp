#include "apps/duration.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace spume::apps {
namespace {

/// Seconds in a unit letter, 0 for an unknown one.
double unitSeconds(char unit) {
  switch (unit) {
    case 'd':
      return 86400;
    case 'h':
      return 3600;
    case 'm':
      return 60;
    case 's':
      return 1;
    default:
      return 0;
  }
}

}  // namespace

double parseDuration(const std::string& text) {
  const std::invalid_argument wrong("\"" + text +
                                    "\" is no duration: write 3h, 90m, 1h30m, 45s or seconds, above 0");
  double total = 0;
  const char *at = text.data(), *end = text.data() + text.size();
  if (at == end) throw wrong;
  while (at < end) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value, std::chars_format::fixed);
    if (error != std::errc{} || value < 0) throw wrong;
    const double unit = next == end ? 1 : unitSeconds(*next);
    if (unit == 0) throw wrong;
    total += value * unit;
    at = next == end ? end : next + 1;
  }
  if (!(total > 0) || !std::isfinite(total)) throw wrong;
  return total;
}

std::string durationProblem(const std::string& text) {
  try {
    parseDuration(text);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

std::string formatDuration(double seconds) {
  char text[48];
  if (seconds < 10)
    std::snprintf(text, sizeof text, "%.1f s", seconds);
  else if (const long whole = std::lround(seconds); whole < 60)
    std::snprintf(text, sizeof text, "%ld s", whole);
  else if (whole < 3600)
    std::snprintf(text, sizeof text, "%ldm%02lds", whole / 60, whole % 60);
  else
    std::snprintf(text, sizeof text, "%ldh%02ldm", whole / 3600, whole / 60 % 60);
  return text;
}

}  // namespace spume::apps
