#pragma once

#include <cstddef>
#include <string>

namespace spume::coupling {

/// What messages call an object of a scene: "inflow 'jet'", or "inflow 0" where it has no name.
inline std::string objectLabel(const std::string& table, const std::string& name, std::size_t item) {
  return name.empty() ? table + " " + std::to_string(item) : table + " '" + name + "'";
}

}  // namespace spume::coupling
