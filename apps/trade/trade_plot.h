#pragma once

#include <string>

#include "apps/trade/trade.h"

namespace spume::apps {

/// Accuracy over time of a frame as an SVG file, a curve a dial: the distance of the scene's figures from the
/// reference's, root of their mean square in widths of the noise; and of the liquid's dials the error of its
/// volume, of the foam's that of the cells.
std::string tradePlot(const Trade& trade);

}  // namespace spume::apps
