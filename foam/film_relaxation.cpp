#include "foam/film_relaxation.h"

#include <cmath>
#include <deque>
#include <functional>
#include <utility>

#include "foam/film_energy.h"
#include "foam/parallel.h"

namespace spume::foam {
namespace {

using Columns = FilmEnergy::Columns;

constexpr int kStepsOfRound = 20;   ///< between corrections of the pressures
constexpr std::size_t kMemory = 8;  ///< steps the descent remembers
constexpr double kFirstStep = 0.2;  ///< of the gradient: a node's stiffness is 2 to 5
constexpr double kEnough = 1e-4;    ///< share of the slope's promise that a step must keep
constexpr int kMostHalvings = 20;

double dot(const Columns& a, const Columns& b) {
  return reduceIndices(
      a.size(), 0.0, [&](std::size_t n) { return a[n].dot(b[n]); }, std::plus<>());
}

/// Limited-memory quasi-Newton descent [Nocedal 1980].
class Descent {
 public:
  Descent(FilmEnergy& energy, Columns x) : energy_(energy), x_(std::move(x)) {
    value_ = energy_.at(x_, gradient_);
  }

  const Columns& x() const { return x_; }
  const Columns& gradient() const { return gradient_; }
  void renew() { value_ = energy_.at(x_, gradient_); }

  /// One step down; false if there is none.
  bool step() {
    findDirection();
    double slope = dot(direction_, gradient_);
    if (!(slope < 0)) {
      memory_.clear();
      findDirection();
      slope = dot(direction_, gradient_);
      if (!(slope < 0)) return false;
    }
    double length = 1;
    for (int halving = 0; halving < kMostHalvings; ++halving, length /= 2) {
      trial_.resize(x_.size());
      forEachIndex(x_.size(), [&](std::size_t n) { trial_[n] = x_[n] + length * direction_[n]; });
      const double value = energy_.at(trial_, trialGradient_);
      if (value > value_ + kEnough * length * slope) continue;
      remember(length);
      std::swap(x_, trial_), std::swap(gradient_, trialGradient_);
      value_ = value;
      return true;
    }
    renew();
    return false;
  }

 private:
  struct Pair {
    Columns moved, turned;
    double product;
  };

  void findDirection() {
    direction_.resize(x_.size());
    forEachIndex(x_.size(), [&](std::size_t n) { direction_[n] = -gradient_[n]; });
    std::vector<double> share(memory_.size());
    for (std::size_t m = memory_.size(); m-- > 0;) {
      share[m] = dot(memory_[m].moved, direction_) / memory_[m].product;
      add(-share[m], memory_[m].turned);
    }
    const double scale = memory_.empty()
                             ? kFirstStep
                             : memory_.back().product / dot(memory_.back().turned, memory_.back().turned);
    forEachIndex(x_.size(), [&](std::size_t n) { direction_[n] *= scale; });
    for (std::size_t m = 0; m < memory_.size(); ++m)
      add(share[m] - dot(memory_[m].turned, direction_) / memory_[m].product, memory_[m].moved);
  }
  void add(double factor, const Columns& column) {
    forEachIndex(column.size(), [&](std::size_t n) { direction_[n] += factor * column[n]; });
  }
  void remember(double length) {
    Pair pair;
    if (memory_.size() == kMemory) pair = std::move(memory_.front()), memory_.pop_front();
    pair.moved.resize(x_.size()), pair.turned.resize(x_.size());
    forEachIndex(x_.size(), [&](std::size_t n) {
      pair.moved[n] = length * direction_[n], pair.turned[n] = trialGradient_[n] - gradient_[n];
    });
    pair.product = dot(pair.moved, pair.turned);
    if (pair.product > 0) memory_.push_back(std::move(pair));
  }

  FilmEnergy& energy_;
  Columns x_, gradient_, direction_, trial_, trialGradient_;
  double value_;
  std::deque<Pair> memory_;
};

double meanNorm(const Columns& columns) {
  const double sum = reduceIndices(
      columns.size(), 0.0, [&](std::size_t n) { return columns[n].norm(); }, std::plus<>());
  return sum / static_cast<double>(columns.size());
}

/// Of the edges of all triangles [m].
double meanEdge(const FilmNetwork& network) {
  double sum = 0;
  for (const NetworkFilm& film : network.films)
    for (std::int32_t t = film.firstTriangle; t < film.endTriangle; ++t)
      for (int a = 0; a < 3; ++a) {
        const auto& corner = network.triangles[t];
        sum += (network.at(film, corner[a]) - network.at(film, corner[(a + 1) % 3])).norm();
      }
  return sum / (3 * static_cast<double>(network.triangles.size()));
}

double worstShare(const std::vector<double>& gained, const std::vector<double>& volume) {
  double worst = 0;
  for (std::size_t c = 0; c < gained.size(); ++c)
    if (volume[c] > 0) worst = std::max(worst, std::abs(gained[c]) / volume[c]);
  return worst;
}

}  // namespace

FilmRelaxationReport relaxFilms(const std::vector<double>& volume, const FilmRelaxationSettings& settings,
                                FilmNetwork& network) {
  FilmRelaxationReport report;
  report.pressure.assign(volume.size(), 0);
  if (network.films.empty()) return report;
  FilmEnergy energy(network, volume.size());
  Descent descent(energy, energy.start());
  report.areaBefore = report.areaAfter = energy.area();
  for (bool settled = false; !settled && report.steps < settings.mostSteps;) {
    for (bool goesDown = true; goesDown && ++report.steps % kStepsOfRound != 0;) goesDown = descent.step();
    const double before = std::exchange(report.areaAfter, energy.area());
    report.worstVolume = worstShare(energy.gained(), volume);
    settled = std::abs(report.areaAfter - before) < settings.areaTolerance * before &&
              report.worstVolume < settings.volumeTolerance;
    energy.correctPressures();
    descent.renew();
  }
  report.pull = meanNorm(descent.gradient()) / meanEdge(network);
  report.pressure = energy.pressure();
  for (std::size_t n = 0; n < network.nodes.size(); ++n) network.nodes[n].position = descent.x()[n];
  return report;
}

}  // namespace spume::foam
