#pragma once

#include <toml++/toml.h>

#include <Eigen/Core>
#include <stdexcept>
#include <string>

#include "coupling/scene_keys.h"

namespace spume::coupling {

/// A value that does not fit its key; `what()` says what was found and what is expected, without place or
/// key.
class BadValue : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Stores the value of `node` in `slot`. Throws BadValue: wrong type, wrong length, out of range. Nothing is
/// clamped.
void assign(const Slot& slot, const KeyRange& range, const toml::node& node);

/// The slot's value as TOML that reads back to the same bits.
std::string toToml(const Slot& slot);

/// The type in words: "number", "vector of 3 numbers", "one of box, sphere".
std::string typeName(const Slot& slot);

/// The range in words, "8 to 1024 [cells]"; empty for types without one.
std::string rangeText(const Slot& slot, const KeyRange& range);

/// Shortest text that reads back to the same double.
std::string exactText(double value);
/// "[1, 2, 3]", each as above.
std::string exactText(const Eigen::Vector3d& vector);

/// `text` as a TOML basic string with its quotes.
std::string quoted(const std::string& text);

}  // namespace spume::coupling
