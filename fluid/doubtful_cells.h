#pragma once

#include <cstdint>

#include "fluid/dense_field.h"
#include "fluid/marker_set.h"

namespace spume::fluid {

/// The cells within one cell of an escaped marker. Where a marker is on the wrong side phi is wrong, so what
/// is read from it there, how much liquid a cell holds and where new markers go, would defend its error.
class DoubtfulCells {
 public:
  explicit DoubtfulCells(const Eigen::Vector3i& cells) : doubt_(cells) {}

  void clear() { doubt_.fill(0); }
  /// Adds the cells around every marker that is flagged as escaped.
  void add(const MarkerSet& markers);
  bool operator()(int i, int j, int k) const { return doubt_(i, j, k) != 0; }

 private:
  DenseField<std::uint8_t> doubt_;
};

}  // namespace spume::fluid
