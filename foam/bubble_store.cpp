#include "foam/bubble_store.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foam/errors.h"
#include "foam/parallel.h"

namespace spume::foam {

namespace {

/// Applies `action` to every column of each store, so that adding and removing cannot forget one.
template <typename Action, typename... Stores>
void forEachColumn(const Action& action, Stores&... stores) {
  action(stores.id...), action(stores.position...), action(stores.velocity...), action(stores.radius...);
  action(stores.gas...), action(stores.age...), action(stores.exposure...), action(stores.volume...);
  action(stores.wetness...), action(stores.surfaceWeight...), action(stores.type...);
  action(stores.hidden...), action(stores.clamped...), action(stores.touchedSolid...);
}

}  // namespace

std::uint64_t BubbleStore::add(const NewBubble& bubble) {
  if (!(bubble.radius > 0) || !std::isfinite(bubble.radius) || !bubble.position.allFinite() ||
      !bubble.velocity.allFinite())
    throw InvalidParameter("bubble " + std::to_string(nextId) + ": radius " + std::to_string(bubble.radius) +
                           " m; it must be positive and, like position and velocity, finite");
  forEachColumn([](auto& column) { column.emplace_back(); }, *this);
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
  const auto first = std::find_if(flags.begin(), flags.end(), [](std::uint8_t flag) { return flag != 0; });
  const auto removeFrom = [&](auto& column) {
    auto kept = static_cast<std::size_t>(first - flags.begin());
    for (std::size_t i = kept; i < flags.size(); ++i)
      if (!flags[i]) column[kept++] = column[i];
    column.resize(kept);
  };
  forEachColumn(removeFrom, *this);
}

void BubbleStore::gather(const BubbleStore& from, const std::vector<std::int32_t>& rows) {
  forEachColumn([&](auto& column) { column.resize(rows.size()); }, *this);
  forEachBlock(rows.size(), [&](std::size_t begin, std::size_t end) {
    const auto gatherInto = [&](auto& column, const auto& source) {
      for (std::size_t k = begin; k < end; ++k) column[k] = source[rows[k]];
    };
    forEachColumn(gatherInto, *this, from);
  });
  nextId = from.nextId;
}

std::ptrdiff_t BubbleStore::find(std::uint64_t wanted) const {
  const auto place = std::lower_bound(id.begin(), id.end(), wanted);
  return place != id.end() && *place == wanted ? place - id.begin() : -1;
}

}  // namespace spume::foam
