#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "coupling/scene_lint.h"

namespace spume::coupling {

/// Findings as they are made; parts of a message are joined, numbers with three digits.
class FindingList {
 public:
  template <typename... Parts>
  void warn(const std::string& object, const Parts&... parts) {
    add(Severity::warning, object, parts...);
  }
  template <typename... Parts>
  void note(const std::string& object, const Parts&... parts) {
    add(Severity::note, object, parts...);
  }

  /// All of them, warnings first.
  std::vector<Finding> take() {
    std::stable_sort(findings_.begin(), findings_.end(),
                     [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
    return std::move(findings_);
  }

 private:
  template <typename... Parts>
  void add(Severity severity, const std::string& object, const Parts&... parts) {
    std::ostringstream message;
    message.precision(3);
    (message << ... << parts);
    findings_.push_back({severity, object, message.str()});
  }

  std::vector<Finding> findings_;
};

}  // namespace spume::coupling
