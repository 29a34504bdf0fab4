#include "coupling/foam_relations.h"

#include <algorithm>

#include "coupling/foam_objects.h"
#include "coupling/nearest_key.h"
#include "coupling/solid_motion.h"
#include "coupling/toml_slot.h"

namespace spume::coupling {
namespace {

std::optional<Conflict> radiusConflict(const std::string& table, const foam::RadiusDistribution& radius) {
  const auto cut =
      ": min_radius " + exactText(radius.least) + ", max_radius " + exactText(radius.most) + " [m]";
  if (radius.least > radius.most)
    return Conflict{table + "min_radius", "= " + exactText(radius.least) + " exceeds " + table +
                                              "max_radius = " + exactText(radius.most) +
                                              " [m]; lower the one or raise the other"};
  const bool medianCounts = radius.law == foam::RadiusLaw::lognormal;
  if (medianCounts && (radius.median < radius.least || radius.median > radius.most))
    return Conflict{table + "median_radius",
                    "= " + exactText(radius.median) + " lies outside the cut" + cut + "; move it or them"};
  return std::nullopt;
}

template <typename Object>
std::optional<Conflict> timeConflict(const std::string& table, const Object& object) {
  if (object.start <= object.stop) return std::nullopt;
  return Conflict{table + "start", "= " + exactText(object.start) + " exceeds " + table + "stop = " +
                                       exactText(object.stop) + " [s]; lower the one or raise the other"};
}

std::optional<Conflict> solidConflict(const std::string& table, const std::string& name, const Scene& scene) {
  const auto named = [&](const SolidSpec& solid) { return solid.name == name; };
  if (name.empty() || name == kWallsOfDomain || std::any_of(scene.solids.begin(), scene.solids.end(), named))
    return std::nullopt;
  std::vector<std::string> names;
  for (const SolidSpec& solid : scene.solids)
    if (!solid.name.empty()) names.push_back(solid.name);
  const std::string remedy =
      names.empty() ? "give a [[solid]] that name" : "the nearest one is " + quoted(nearestOf(name, names));
  return Conflict{table + "solid", "= " + quoted(name) + " is not the name of a solid; " + remedy +
                                       ", write \"walls\" for those of the domain, or \"\" for all"};
}

}  // namespace

std::optional<Conflict> findFoamConflict(const Scene& scene) {
  if (scene.stillPool.enabled && !scene.inflows.empty())
    return Conflict{
        "still_pool.enabled",
        "= true, but the scene has an [[inflow]]; a pool at rest takes nothing in: remove one of them"};
  const auto isMoved = [](const SolidSpec& solid) { return moves(solid.motion); };
  if (scene.stillPool.enabled && std::any_of(scene.solids.begin(), scene.solids.end(), isMoved))
    return Conflict{
        "still_pool.enabled",
        "= true, but a [[solid]] moves, and a pool at rest does not give way: remove one of them"};
  if (scene.stillPool.enabled && !scene.liquidCache.run.empty())
    return Conflict{
        "liquid_cache.run",
        "= " + quoted(scene.liquidCache.run) +
            ", but still_pool.enabled = true: the liquid is either read or at rest: remove one of them"};
  for (std::size_t i = 0; i < scene.bubbleSources.size(); ++i) {
    const std::string table = "bubble_source." + std::to_string(i) + ".";
    if (auto conflict = radiusConflict(table, scene.bubbleSources[i].radius)) return conflict;
    if (auto conflict = timeConflict(table, scene.bubbleSources[i])) return conflict;
  }
  for (std::size_t i = 0; i < scene.nucleation.size(); ++i) {
    const std::string table = "nucleation." + std::to_string(i) + ".";
    if (auto conflict = radiusConflict(table, scene.nucleation[i].radius)) return conflict;
    if (auto conflict = timeConflict(table, scene.nucleation[i])) return conflict;
    if (auto conflict = solidConflict(table, scene.nucleation[i].solid, scene)) return conflict;
  }
  for (std::size_t i = 0; i < scene.bubbleKills.size(); ++i)
    if (auto conflict = timeConflict("bubble_kill." + std::to_string(i) + ".", scene.bubbleKills[i]))
      return conflict;
  return std::nullopt;
}

}  // namespace spume::coupling
