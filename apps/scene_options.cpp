#include "apps/scene_options.h"

#include <cmath>

namespace spume::apps {
namespace {

/// What --quality multiplies the cells along an edge by. Births do not depend on the resolution (model,
/// Section 4), so a draft shows the same foam: 64 cells become 40 at about a quarter of the time, or 96 at
/// about five times.
double cellFactor(const std::string& quality) { return quality == "draft" ? 0.625 : 1.5; }

coupling::Override splitAssignment(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw coupling::SceneError("--set " + text + ": expected table.key=value, e.g. --set foam.wetness=0.5");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace

void SceneOptions::addTo(CLI::App& verb) {
  verb.add_option("scene", path, "scene file (TOML)")->required()->type_name("SCENE");
  verb.add_option("--quality", quality, "draft: 0.625 times the cells along an edge, fine: 1.5 times")
      ->check(CLI::IsMember({"draft", "standard", "fine"}));
  verb.add_option("--resolution", resolution, "cells along the longest edge; domain.resolution")
      ->type_name("N");
  addChangesTo(verb, "any key of the scene, e.g. --set coupling.entrainment.onset=0.6");
}

void SceneOptions::addChangesTo(CLI::App& verb, const std::string& keys) {
  verb.add_option("--frames", frames, "frames to simulate; time.frames")->type_name("N");
  verb.add_option("--seed", seed, "of the random numbers; scene.seed")->type_name("N");
  verb.add_option("--set", set, keys + "; may be repeated")
      ->type_name("a.b=v")
      ->type_size(1)
      ->allow_extra_args(false);
}

coupling::Overrides SceneOptions::given() const {
  coupling::Overrides overrides;
  for (const std::string& assignment : set) overrides.push_back(splitAssignment(assignment));
  if (!seed.empty()) overrides.push_back({"scene.seed", seed});
  if (!frames.empty()) overrides.push_back({"time.frames", frames});
  if (!resolution.empty()) overrides.push_back({"domain.resolution", resolution});
  return overrides;
}

void SceneOptions::requireNew(const coupling::Override& further) const {
  const auto refuse = [&](const std::string& other) {
    throw coupling::SceneError(further.text() + ": the same key is given by " + other +
                               "; leave one of them out");
  };
  for (const coupling::Override& other : given())
    if (other.key == further.key) refuse(other.text());
  if (!quality.empty() && further.key == "domain.resolution") refuse("--quality " + quality);
}

coupling::Scene SceneOptions::read(const coupling::Overrides& further) const {
  const coupling::Overrides options = given();
  coupling::Overrides all;
  if (!quality.empty() && quality != "standard") {
    const long cells = std::lround(cellFactor(quality) * coupling::readScene(path).domain.resolution);
    all.push_back({"domain.resolution", std::to_string(cells)});
  }
  all.insert(all.end(), options.begin(), options.end());
  all.insert(all.end(), further.begin(), further.end());
  return coupling::readScene(path, all);
}

}  // namespace spume::apps
