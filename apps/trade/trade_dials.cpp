#include "apps/trade/trade_dials.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/trade/trade_terms.h"
#include "coupling/nearest_key.h"
#include "coupling/toml_slot.h"

namespace spume::apps {
namespace {

using coupling::exactText;
using coupling::Scene;

/// A dial that turns one key.
struct KeyDial {
  const char *name, *title;
  DialKind kind;
  const char* key;
  std::vector<const char*> values;  ///< coarse to fine
};

const std::vector<KeyDial>& keyDials() {
  static const std::vector<KeyDial> kDials{
      {"cfl", "CFL number", DialKind::liquid, "liquid.cfl", {"8", "4", "2", "1"}},
      {"markers", "markers a cell", DialKind::liquid, "liquid.markers_per_cell", {"8", "16", "32", "64"}},
      {"transport",
       "transport of the level set",
       DialKind::liquid,
       "liquid.level_set_transport",
       {"semi_lagrangian", "weno5"}},
      // trapezoidal is meant for smooth flows: the reference of a splash is maccormack.
      {"advection",
       "advection of the velocity",
       DialKind::liquid,
       "liquid.velocity_advection",
       {"semi_lagrangian", "trapezoidal", "maccormack"}},
      {"pressure",
       "tolerance of the pressure",
       DialKind::liquid,
       "liquid.pressure_tolerance",
       {"1e-3", "1e-4", "1e-6", "1e-8"}},
      {"solver",
       "tolerance of the implicit step",
       DialKind::foam,
       "foam.solver_tolerance",
       {"1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "1e-8"}}};
  return kDials;
}

Dial fromKey(const KeyDial& turned) {
  Dial dial{turned.name, turned.title, turned.kind, {}};
  for (const char* value : turned.values) dial.settings.push_back({value, {{turned.key, value}}});
  return dial;
}

/// Cells along the longest edge, as shares of the scene's: its draft and fine quality and one between.
Dial resolutionDial(const Scene& scene) {
  Dial dial{"resolution", "cells along an edge", DialKind::liquid, {}};
  for (const double factor : {0.625, 0.8, 1.5}) {
    const std::string cells = std::to_string(std::lround(factor * scene.domain.resolution));
    dial.settings.push_back({cells, {{"domain.resolution", cells}}});
  }
  return dial;
}

/// Longest shared step; the shortest must not be longer.
Dial stepDial(const Scene& scene) {
  Dial dial{"step", "longest step [s]", DialKind::foam, {}};
  for (const double step : {0.04, 0.02, 0.01, 0.005}) {
    const std::string longest = exactText(step), shortest = exactText(std::min(step, scene.time.minDt));
    dial.settings.push_back({longest, {{"time.max_step", longest}, {"time.min_step", shortest}}});
  }
  return dial;
}

Dial volumesDial() {
  Dial dial{"volumes", "volumes of the cells", DialKind::foam, {{"relax", {{"foam.volume_mode", "relax"}}}}};
  for (const std::string tolerance : {"5e-2", "5e-3", "1e-3", "1e-4"})
    dial.settings.push_back(
        {"newton to " + tolerance, {{"foam.volume_mode", "newton"}, {"foam.volume_tolerance", tolerance}}});
  return dial;
}

}  // namespace

std::vector<Dial> dialsOf(const Scene& scene) {
  std::vector<Dial> dials;
  const bool solved = scene.solvesLiquid();
  if (solved) dials.push_back(resolutionDial(scene));
  for (const KeyDial& turned : keyDials())
    if (solved || turned.kind != DialKind::liquid) dials.push_back(fromKey(turned));
  dials.push_back(stepDial(scene));
  dials.push_back(volumesDial());
  for (Dial& term : termsOf(scene)) dials.push_back(std::move(term));
  return dials;
}

coupling::Overrides finestOf(const std::vector<Dial>& dials) {
  coupling::Overrides finest;
  for (const Dial& dial : dials) {
    if (dial.kind == DialKind::term) continue;
    const coupling::Overrides& last = dial.settings.back().overrides;
    finest.insert(finest.end(), last.begin(), last.end());
  }
  return finest;
}

std::vector<Dial> selectDials(const std::vector<Dial>& dials, const std::vector<std::string>& names) {
  if (names.empty()) return dials;
  const std::array<std::string, 3> groups{"liquid", "foam", "terms"};  // in the order of DialKind
  std::vector<std::string> known(groups.begin(), groups.end());
  for (const Dial& dial : dials) known.push_back(dial.name);
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw coupling::SceneError("--dials " + name + ": no dial of this scene; did you mean " +
                                 coupling::nearestOf(name, known) + "? --list shows them all");
  std::vector<Dial> chosen;
  for (const Dial& dial : dials)
    for (const std::string& word : {dial.name, groups[static_cast<std::size_t>(dial.kind)]})
      if (std::find(names.begin(), names.end(), word) != names.end()) {
        chosen.push_back(dial);
        break;
      }
  return chosen;
}

}  // namespace spume::apps
