#pragma once

#include <string>

namespace spume::apps {

/// Seconds of a duration such as "3h", "90m", "1h30m", "45s" or "5400" (seconds).
/// Throws std::invalid_argument with the forms that are understood.
double parseDuration(const std::string& text);

/// What is wrong with such a text; empty if nothing is. The form of a check of a command line's option.
std::string durationProblem(const std::string& text);

/// A duration in the two largest units that matter: "4.2 s", "1m35s", "2h04m".
std::string formatDuration(double seconds);

}  // namespace spume::apps
