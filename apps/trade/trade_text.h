#pragma once

#include <string>

#include "apps/trade/trade.h"

namespace spume::apps {

/// A value in one format of printf.
std::string number(const char* format, double value);

/// Whether differences of a figure are told in percent of it; else in its unit, which is itself percent.
bool isShare(const TradeFigure& figure);

/// A difference as a person reads it: "+3.2 %" of `of`, or "+0.12" points.
std::string differenceText(std::size_t figure, double difference, double of);

/// "75 frames, 40 cells".
std::string lengthOf(const Trade& trade);

}  // namespace spume::apps
