#pragma once

#include "apps/preview/preview_scene.h"

namespace spume::apps {

/// Thickness [m] of the film between two bubbles, or around one (`idB` ~0). It is born between the look's
/// thin and thick, by the ids alone, drains with the bubble's age [s] and runs thin upwards; `place` =
/// position from the bubble's centre over its radius.
float filmThickness(const coupling::LookSpec& look, std::uint64_t idA, std::uint64_t idB, float age,
                    const Vec3& place);

}  // namespace spume::apps
