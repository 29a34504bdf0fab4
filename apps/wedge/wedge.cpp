#include "apps/wedge/wedge.h"

#include <algorithm>

namespace spume::apps {
namespace {

/// What is wrong may stand at a key of the file that does not go with a varied one: then the variant is
/// named.
std::string inVariant(const std::string& message, const WedgeVariant& variant) {
  if (variant.overrides.empty() || message.find("--vary ") != std::string::npos) return message;
  std::string arguments;
  for (const coupling::Override& one : variant.overrides)
    arguments.append(arguments.empty() ? "" : " ").append(one.text());
  return message + "; with " + arguments;
}

}  // namespace

Wedge makeWedge(const std::vector<Variation>& variations,
                const std::function<coupling::Scene(const coupling::Overrides&)>& read) {
  Wedge wedge;
  for (const Variation& variation : variations) wedge.keys.push_back(variation.key);
  const std::vector<coupling::Overrides> all = combinations(variations);
  const std::vector<std::string> names = folderNames(all);
  for (std::size_t n = 0; n < all.size(); ++n) {
    WedgeVariant variant{names[n], all[n], {}};
    try {
      variant.scene = read(variant.overrides);
    } catch (const coupling::SceneError& error) {
      throw coupling::SceneError(inVariant(error.what(), variant));
    }
    wedge.variants.push_back(std::move(variant));
  }
  return wedge;
}

std::vector<SharedFinding> warningsOf(const Wedge& wedge) {
  std::vector<SharedFinding> shared;
  for (const WedgeVariant& variant : wedge.variants)
    for (const coupling::Finding& finding : coupling::lintScene(variant.scene)) {
      if (finding.severity != coupling::Severity::warning) continue;
      const auto same = std::find_if(shared.begin(), shared.end(), [&](const SharedFinding& other) {
        return other.finding.object == finding.object && other.finding.message == finding.message;
      });
      if (same == shared.end())
        shared.push_back({finding, {variant.folder}});
      else
        same->folders.push_back(variant.folder);
    }
  return shared;
}

WedgeCost costOf(const Wedge& wedge) {
  WedgeCost cost;
  for (const WedgeVariant& variant : wedge.variants) {
    const coupling::CostEstimate one = coupling::estimateCost(variant.scene);
    cost.seconds += one.secondsPerFrame * variant.scene.time.frames;
    cost.diskBytes += one.diskBytes;
    cost.memoryBytes = std::max(cost.memoryBytes, one.memoryBytes);
  }
  return cost;
}

}  // namespace spume::apps
