#include "coupling/scene_relations.h"

#include <algorithm>
#include <cctype>

#include "coupling/foam_relations.h"
#include "coupling/toml_slot.h"

namespace spume::coupling {
namespace {

constexpr double kMostCells = 1 << 30;  // one float field of 4 GB

std::optional<Conflict> ordered(const std::string& key, double value, const std::string& other, double limit,
                                const std::string& unit) {
  if (value <= limit) return std::nullopt;
  return Conflict{key, "= " + exactText(value) + " exceeds " + other + " = " + exactText(limit) + " [" +
                           unit + "]; lower the one or raise the other"};
}

bool isFileSafe(const std::string& name) {
  const auto safe = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  return !name.empty() && std::all_of(name.begin(), name.end(), safe);
}

std::optional<Conflict> nameConflict(const Scene& scene) {
  if (isFileSafe(scene.name)) return std::nullopt;
  return Conflict{"scene.name", "= " + quoted(scene.name) + " must be one or more letters, digits, _ and -"};
}

std::optional<Conflict> sizeConflict(const Scene& scene) {
  const double cells = (scene.domain.size / scene.dx()).array().ceil().prod();
  if (cells <= kMostCells) return std::nullopt;
  return Conflict{"domain.resolution", "= " + std::to_string(scene.domain.resolution) + " makes " +
                                           exactText(cells) + " cells; at most " + exactText(kMostCells)};
}

std::optional<Conflict> inflowConflict(const Scene& scene) {
  for (std::size_t i = 0; i < scene.inflows.size(); ++i) {
    const InflowSpec& inflow = scene.inflows[i];
    const std::string table = "inflow." + std::to_string(i) + ".";
    if (auto conflict = ordered(table + "start", inflow.start, table + "stop", inflow.stop, "s"))
      return conflict;
    if (!(inflow.direction.norm() > 0))
      return Conflict{table + "direction", "= [0, 0, 0] has no direction; [0, -1, 0] points downwards"};
  }
  return std::nullopt;
}

std::optional<Conflict> outflowConflict(const Scene& scene) {
  for (std::size_t i = 0; i < scene.outflows.size(); ++i) {
    const std::string table = "outflow." + std::to_string(i) + ".";
    const OutflowSpec& outflow = scene.outflows[i];
    if (auto conflict = ordered(table + "start", outflow.start, table + "stop", outflow.stop, "s"))
      return conflict;
  }
  return std::nullopt;
}

/// The names of probes head the columns of a file.
std::optional<Conflict> probeConflict(const Scene& scene) {
  for (std::size_t i = 0; i < scene.probes.size(); ++i)
    if (const std::string& name = scene.probes[i].name; !name.empty() && !isFileSafe(name))
      return Conflict{"probe." + std::to_string(i) + ".name",
                      "= " + quoted(name) + " must be letters, digits, _ and -"};
  return std::nullopt;
}

}  // namespace

std::optional<Conflict> findConflict(const Scene& scene) {
  const EntrainmentSpec& births = scene.coupling.entrainment;
  const std::string entrainment = "coupling.entrainment.";
  if (auto conflict = nameConflict(scene)) return conflict;
  if (auto conflict = sizeConflict(scene)) return conflict;
  if (auto conflict = ordered("time.min_step", scene.time.minDt, "time.max_step", scene.time.maxDt, "s"))
    return conflict;
  if (auto conflict = ordered("liquid.marker_radius_min", scene.liquid.markerRadiusMin,
                              "liquid.marker_radius_max", scene.liquid.markerRadiusMax, "dx"))
    return conflict;
  if (auto conflict = ordered(entrainment + "min_radius", births.minRadius, entrainment + "median_radius",
                              births.medianRadius, "m"))
    return conflict;
  if (auto conflict = ordered(entrainment + "median_radius", births.medianRadius, entrainment + "max_radius",
                              births.maxRadius, "m"))
    return conflict;
  if (auto conflict =
          ordered("look.film_thin", scene.look.filmThin, "look.film_thick", scene.look.filmThick, "m"))
    return conflict;
  if (auto conflict = inflowConflict(scene)) return conflict;
  if (auto conflict = outflowConflict(scene)) return conflict;
  if (auto conflict = probeConflict(scene)) return conflict;
  return findFoamConflict(scene);
}

}  // namespace spume::coupling
