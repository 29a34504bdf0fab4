#pragma once

#include <string>
#include <vector>

namespace spume::coupling {

/// Fewest insertions, deletions, substitutions and swaps of neighbours that turn one word into the other.
int editDistance(const std::string& a, const std::string& b);

/// The candidate with the smallest edit distance to `wanted` (the first of equals); empty if there are none.
std::string nearestOf(const std::string& wanted, const std::vector<std::string>& candidates);

}  // namespace spume::coupling
