#include "coupling/nearest_key.h"

#include <algorithm>
#include <numeric>

namespace spume::coupling {

int editDistance(const std::string& a, const std::string& b) {
  std::vector<int> beforeLast, last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], beforeLast[j - 2] + 1);
    }
    beforeLast = last;
    last = row;
  }
  return last.back();
}

std::string nearestOf(const std::string& wanted, const std::vector<std::string>& candidates) {
  const auto closer = [&](const std::string& a, const std::string& b) {
    return editDistance(wanted, a) < editDistance(wanted, b);
  };
  const auto nearest = std::min_element(candidates.begin(), candidates.end(), closer);
  return nearest == candidates.end() ? std::string() : *nearest;
}

}  // namespace spume::coupling
