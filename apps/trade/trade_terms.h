#pragma once

#include <vector>

#include "apps/trade/trade_dials.h"

namespace spume::apps {

/// The terms of the model that are at work in a scene, each with one setting: switched off, or what takes its
/// place; and the push of the bubbles on the liquid, switched on, where it is off.
std::vector<Dial> termsOf(const coupling::Scene& scene);

}  // namespace spume::apps
