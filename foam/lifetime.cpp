#include "foam/lifetime.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <numeric>

#include "foam/counter_random.h"
#include "foam/parallel.h"
#include "foam/volume_correction.h"

namespace spume::foam {
namespace {

constexpr std::uint64_t kBurstPurpose = 0x6275727374ull;

/// A sliver of sphere below this share is round-off of the cell, not an opening.
constexpr double kOpenShare = 1e-9;

double relativeRate(const FoamParams& params, double gas) {
  return std::numbers::ln2 * gasRadius(gas) / params.burstReferenceRadius;
}

bool isOpen(const FoamTopology& topology, const BubbleStore& bubbles, std::size_t i) {
  const double sphere = 4 * std::numbers::pi * bubbles.radius[i] * bubbles.radius[i];
  return topology.freeArea[i] > kOpenShare * sphere;
}

/// Disjoint sets of bubbles; the root of a set is its lowest index.
class Clusters {
 public:
  explicit Clusters(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::int32_t root(std::int32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::int32_t i, std::int32_t j) {
    const std::int32_t a = root(i), b = root(j);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::int32_t> parent_;
};

/// Which bubbles hang on to one that is held, of those that meet.
class Support {
 public:
  explicit Support(std::vector<std::uint8_t>& held) : held_(held), clusters_(held.size()) {}

  /// Calls meet(k) for all k below `count`, in parallel.
  template <typename Meet>
  void pass(std::size_t count, const Meet& meet) {
    forEachIndex(count, meet);
    joinLoose();
  }
  /// Two bubbles in contact. Nearly all that are not held meet one that is; only the others are noted. In
  /// what order threads do this changes what is noted, but not what clusters hang on to.
  void meet(std::int32_t i, std::int32_t j) {
    const std::atomic_ref<std::uint8_t> ofI(held_[i]), ofJ(held_[j]);
    const bool isI = ofI.load(std::memory_order_relaxed), isJ = ofJ.load(std::memory_order_relaxed);
    if (isI != isJ) (isI ? ofJ : ofI).store(1, std::memory_order_relaxed);
    if (!isI && !isJ) loose_.local().push_back({i, j});
  }
  bool holdsAll() const { return std::find(held_.begin(), held_.end(), 0) == held_.end(); }

 private:
  struct Edge {
    std::int32_t i, j;
  };

  /// Holds the clusters of those noted of which one is held.
  void joinLoose() {
    for (std::vector<Edge>& edges : loose_) {
      for (const Edge& edge : edges) clusters_.join(edge.i, edge.j);
      edges.clear();
    }
    const auto n = static_cast<std::int32_t>(held_.size());
    for (std::int32_t i = 0; i < n; ++i)
      if (held_[i]) held_[clusters_.root(i)] = 1;
    for (std::int32_t i = 0; i < n; ++i) held_[i] = held_[clusters_.root(i)];
  }

  std::vector<std::uint8_t>& held_;
  Clusters clusters_;
  tbb::enumerable_thread_specific<std::vector<Edge>> loose_;
};

/// For every ending bubble that is enclosed, its neighbour with the largest film.
std::vector<std::ptrdiff_t> largestFilmNeighbours(const FoamTopology& topology,
                                                  const std::vector<std::uint64_t>& id,
                                                  const std::vector<std::uint8_t>& wanted) {
  std::vector<std::ptrdiff_t> heir(wanted.size(), -1);
  std::vector<double> area(wanted.size(), -1);
  const auto offer = [&](std::int32_t to, std::int32_t candidate, double film) {
    if (!wanted[to] || film < area[to] || (film == area[to] && id[candidate] > id[heir[to]])) return;
    area[to] = film, heir[to] = candidate;
  };
  for (const Film& film : topology.films) offer(film.i, film.j, film.area), offer(film.j, film.i, film.area);
  return heir;
}

/// Advances the clocks of bubble i; the age at its end if it comes within the step, else a negative number.
double advanceClocks(const FoamParams& params, bool supported, double psi, double dt, std::size_t i,
                     BubbleStore& bubbles) {
  const double before = bubbles.age[i];
  bubbles.age[i] += dt;
  if (!params.bursting || bubbles.type[i] == BubbleClass::liquid) return -1;
  const double gas = bubbles.gas[i], threshold = burstThreshold(params.seed, bubbles.id[i]);
  const double lived = timeOfExposure(params, gas, bubbles.exposure[i]);
  const double end = timeOfExposure(params, gas, threshold);
  const double speed = burstClockSpeed(params, psi, bubbles.radius[i]);
  bubbles.exposure[i] = burstExposure(params, gas, lived + speed * dt);
  if (!supported) bubbles.exposure[i] += threshold * dt / kUnsupportedLife;
  if (bubbles.exposure[i] < threshold) return -1;
  return before + (speed > 0 ? std::clamp((end - lived) / speed, 0.0, dt) : dt);
}

/// Names the heirs of enclosed bubbles. One step moves gas only once: who inherits does not end, and who has
/// ended does not inherit; the others wait for the next step.
void settleHeirs(const std::vector<std::ptrdiff_t>& heirs, const std::vector<std::uint8_t>& enclosed,
                 std::vector<EndedLife>& ended) {
  enum : std::uint8_t { untouched, gone, inherited };
  std::vector<std::uint8_t> state(heirs.size(), untouched);
  std::erase_if(ended, [&](EndedLife& life) {
    if (state[life.index] == inherited) return true;
    if (enclosed[life.index]) {
      life.heir = heirs[life.index];
      if (life.heir < 0 || state[life.heir] == gone) return true;
      state[life.heir] = inherited;
    }
    state[life.index] = gone;
    return false;
  });
}

}  // namespace

double burstExposure(const FoamParams& params, double gas, double time) {
  return relativeRate(params, gas) * std::pow(time / params.burstMedianLife, params.burstShape);
}

double timeOfExposure(const FoamParams& params, double gas, double exposure) {
  return params.burstMedianLife * std::pow(exposure / relativeRate(params, gas), 1 / params.burstShape);
}

double burstThreshold(std::uint64_t seed, std::uint64_t id) {
  return -std::log1p(-CounterRandom(seed, id, kBurstPurpose).uniform());
}

double burstClockSpeed(const FoamParams& params, double psi, double radius) {
  if (params.burstWallFactor == 1) return 1;
  const double reach = std::max(params.burstWallDistance, radius);
  const double share =
      reach > radius ? std::clamp((psi - radius) / (reach - radius), 0.0, 1.0) : psi > radius;
  return params.burstWallFactor + share * (1 - params.burstWallFactor);
}

std::vector<EndedLife> endLives(const FoamParams& params, const FoamTopology& topology,
                                const std::vector<std::uint8_t>& supported, const Eigen::VectorXd& psi,
                                double dt, BubbleStore& bubbles) {
  std::vector<EndedLife> ended;
  std::vector<std::uint8_t> enclosed(bubbles.size(), 0);
  std::vector<double> age(bubbles.size());
  forEachIndex(age.size(), [&](std::size_t i) {
    age[i] = advanceClocks(params, supported[i], psi[static_cast<Eigen::Index>(i)], dt, i, bubbles);
  });
  for (std::size_t i = 0; i < age.size(); ++i) {
    if (age[i] < 0) continue;
    ended.push_back({i, age[i]});
    enclosed[i] = !isOpen(topology, bubbles, i);
  }
  if (ended.empty()) return ended;
  const auto byId = [&](const EndedLife& a, const EndedLife& b) {
    return bubbles.id[a.index] < bubbles.id[b.index];
  };
  std::sort(ended.begin(), ended.end(), byId);
  settleHeirs(largestFilmNeighbours(topology, bubbles.id, enclosed), enclosed, ended);
  return ended;
}

std::vector<std::uint8_t> supportedBubbles(const FoamTopology& topology, const Eigen::VectorXd& psi,
                                           const BubbleStore& bubbles) {
  const std::size_t n = bubbles.size();
  std::vector<std::uint8_t> held(n);
  forEachIndex(n, [&](std::size_t i) {
    held[i] = bubbles.type[i] != BubbleClass::air || psi[static_cast<Eigen::Index>(i)] <= bubbles.radius[i] ||
              bubbles.touchedSolid[i];
  });
  Support support(held);
  support.pass(topology.films.size(),
               [&](std::size_t f) { support.meet(topology.films[f].i, topology.films[f].j); });
  // A swallowed bubble has no film: it hangs on to whatever swallowed it.
  if (!support.holdsAll())
    support.pass(topology.overlaps.size(), [&](std::size_t p) {
      const OverlapPair& pair = topology.overlaps[p];
      if (topology.hidden[pair.i] || topology.hidden[pair.j]) support.meet(pair.i, pair.j);
    });
  return held;
}

void coalesce(std::size_t from, std::size_t to, const std::vector<double>& mass, BubbleStore& bubbles) {
  const double gas = bubbles.gas[from] + bubbles.gas[to], share = bubbles.gas[from] / gas;
  const double inertiaShare = mass[from] / (mass[from] + mass[to]);
  bubbles.position[to] += share * (bubbles.position[from] - bubbles.position[to]);
  bubbles.velocity[to] += inertiaShare * (bubbles.velocity[from] - bubbles.velocity[to]);
  bubbles.wetness[to] += share * (bubbles.wetness[from] - bubbles.wetness[to]);
  bubbles.radius[to] *= std::cbrt(gas / bubbles.gas[to]);
  bubbles.gas[to] = gas;
}

}  // namespace spume::foam
