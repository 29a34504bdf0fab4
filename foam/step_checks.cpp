#include "foam/step_checks.h"

#include <cmath>
#include <functional>
#include <string>

#include "foam/errors.h"
#include "foam/failure_text.h"
#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// What a step cannot begin or end with; empty where the bubble is sound.
std::string defectOf(const BubbleStore& bubbles, std::size_t i) {
  const double r = bubbles.radius[i], gas = bubbles.gas[i];
  if (!bubbles.position[i].allFinite()) return "its place is not finite";
  if (!bubbles.velocity[i].allFinite())
    return joined("its velocity of ", textOf(bubbles.velocity[i]), " m/s is not finite");
  if (!(r > 0) || !std::isfinite(r)) return joined("its radius of ", r, " m is not positive and finite");
  if (!(gas > 0) || !std::isfinite(gas)) return joined("its gas of ", gas, " m^3 is not positive and finite");
  return {};
}

}  // namespace

void requireSound(const BubbleStore& bubbles, const char* when, double dt) {
  const auto isSound = [&](std::size_t i) {
    const double r = bubbles.radius[i], gas = bubbles.gas[i];
    const bool hasSize = r > 0 && std::isfinite(r) && gas > 0 && std::isfinite(gas);
    return hasSize && bubbles.position[i].allFinite() && bubbles.velocity[i].allFinite();
  };
  if (reduceIndices(bubbles.size(), true, isSound, std::logical_and<>())) return;
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    if (!isSound(i))
      throw NumericalFailure(
          joined("foam: ", placeOf(bubbles, i), " ", when, " of ", dt, " s: ", defectOf(bubbles, i)));
}

void requireUsable(const BubbleStore& bubbles, double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw InvalidParameter(joined("foam step: dt = ", dt, " s; it must be positive and finite"));
  requireSound(bubbles, "at the start of a step", dt);
}

}  // namespace spume::foam
