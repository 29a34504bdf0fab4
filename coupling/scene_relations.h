#pragma once

#include <optional>
#include <string>

#include "coupling/scene.h"

namespace spume::coupling {

/// Two values that are each in range but do not fit together.
struct Conflict {
  std::string key;      ///< the dotted key to change
  std::string message;  ///< its value, what it contradicts, and what is allowed
};

/// The first conflict between the values of a scene, if any.
std::optional<Conflict> findConflict(const Scene& scene);

}  // namespace spume::coupling
