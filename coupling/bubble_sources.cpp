#include "coupling/bubble_sources.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/clearance_grid.h"
#include "coupling/object_label.h"
#include "coupling/shapes.h"
#include "foam/counter_random.h"
#include "foam/volume_correction.h"

namespace spume::coupling {
namespace {

/// Purposes of the random numbers drawn here, so that no two share a stream.
constexpr std::uint64_t kTimePurpose = 0x736f757263650002;
constexpr std::uint64_t kRadiusPurpose = 0x736f757263650003;
constexpr std::uint64_t kPlacePurpose = 0x736f757263650004;

constexpr int kPlaces = BubbleSources::kPlaces;
/// Points drawn in the box of a region for them: enough for a shape that fills a fiftieth of its box.
constexpr int kDraws = 50 * kPlaces;

std::uint64_t streamOf(std::uint64_t seed, std::size_t source) {
  return foam::CounterRandom(seed, source, kTimePurpose).bits();
}

/// Where one source finds places.
class Region {
 public:
  Region(const BubbleSourceSpec& spec, const DomainBox& domain, const foam::LiquidSampler& liquid,
         const foam::BubbleStore& bubbles)
      : spec_(spec),
        liquid_(liquid),
        lower_(bounds(spec.shape).first.cwiseMax(domain.lower)),
        upper_(bounds(spec.shape).second.cwiseMin(domain.upper)),
        near_(lower_, upper_, (spec.radius.least + spec.radius.most) / 2) {
    const double reach = spec.radius.most;
    for (std::size_t i = 0; i < bubbles.size(); ++i) {
      const double r = bubbles.radius[i] + reach;
      const Eigen::Vector3d& x = bubbles.position[i];
      if ((x.array() > lower_.array() - r).all() && (x.array() < upper_.array() + r).all())
        near_.add(x, bubbles.radius[i]);
    }
  }

  /// Finds a place for a bubble of radius r: the first clear of solids and bubbles, else the one with most
  /// room, as in a gap narrower than the bubble. False if all are in solids or, where it matters, out of the
  /// liquid.
  bool place(double r, foam::CounterRandom random, Eigen::Vector3d& found) {
    const Eigen::Matrix3Xd places = drawPlaces(random);
    const Eigen::Index n = places.cols();
    Eigen::VectorXd phi(n), psi(n);
    if (n > 0) liquid_.phi(places, phi), liquid_.psi(places, psi);
    double best = -std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < n && best < 0; ++k) {
      if (psi[k] <= 0 || (spec_.immersed && phi[k] > -r)) continue;
      const double room = std::min(psi[k] - r, near_.clearance(places.col(k), r));
      if (room > best) best = room, found = places.col(k);
    }
    if (best == -std::numeric_limits<double>::infinity()) return false;
    near_.add(found, r);
    return true;
  }

 private:
  Eigen::Matrix3Xd drawPlaces(foam::CounterRandom& random) const {
    Eigen::Matrix3Xd places(3, kPlaces);
    Eigen::Index count = 0;
    for (int draw = 0; draw < kDraws && count < kPlaces; ++draw) {
      const Eigen::Array3d share(random.uniform(), random.uniform(), random.uniform());
      const Eigen::Vector3d x = lower_ + (share * (upper_ - lower_).array()).matrix();
      if (signedDistance(spec_.shape, x) <= 0) places.col(count++) = x;
    }
    return places.leftCols(count);
  }

  const BubbleSourceSpec& spec_;
  const foam::LiquidSampler& liquid_;
  Eigen::Vector3d lower_, upper_;
  ClearanceGrid near_;
};

}  // namespace

/// A bubble whose time has come.
struct BubbleSources::Due {
  std::uint64_t birth;
  double radius;
};

BubbleSources::BubbleSources(const Scene& scene)
    : specs_(scene.bubbleSources), domain_(scene), seed_(scene.seed) {}

double BubbleSources::drawRadius(std::size_t source, std::uint64_t birth) const {
  foam::CounterRandom random(streamOf(seed_, source), birth, kRadiusPurpose);
  return specs_[source].radius.draw(random);
}

std::vector<BubbleSources::Due> BubbleSources::dueUntil(std::size_t source, double to,
                                                        SourceProgress& progress) const {
  const BubbleSourceSpec& spec = specs_[source];
  std::vector<Due> due;
  if (to <= spec.start) return due;
  const bool byNumber = spec.measure == SourceMeasure::number;
  const double total = (byNumber ? spec.rate : spec.gasRate).integral(spec.start, std::min(to, spec.stop));
  for (;;) {
    const double radius = drawRadius(source, progress.births), gas = progress.gas + foam::ballVolume(radius);
    const double jitter =
        foam::CounterRandom(streamOf(seed_, source), progress.births, kTimePurpose).uniform();
    if ((byNumber ? static_cast<double>(progress.births) + jitter : gas) >= total) return due;
    due.push_back({progress.births++, radius});
    progress.gas = gas;
  }
}

BlownStep BubbleSources::step(double to, const foam::LiquidSampler& liquid, const foam::BubbleStore& bubbles,
                              std::vector<SourceProgress>& progress) const {
  BlownStep blown;
  progress.resize(specs_.size());
  for (std::size_t s = 0; s < specs_.size(); ++s) {
    const std::vector<Due> due = dueUntil(s, to, progress[s]);
    if (due.empty()) continue;
    Region region(specs_[s], domain_, liquid, bubbles);
    for (const Due& one : due) {
      foam::NewBubble bubble{
          {0, 0, 0}, specs_[s].velocity, one.radius, foam::BubbleClass::liquid, specs_[s].wetness};
      const foam::CounterRandom random(streamOf(seed_, s), one.birth, kPlacePurpose);
      if (region.place(one.radius, random, bubble.position)) {
        blown.bubbles.push_back({bubble, static_cast<int>(s)});
      } else {
        ++progress[s].unplaced;
        blown.unplacedGas += foam::ballVolume(one.radius);
      }
    }
  }
  return blown;
}

std::vector<std::string> unplacedWarnings(const Scene& scene, const std::vector<SourceProgress>& progress) {
  std::vector<std::string> warnings;
  for (std::size_t s = 0; s < progress.size(); ++s) {
    const BubbleSourceSpec& spec = scene.bubbleSources[s];
    if (progress[s].unplaced == 0) continue;
    warnings.push_back(objectLabel("bubble_source", spec.name, s) + ": " +
                       std::to_string(progress[s].unplaced) + " of its " +
                       std::to_string(progress[s].births) + " bubbles found no place outside solids" +
                       (spec.immersed ? " in the liquid" : "") +
                       " and were left out; source_unplaced in steps.csv says when");
  }
  return warnings;
}

}  // namespace spume::coupling
