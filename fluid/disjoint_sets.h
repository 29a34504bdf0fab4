#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace spume::fluid {

/// The numbers 0 ... count - 1 in sets that grow by union. A set is named by its smallest member, whatever
/// the order of the unions.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  std::size_t of(std::size_t n) {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }

  void unite(std::size_t a, std::size_t b) {
    a = of(a);
    b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace spume::fluid
