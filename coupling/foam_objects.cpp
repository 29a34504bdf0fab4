#include "coupling/foam_objects.h"

#include <algorithm>

#include "coupling/domain_box.h"
#include "coupling/first_bubbles.h"
#include "coupling/object_label.h"
#include "coupling/scene_builder.h"
#include "coupling/shapes.h"
#include "coupling/toml_slot.h"
#include "foam/counter_random.h"

namespace spume::coupling {
namespace {

// A file of bubbles may hold what the keys of [[bubbles]] may.
constexpr double kFastest = 100;    // [m/s]
constexpr double kSmallest = 1e-6;  // [m]
constexpr std::uint64_t kProbePurpose = 0x736f757263650001;
constexpr int kRoomProbes = 2000;  // points that look for room in a source: finds a share of 0.3 % for sure

/// To the micrometre.
std::string rounded(const Eigen::Vector3d& v) {
  constexpr double kPerMetre = 1e6;
  return exactText(Eigen::Vector3d((v * kPerMetre).array().round() / kPerMetre));
}

void checkBubbles(const Scene& scene, const DomainBox& domain, const SignedDistance& psi) {
  const double widest = domain.size().minCoeff();
  const FirstBubbles all(scene);
  all.forEach([&](const foam::NewBubble& bubble, const auto& refuse) {
    const auto place = [&] { return "= " + exactText(bubble.position) + " m"; };
    const auto radius = [&] { return "= " + exactText(bubble.radius) + " m"; };
    if (!domain.holds(bubble.position))
      refuse("position", place() + " lies outside " + domain.words() + "; move the bubble or the domain");
    if (!(bubble.velocity.cwiseAbs().maxCoeff() <= kFastest))
      refuse("velocity", "= " + exactText(bubble.velocity) + " m/s; each allowed: " + exactText(-kFastest) +
                             " to " + exactText(kFastest) + " [m/s]");
    if (bubble.radius < kSmallest)
      refuse("radius", radius() + "; allowed: " + exactText(kSmallest) + " m or more");
    if (2 * bubble.radius > widest)
      refuse("radius",
             radius() + ": the bubble is larger than the domain; at most " + exactText(widest / 2) + " m");
    if (psi(bubble.position) <= 0)
      refuse("position", place() + " is inside a solid; move the bubble or the solid");
  });
}

void checkRegion(const ShapeSpec& shape, const DomainBox& domain) {
  requireUsable(shape);
  domain.requireOverlap(shape);
}

/// A gap may be narrower than a bubble, which it squeezes; a domain none of whose edges it fits into is a
/// slip of the unit.
void checkSource(const BubbleSourceSpec& source, const DomainBox& domain, const SignedDistance& psi) {
  checkRegion(source.shape, domain);
  const double longest = domain.size().maxCoeff(), most = source.radius.most;
  if (2 * most > longest)
    throw KeyFault("max_radius", "= " + exactText(most) +
                                     " m: such a bubble is larger than the domain; at most " +
                                     exactText(longest / 2) + " m");
  if (roomShare(source.shape, domain, psi) == 0) {
    const auto [lower, upper] = bounds(source.shape);
    const auto& [key, value] = placeKey(source.shape);
    throw KeyFault(key, value + ": all of the source is inside a solid, around " +
                            rounded((lower + upper) / 2) + " m; move the source or the solid");
  }
}

}  // namespace

foam::FoamParams foamParamsOf(const Scene& scene) {
  foam::FoamParams params = scene.foam;
  params.solids.clear();
  for (const SolidSpec& solid : scene.solids) params.solids.push_back(solid.surface);
  return params;
}

std::vector<foam::NucleationParams> nucleationParamsOf(const Scene& scene) {
  std::vector<foam::NucleationParams> all;
  for (const NucleationSpec& spec : scene.nucleation) {
    foam::NucleationParams params;
    params.density = spec.density, params.waiting = spec.waiting, params.radius = spec.radius;
    params.start = spec.start, params.stop = spec.stop;
    const auto named = [&](const SolidSpec& solid) { return solid.name == spec.solid; };
    const auto solid = std::find_if(scene.solids.begin(), scene.solids.end(), named);
    if (spec.solid == kWallsOfDomain) params.solid = -1;
    if (!spec.solid.empty() && solid != scene.solids.end())
      params.solid = static_cast<int>(solid - scene.solids.begin());
    all.push_back(params);
  }
  return all;
}

double roomShare(const ShapeSpec& shape, const DomainBox& domain, const SignedDistance& psi) {
  const auto [lower, upper] = bounds(shape);
  const Eigen::Vector3d low = lower.cwiseMax(domain.lower), size = upper.cwiseMin(domain.upper) - low;
  foam::CounterRandom random(0, 0, kProbePurpose);
  int inside = 0, clear = 0;
  for (int n = 0; n < kRoomProbes; ++n) {
    const Eigen::Array3d place(random.uniform(), random.uniform(), random.uniform());
    const Eigen::Vector3d x = low + (place * size.array()).matrix();
    if (signedDistance(shape, x) > 0) continue;
    ++inside;
    clear += psi(x) > 0;
  }
  return inside > 0 ? static_cast<double>(clear) / inside : 0;
}

void checkFoamObjects(const Scene& scene) {
  const DomainBox domain(scene);
  const SignedDistance psi = solidDistance(scene);
  checkBubbles(scene, domain, psi);
  for (std::size_t i = 0; i < scene.bubbleSources.size(); ++i)
    checkItem(
        "bubble_source", i, [&] { checkSource(scene.bubbleSources[i], domain, psi); },
        objectLabel("bubble_source", scene.bubbleSources[i].name, i));
  for (std::size_t i = 0; i < scene.bubbleKills.size(); ++i)
    checkItem(
        "bubble_kill", i, [&] { checkRegion(scene.bubbleKills[i].shape, domain); },
        objectLabel("bubble_kill", scene.bubbleKills[i].name, i));
}

}  // namespace spume::coupling
