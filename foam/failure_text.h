#pragma once

#include <Eigen/Core>
#include <sstream>
#include <string>

#include "foam/bubble_store.h"

namespace spume::foam {

/// The parts one behind the other, numbers with six digits.
template <typename... Parts>
std::string joined(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

/// "[0.1, nan, 0.2]", for messages.
inline std::string textOf(const Eigen::Vector3d& v) {
  return joined("[", v.x(), ", ", v.y(), ", ", v.z(), "]");
}

/// "bubble 7 at [0.1, 0.2, 0.3] m", for messages.
inline std::string placeOf(const BubbleStore& bubbles, std::size_t i) {
  return joined("bubble ", bubbles.id[i], " at ", textOf(bubbles.position[i]), " m");
}

}  // namespace spume::foam
