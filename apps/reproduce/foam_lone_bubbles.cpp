#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/reproduce/foam_bench.h"
#include "apps/reproduce/foam_studies.h"
#include "foam/lifetime.h"
#include "foam/volume_correction.h"

namespace spume::apps {
namespace {

using std::numbers::pi;

constexpr double kDiameters[] = {.2, .3, .5, .7, 1, 1.3, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10, 15, 20};  // [mm]
constexpr double kContaminated[] = {.0162, .0293, .0551, .0791, .112, .143, .162, .208, .251,
                                    .252,  .237,  .232,  .232,  .240, .252, .289, .325};  // [m/s]
constexpr double kClean[] = {.0228, .0401, .0733, .133, .271, .344, .323, .288, .266,
                             .252,  .237,  .232,  .232, .240, .252, .289, .325};
constexpr double kSteps[] = {0.001, 0.005, 0.02};  // [s]

/// Speed of one bubble after `time` of rise from rest.
double riseSpeed(const foam::FoamParams& params, double diameter, double dt, double time) {
  foam::FoamSolver solver(params);
  foam::BubbleStore bubbles;
  bubbles.add({.radius = diameter / 2});
  const foam::StillPool pool = deepPool(params);
  for (double t = 0; t < time; t += dt) solver.step(bubbles, pool, dt);
  return bubbles.velocity[0].y();
}

std::string millimetres(double length) {
  std::string text = std::to_string(length);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " mm";
}

/// B1: rise of every diameter at three steps, beside the law chosen.
std::vector<ResultRow> terminalSpeeds(const StudyContext&) {
  constexpr double kRise = 0.6;  // [s]; many times the relaxation of the slowest
  std::vector<ResultRow> rows;
  double spread = 0;
  for (const auto law : {foam::DragLaw::contaminated, foam::DragLaw::clean}) {
    foam::FoamParams params = waterAt20(foam::Preset::physical);
    params.dragLaw = law;
    const bool clean = law == foam::DragLaw::clean;
    for (std::size_t k = 0; k < std::size(kDiameters); ++k) {
      const double table = clean ? kClean[k] : kContaminated[k];
      double slowest = 1e9, fastest = 0;
      for (const double dt : kSteps) {
        const double speed = riseSpeed(params, 1e-3 * kDiameters[k], dt, kRise);
        slowest = std::min(slowest, speed), fastest = std::max(fastest, speed);
      }
      spread = std::max(spread, 100 * (fastest / slowest - 1));
      ResultRow row{.resolution = "dt 1, 5, 20 ms",
                    .quantity = std::string(clean ? "clean" : "contaminated") + " water, d " +
                                millimetres(kDiameters[k]) + ": off the law",
                    .reference = std::to_string(table).substr(0, 6) + " m/s",
                    .source = "drag law, three figures"};
      rows.push_back(aimAtMost(row, 100 * std::max(fastest / table - 1, 1 - slowest / table), 1, "%"));
    }
  }
  ResultRow row{.resolution = "all diameters", .quantity = "difference between steps", .source = "exact"};
  rows.push_back(aimAtMost(row, spread, 0.1, "%"));
  return rows;
}

/// Steps of 1 to 20 ms, drawn anew each time.
double randomStep(std::uint64_t step) {
  foam::CounterRandom random(13, step, 5);
  return 1e-3 * std::pow(20, random.uniform());
}

/// Lives [s] of bubbles in the open, ascending; dt = 0: at random steps.
std::vector<double> lives(const foam::FoamParams& params, std::size_t count, double radius, double dt) {
  foam::BubbleStore bubbles;
  foam::FoamTopology topology;
  for (std::size_t i = 0; i < count; ++i)
    bubbles.add(
        {.position = {static_cast<double>(i), 1, 0}, .radius = radius, .type = foam::BubbleClass::air});
  topology.freeArea.assign(count, 4 * pi * radius * radius);
  topology.volume = bubbles.gas;
  topology.hidden.assign(count, 0);
  const std::vector<std::uint8_t> supported(count, 1);
  std::vector<double> found;
  for (std::uint64_t step = 0; bubbles.size() > 0; ++step) {
    const double length = dt > 0 ? dt : randomStep(step);
    std::vector<std::uint8_t> gone(bubbles.size(), 0);
    const Eigen::VectorXd psi = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(bubbles.size()));
    for (const auto& life : foam::endLives(params, topology, supported, psi, length, bubbles))
      gone[life.index] = 1, found.push_back(life.age);
    bubbles.remove(gone);
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// T1: lives beside the Rayleigh distribution, by Kolmogorov and Smirnov.
std::vector<ResultRow> lifetimes(const StudyContext&) {
  constexpr std::size_t kCount = 100000;
  const double critical = 1.63 / std::sqrt(static_cast<double>(kCount));  // at p = 0.01
  foam::FoamParams params;
  params.burstMedianLife = 1;
  std::vector<ResultRow> rows;
  for (const double dt : {kSteps[0], kSteps[1], kSteps[2], 0.0}) {
    const std::vector<double> found = lives(params, kCount, params.burstReferenceRadius, dt);
    double worst = 0;
    for (std::size_t k = 0; k < kCount; ++k) {
      const double exact = -std::expm1(-std::numbers::ln2 * found[k] * found[k]);
      worst = std::max({worst, std::abs(exact - static_cast<double>(k) / kCount),
                        std::abs(exact - static_cast<double>(k + 1) / kCount)});
    }
    ResultRow distance{
        .resolution = std::to_string(kCount) + " lives, dt " + (dt > 0 ? stepName(dt) : "1-20 ms at random"),
        .quantity = "distance from Rayleigh's distribution",
        .reference = "1.63/sqrt(n) at p = 0.01",
        .source = "Kolmogorov-Smirnov"};
    ResultRow median{
        .resolution = distance.resolution, .quantity = "median life", .reference = "1 s", .source = "exact"};
    rows.push_back(aimAtMost(distance, worst, critical, "-"));
    rows.push_back(aimAtMost(median, 100 * (found[kCount / 2] - 1), 1, "%"));
  }
  return rows;
}

/// T3: a ball alone returns to its volume at the rate gamma, whatever the step.
std::vector<ResultRow> volumeRate(const StudyContext&) {
  std::vector<ResultRow> rows;
  for (const double gamma : {1.0, 10.0}) {
    double worst = 0;
    for (const double dt : {0.005, 0.02}) {
      foam::FoamParams params;
      params.volumeRate = gamma;
      foam::BubbleStore bubbles;
      bubbles.add({.radius = 1e-3});
      bubbles.radius[0] = 0.8e-3;
      for (int step = 1; step <= std::lround(0.3 / dt); ++step) {
        foam::FoamTopology ball;
        ball.volume = {4 * pi / 3 * std::pow(bubbles.radius[0], 3)}, ball.hidden = {0};
        foam::correctVolumes(params, ball, dt, bubbles);
        const double exact = 1e-3 * std::pow(0.8, std::exp(-gamma * step * dt));
        worst = std::max(worst, 100 * std::abs(std::pow(bubbles.radius[0] / exact, 3) - 1));
      }
    }
    ResultRow row{.resolution = "dt 5, 20 ms",
                  .quantity = "gamma " + std::to_string(static_cast<int>(gamma)) + "/s: volume off the curve",
                  .reference = "exp(-gamma t)",
                  .source = "exact"};
    rows.push_back(aimAtMost(row, worst, 1, "%"));
  }
  return rows;
}

/// K5: bubbles that arrive at a steady rate and burst.
std::vector<ResultRow> steadyHead(const StudyContext&) {
  constexpr std::size_t kArrivals = 20;                    // a step
  constexpr double kStep = 0.02, kWarmUp = 6, kTime = 66;  // [s]; the longest lives of Rayleigh's law are 4
  foam::FoamParams params;
  params.burstMedianLife = 1;
  const double mean = std::sqrt(pi / (4 * std::numbers::ln2));  // of lives with the median 1 s
  foam::BubbleStore bubbles;
  double count = 0, steps = 0;
  for (double t = 0; t < kTime; t += kStep) {
    for (std::size_t k = 0; k < kArrivals; ++k)
      bubbles.add({.radius = params.burstReferenceRadius, .type = foam::BubbleClass::air});
    foam::FoamTopology topology;
    topology.freeArea.assign(bubbles.size(), 1), topology.hidden.assign(bubbles.size(), 0);
    topology.volume = bubbles.gas;
    const std::vector<std::uint8_t> supported(bubbles.size(), 1);
    const Eigen::VectorXd psi = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(bubbles.size()));
    std::vector<std::uint8_t> gone(bubbles.size(), 0);
    for (const foam::EndedLife& life : foam::endLives(params, topology, supported, psi, kStep, bubbles))
      gone[life.index] = 1;
    // Half of those that ended in the step were there at its middle.
    const auto ended = static_cast<double>(std::count(gone.begin(), gone.end(), 1));
    if (t >= kWarmUp) count += static_cast<double>(bubbles.size()) - ended / 2, ++steps;
    bubbles.remove(gone);
  }
  const double expected = static_cast<double>(kArrivals) / kStep * mean;
  ResultRow row{.resolution = "1000 arrivals a second, 60 s, dt 20 ms",
                .quantity = "bubbles in the head off arrival rate x mean life",
                .reference = "1064.5",
                .source = "Little 1961"};
  return {aimAtMost(row, 100 * (count / steps / expected - 1), 3, "%")};
}

}  // namespace

std::vector<Study> loneBubbleStudies() {
  return {{"B1", "terminal speed", 5, terminalSpeeds},
          {"T1", "lifetimes", 60, lifetimes},
          {"K5", "a head of steady height", 5, steadyHead},
          {"T3", "volume correction as a rate", 1, volumeRate}};
}

}  // namespace spume::apps
