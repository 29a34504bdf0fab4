#pragma once

#include "foam/bubble_store.h"

namespace spume::foam {

/// Throws NumericalFailure, naming the first bubble whose place, velocity, radius or gas is not finite, or
/// whose radius or gas is not positive. `when` says of a step of `dt` [s] at what time, for the message.
void requireSound(const BubbleStore& bubbles, const char* when, double dt);

/// What a step begins with: sound bubbles. Throws InvalidParameter if dt [s] is not positive and finite.
void requireUsable(const BubbleStore& bubbles, double dt);

}  // namespace spume::foam
