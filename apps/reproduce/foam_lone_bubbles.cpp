#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/reproduce/foam_bench.h"
#include "apps/reproduce/foam_studies.h"

namespace spume::apps {
namespace {

using Eigen::Vector3d;
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

/// Floating bubbles that burst at a median age of 1 s and do not draw each other.
foam::FoamParams burstingAfloat() {
  foam::FoamParams params = waterAt20(foam::Preset::physical);
  params.attractionLaw = foam::AttractionLaw::none;
  params.bursting = true, params.burstMedianLife = 1;
  return params;
}

constexpr double kApart = 4e-3;  ///< between bubbles of radius 1 mm, so that none touches another [m]

/// Place n of a square grid of `side` a row, at a height.
Vector3d gridPlace(std::size_t n, std::size_t side, double height) {
  return {kApart * static_cast<double>(n % side), height, kApart * static_cast<double>(n / side)};
}

/// Height of the centre at which a bubble floats at rest [m].
double floatingHeight(foam::FoamParams params) {
  params.bursting = false;
  foam::FoamSolver solver(params);
  foam::BubbleStore bubbles;
  bubbles.add({.radius = params.burstReferenceRadius});
  const foam::StillPool pool = openPool(params);
  for (int step = 0; step < 200; ++step) solver.step(bubbles, pool, 0.005);
  return bubbles.position[0].y();
}

/// Lives [s] of bubbles afloat, ascending; dt = 0: at random steps.
std::vector<double> lives(const foam::FoamParams& params, std::size_t count, double dt) {
  const double height = floatingHeight(params);
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  foam::BubbleStore bubbles;
  for (std::size_t i = 0; i < count; ++i)
    bubbles.add({.position = gridPlace(i, side, height),
                 .radius = params.burstReferenceRadius,
                 .type = foam::BubbleClass::surface});
  foam::FoamSolver solver(params);
  const foam::StillPool pool = openPool(params);
  std::vector<double> found;
  for (std::uint64_t step = 0; bubbles.size() > 0; ++step)
    for (const auto& event : solver.step(bubbles, pool, dt > 0 ? dt : randomStep(step)).events)
      if (event.kind == foam::FoamEventKind::burst) found.push_back(event.age);
  std::sort(found.begin(), found.end());
  return found;
}

/// T1: lives beside the Rayleigh distribution, by Kolmogorov and Smirnov.
std::vector<ResultRow> lifetimes(const StudyContext&) {
  constexpr std::size_t kCount = 100000;
  const double critical = 1.63 / std::sqrt(static_cast<double>(kCount));  // at p = 0.01
  const foam::FoamParams params = burstingAfloat();
  std::vector<ResultRow> rows;
  for (const double dt : {kSteps[0], kSteps[1], kSteps[2], 0.0}) {
    const std::vector<double> found = lives(params, kCount, dt);
    double worst = 0;
    for (std::size_t k = 0; k < kCount; ++k) {
      const double exact = -std::expm1(-std::numbers::ln2 * found[k] * found[k]);
      worst = std::max({worst, std::abs(exact - static_cast<double>(k) / kCount),
                        std::abs(exact - static_cast<double>(k + 1) / kCount)});
    }
    ResultRow distance{.resolution = std::to_string(kCount) + " bubbles afloat, dt " +
                                     (dt > 0 ? stepName(dt) : "1-20 ms at random"),
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
  const foam::StillPool space = emptySpace();
  std::vector<ResultRow> rows;
  for (const double gamma : {1.0, 10.0}) {
    double worst = 0;
    for (const double dt : {0.005, 0.02}) {
      foam::FoamParams params;
      params.gravity.setZero(), params.bursting = false, params.volumeRate = gamma;
      foam::FoamSolver solver(params);
      foam::BubbleStore bubbles;
      bubbles.add({.radius = 1e-3, .type = foam::BubbleClass::air});
      bubbles.radius[0] = 0.8e-3;
      for (int step = 1; step <= std::lround(0.3 / dt); ++step) {
        solver.step(bubbles, space, dt);
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

/// K5: bubbles that rise at a steady rate, float and burst.
std::vector<ResultRow> steadyHead(const StudyContext&) {
  constexpr std::size_t kArrivals = 20;                    // a step
  constexpr double kStep = 0.02, kWarmUp = 6, kTime = 66;  // [s]; the longest lives of Rayleigh's law are 4
  constexpr std::size_t kSide = 80;                        // of the grid; a place is taken again after 6.4 s
  constexpr double kDepth = 0.02;                          // from which they rise [m]
  const foam::FoamParams params = burstingAfloat();
  const double mean = std::sqrt(pi / (4 * std::numbers::ln2));  // of lives with the median 1 s
  foam::FoamSolver solver(params);
  const foam::StillPool pool = openPool(params);
  foam::BubbleStore bubbles;
  double count = 0, steps = 0;
  std::size_t born = 0;
  for (double t = 0; t < kTime; t += kStep) {
    for (std::size_t k = 0; k < kArrivals; ++k, ++born)
      bubbles.add({.position = gridPlace(born % (kSide * kSide), kSide, -kDepth),
                   .radius = params.burstReferenceRadius});
    const foam::FoamStepReport report = solver.step(bubbles, pool, kStep);
    const auto ended = std::count_if(report.events.begin(), report.events.end(), [](const auto& event) {
      return event.kind == foam::FoamEventKind::burst;
    });
    // Half of those that ended in the step were there at its middle.
    if (t >= kWarmUp) {
      count += static_cast<double>(report.surface + report.air) + static_cast<double>(ended) / 2;
      ++steps;
    }
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
          {"T1", "lifetimes", 80, lifetimes},
          {"K5", "a head of steady height", 5, steadyHead},
          {"T3", "volume correction as a rate", 1, volumeRate}};
}

}  // namespace spume::apps
