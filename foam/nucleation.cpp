#include "foam/nucleation.h"

#include <algorithm>
#include <cmath>

#include "foam/counter_random.h"

namespace spume::foam {
namespace {

constexpr std::uint64_t kSitePurpose = 0x7369746500000001;
constexpr std::uint64_t kWaitPurpose = 0x7369746500000002;
constexpr std::uint64_t kRadiusPurpose = 0x7369746500000003;

/// Thickness of the layer over the edge of the box: thin against any wall's curvature that the box can show.
constexpr double kLayerShare = 1.0 / 256;
/// Points tried at most; beyond it the layer grows instead.
constexpr double kMostPoints = 2e7;
constexpr Eigen::Index kBatch = 1 << 16;
/// A new bubble is pressed on the wall by this share of its radius, so that round-off cannot part them.
constexpr double kPressed = 0.05;
/// psi at a site may differ by this share of the bubble's radius before the solid is held to have moved away.
constexpr double kMoved = 1;

double exponential(CounterRandom random) { return -std::log1p(-random.uniform()); }

std::uint64_t siteKey(std::size_t site, std::uint64_t seed) {
  return CounterRandom(seed, site, kSitePurpose).bits();
}

Eigen::Matrix3Xd drawPoints(std::int64_t first, Eigen::Index count, const Eigen::Vector3d& lower,
                            const Eigen::Vector3d& size, std::uint64_t stream) {
  Eigen::Matrix3Xd points(3, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    CounterRandom random(stream, static_cast<std::uint64_t>(first + k), kSitePurpose);
    const Eigen::Array3d share(random.uniform(), random.uniform(), random.uniform());
    points.col(k) = lower + (share * size.array()).matrix();
  }
  return points;
}

/// Moves the points of a batch that lie in the layer onto the solid and appends them.
void takeSites(const NucleationParams& params, int index, const LiquidSampler& liquid,
               const Eigen::Matrix3Xd& points, double layer, std::vector<NucleationSite>& sites) {
  const Eigen::Index n = points.cols();
  Eigen::VectorXd psi(n);
  Eigen::Matrix3Xd away(3, n);
  Eigen::VectorXi solid(n);
  liquid.psi(points, psi), liquid.gradPsi(points, away), liquid.solidIndex(points, solid);
  for (Eigen::Index k = 0; k < n; ++k) {
    const bool wanted = params.solid == NucleationParams::kAnySolid || solid[k] == params.solid;
    const double slope = away.col(k).norm();
    if (!wanted || psi[k] <= 0 || psi[k] >= layer || slope == 0) continue;
    NucleationSite site;
    site.away = away.col(k) / slope;
    site.position = points.col(k) - psi[k] / slope * site.away;
    site.params = index;
    sites.push_back(site);
  }
}

/// Forgets a bubble that has gone; the wait for the next one begins.
void letGo(const NucleationParams& params, const BubbleStore& bubbles, double now, std::uint64_t key,
           NucleationSite& site) {
  const std::ptrdiff_t row = bubbles.find(site.bubble);
  if (row >= 0 && (bubbles.position[row] - site.position).norm() < 2 * bubbles.radius[row]) return;
  site.bubble = NucleationSite::kFree;
  site.ready = now + params.waiting * exponential(CounterRandom(key, site.births, kWaitPurpose));
}

}  // namespace

std::vector<NucleationSite> findNucleationSites(const NucleationParams& params, int index,
                                                const LiquidSampler& liquid, const Eigen::Vector3d& lower,
                                                const Eigen::Vector3d& upper, std::uint64_t seed) {
  const Eigen::Vector3d size = upper - lower;
  const double onePerLayer = params.density * size.prod();
  const double layer = std::max(kLayerShare * size.minCoeff(), onePerLayer / kMostPoints);
  const auto count = static_cast<std::int64_t>(std::llround(onePerLayer / layer));
  const std::uint64_t stream = CounterRandom(seed, static_cast<std::uint64_t>(index), kSitePurpose).bits();
  std::vector<NucleationSite> sites;
  for (std::int64_t first = 0; first < count; first += kBatch) {
    const Eigen::Index n = std::min<std::int64_t>(kBatch, count - first);
    takeSites(params, index, liquid, drawPoints(first, n, lower, size, stream), layer, sites);
  }
  for (std::size_t s = 0; s < sites.size(); ++s)
    sites[s].ready =
        params.start + params.waiting * exponential(CounterRandom(siteKey(s, stream), 0, kWaitPurpose));
  return sites;
}

std::vector<Nucleated> nucleate(const std::vector<NucleationParams>& params, const LiquidSampler& liquid,
                                const BubbleStore& bubbles, double now, std::uint64_t seed,
                                std::vector<NucleationSite>& sites) {
  std::vector<std::size_t> waiting;
  for (std::size_t s = 0; s < sites.size(); ++s) {
    NucleationSite& site = sites[s];
    const NucleationParams& own = params[site.params];
    if (site.bubble != NucleationSite::kFree) letGo(own, bubbles, now, siteKey(s, seed), site);
    const bool active = now >= own.start && now < own.stop;
    if (active && site.bubble == NucleationSite::kFree && now >= site.ready) waiting.push_back(s);
  }
  const auto n = static_cast<Eigen::Index>(waiting.size());
  std::vector<Nucleated> born;
  if (n == 0) return born;
  Eigen::Matrix3Xd place(3, n);
  Eigen::VectorXd radius(n), phi(n), psi(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const NucleationSite& site = sites[waiting[k]];
    CounterRandom random(siteKey(waiting[k], seed), site.births, kRadiusPurpose);
    radius[k] = params[site.params].radius.draw(random);
    place.col(k) = site.position + (1 - kPressed) * radius[k] * site.away;
  }
  liquid.phi(place, phi), liquid.psi(place, psi);
  for (Eigen::Index k = 0; k < n; ++k) {
    const bool onWall = std::abs(psi[k] - radius[k]) < kMoved * radius[k];
    if (phi[k] > -radius[k] || !onWall) continue;
    born.push_back({NewBubble{place.col(k), {0, 0, 0}, radius[k]}, waiting[k]});
    ++sites[waiting[k]].births;
  }
  return born;
}

}  // namespace spume::foam
