#pragma once

#include <vector>

#include "apps/preview/preview_scene.h"
#include "foam/foam_params.h"

namespace spume::apps {

/// What the styles `contacts` and `pressure` show of each bubble, 0..1; empty for other styles. Contacts:
/// their number over 14, about that of a dry foam. Pressure: what the strong springs of compressed pairs
/// press on the bubble's surface, sum |F| / (4 pi r^2), over its capillary pressure 2 sigma / r.
std::vector<double> bubbleShade(PreviewStyle style, const foam::FoamParams& params,
                                const foam::BubbleStore& bubbles);

}  // namespace spume::apps
