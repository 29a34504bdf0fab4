#pragma once

#include <string>

#include "apps/trade/trade.h"

namespace spume::apps {

/// Settings of dials that take less time than the scene's own, by more than the noise of times and by a
/// twentieth, and change no figure beyond the noise, each with its share of the time: "CFL number 8 (0.70 of
/// the time), ...", or "none".
std::string quickerSettings(const Trade& trade);

/// Terms that change figures beyond the noise when they are switched, each with the one it moves furthest.
std::string neededTerms(const Trade& trade);

/// Terms that change none, and whether that holds for all of them at once.
std::string idleTerms(const Trade& trade);

}  // namespace spume::apps
