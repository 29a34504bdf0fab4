#pragma once

#include <string>
#include <vector>

#include "coupling/scene_toml.h"

namespace spume::apps {

/// Dials set how finely the liquid or the foam is computed; terms are parts of the model a scene may do
/// without.
enum class DialKind { liquid, foam, term };

/// One position of a dial.
struct DialSetting {
  std::string label;  ///< "2"
  coupling::Overrides overrides;
};

/// One thing that may be changed about a scene while the rest stays.
struct Dial {
  std::string name;   ///< on the command line
  std::string title;  ///< in a table
  DialKind kind;
  std::vector<DialSetting> settings;  ///< coarse to fine; of a term: without it, or with it where it is off
};

/// The dials and terms that do something in a scene.
std::vector<Dial> dialsOf(const coupling::Scene& scene);

/// Every dial at its finest setting: what the others are compared with.
coupling::Overrides finestOf(const std::vector<Dial>& dials);

/// Those of the dials that are named, by their own name or as "liquid", "foam", "terms"; all if nothing is.
/// Throws coupling::SceneError, with the nearest known word, for one that is no dial of the scene.
std::vector<Dial> selectDials(const std::vector<Dial>& dials, const std::vector<std::string>& names);

}  // namespace spume::apps
