#pragma once

#include <optional>

#include "coupling/scene_relations.h"

namespace spume::coupling {

/// The first conflict between the values of a scene that are about bubbles, if any.
std::optional<Conflict> findFoamConflict(const Scene& scene);

}  // namespace spume::coupling
