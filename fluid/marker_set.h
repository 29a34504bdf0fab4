#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spume::fluid {

/// The markers of one sign, as columns of equal length. Positions are in cell units from the grid's low corner.
/// Positive markers live in air (phi > 0), negative ones in the liquid.
struct MarkerSet {
  std::vector<float> x, y, z;        ///< position [cells]
  std::vector<float> radius;         ///< [cells], within markerRadiusMin..markerRadiusMax
  std::vector<float> gas;            ///< air the marker stands for [m^3]; kept for positive markers only
  std::vector<float> speed;          ///< largest recent speed relative to the receiving liquid [m/s]; positive only
  std::vector<std::uint8_t> escaped; ///< 1 while on the wrong side by more than its radius

  std::size_t size() const { return x.size(); }
};

}  // namespace spume::fluid
