#include "foam/bubble_store.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foam/errors.h"

namespace spume::foam {

namespace {

/// Applies `action` to every column, so that adding and removing cannot forget one.
template <typename Store, typename Action>
void forEachColumn(Store& store, const Action& action) {
  action(store.id), action(store.position), action(store.velocity), action(store.radius), action(store.gas);
  action(store.age), action(store.exposure), action(store.volume), action(store.wetness);
  action(store.surfaceWeight), action(store.type), action(store.hidden), action(store.clamped);
  action(store.touchedSolid);
}

}  // namespace

std::uint64_t BubbleStore::add(const NewBubble& bubble) {
  if (!(bubble.radius > 0) || !std::isfinite(bubble.radius) || !bubble.position.allFinite() ||
      !bubble.velocity.allFinite())
    throw InvalidParameter("bubble " + std::to_string(nextId) + ": radius " + std::to_string(bubble.radius) +
                           " m; it must be positive and, like position and velocity, finite");
  forEachColumn(*this, [](auto& column) { column.emplace_back(); });
  id.back() = nextId;
  position.back() = bubble.position;
  velocity.back() = bubble.velocity;
  radius.back() = bubble.radius;
  gas.back() = 4 * std::numbers::pi / 3 * std::pow(bubble.radius, 3);
  volume.back() = gas.back();
  wetness.back() = bubble.wetness;
  type.back() = bubble.type;
  surfaceWeight.back() = bubble.type == BubbleClass::liquid ? 1 : 0;
  return nextId++;
}

void BubbleStore::remove(const std::vector<std::uint8_t>& flags) {
  if (flags.size() != size())
    throw InvalidParameter("BubbleStore::remove: " + std::to_string(flags.size()) + " flags for " +
                           std::to_string(size()) + " bubbles; give one flag per bubble");
  forEachColumn(*this, [&flags](auto& column) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < flags.size(); ++i)
      if (!flags[i]) column[kept++] = column[i];
    column.resize(kept);
  });
}

std::ptrdiff_t BubbleStore::find(std::uint64_t wanted) const {
  const auto place = std::lower_bound(id.begin(), id.end(), wanted);
  return place != id.end() && *place == wanted ? place - id.begin() : -1;
}

}  // namespace spume::foam
