#pragma once

#include <string>

#include "apps/trade/trade.h"

namespace spume::apps {

/// Distance from the reference over time of a frame as an SVG file, a curve a dial. The distance is that of
/// the figure that lies furthest away, in widths of the noise.
std::string tradePlot(const Trade& trade);

}  // namespace spume::apps
