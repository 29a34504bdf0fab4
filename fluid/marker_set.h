#pragma once

#include <cstddef>
#include <cstdint>

#include "fluid/large_pages.h"

namespace spume::fluid {

/// The markers of one sign, as columns of equal length. Positions are in cell units from the grid's low
/// corner. Positive markers live in air (phi > 0), negative ones in the liquid.
struct MarkerSet {
  LargeVector<float> x, y, z;  ///< position [cells]
  LargeVector<float> radius;   ///< [cells], within markerRadiusMin..markerRadiusMax
  LargeVector<float> gas;      ///< volume the marker stands for [m^3]: air if positive, liquid if negative
  LargeVector<std::uint8_t> escaped;  ///< 1 while on the wrong side by more than its radius

  std::size_t size() const { return x.size(); }

  /// Calls visit(column) for every column, in the order of declaration.
  template <typename Visit>
  void forEachColumn(const Visit& visit) {
    visit(x), visit(y), visit(z), visit(radius), visit(gas), visit(escaped);
  }
  void resize(std::size_t n) {
    forEachColumn([n](auto& column) { resizeWithRoom(column, n); });
  }
  /// Appends a marker with no gas, on its own side.
  void append(float px, float py, float pz, float r) {
    x.push_back(px), y.push_back(py), z.push_back(pz), radius.push_back(r);
    gas.push_back(0), escaped.push_back(0);
  }
};

/// Which side of the surface a set of markers belongs to.
enum class MarkerSign { negative = -1, positive = 1 };

}  // namespace spume::fluid
