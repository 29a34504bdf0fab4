#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/wedge/variation.h"
#include "coupling/scene_lint.h"

namespace spume::apps {

/// One scene of a sweep.
struct WedgeVariant {
  std::string folder;             ///< inside the sweep's
  coupling::Overrides overrides;  ///< what tells it from the others
  coupling::Scene scene;
};

/// A parameter sweep, every variant read and checked.
struct Wedge {
  std::vector<std::string> keys;  ///< that vary
  std::vector<WedgeVariant> variants;

  const std::string& name() const { return variants.front().scene.name; }
};

/// Makes the combinations and checks each as `spume check` does. `read` gives the scene with overrides put
/// in. Throws coupling::SceneError, naming the --vary argument or the variant, and FileError.
Wedge makeWedge(const std::vector<Variation>& variations,
                const std::function<coupling::Scene(const coupling::Overrides&)>& read);

/// A remark of `spume check` and the folders of the variants it is made about.
struct SharedFinding {
  coupling::Finding finding;
  std::vector<std::string> folders;
};
/// What it warns of, every remark once.
std::vector<SharedFinding> warningsOf(const Wedge& wedge);

/// Time and disk of all variants, memory of the largest, as `spume check` estimates them.
struct WedgeCost {
  double seconds = 0, diskBytes = 0, memoryBytes = 0;
};
WedgeCost costOf(const Wedge& wedge);

}  // namespace spume::apps
