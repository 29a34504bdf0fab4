#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "apps/reproduce/foam_bench.h"
#include "apps/reproduce/foam_studies.h"
#include "foam/forces/solid_attraction.h"
#include "foam/forces/weak_attraction.h"

namespace spume::apps {
namespace {

using std::numbers::pi;

/// W1: the capillary pair force beside the Bessel function of the library.
std::vector<ResultRow> pairForce(const StudyContext&) {
  foam::FoamParams params = waterAt20(foam::Preset::physical);
  params.attractionLaw = foam::AttractionLaw::capillary;
  const double length = foam::capillaryLength(params), r = 1e-3, gas = 4 * pi / 3 * r * r * r;
  const double load = params.density * 9.81 * gas;
  double worst = 0;
  for (const double x : {0.5, 1.0, 2.0, 4.0}) {
    const double exact = load * load * std::cyl_bessel_k(1.0, x) / (2 * pi * params.surfaceTension * length);
    worst = std::max(worst, std::abs(foam::weakAttraction(params, gas, r, gas, r, x * length) / exact - 1));
  }
  ResultRow row{.resolution = "d/Lc 0.5, 1, 2, 4",
                .quantity = "pair force off f f K1(d/Lc)/(2 pi sigma Lc)",
                .reference = "Vella and Mahadevan 2005",
                .source = "exact"};
  return {aimAtMost(row, worst, 1e-6, "-")};
}

/// Two equal bubbles afloat that draw each other through thick drag: the speed is the force over
/// 6 pi mu r, as inertia is next to nothing. Stokes' factor below the surface and above it, so that the
/// depth at which they float does not matter.
foam::FoamParams creepingWater(double radius) {
  foam::FoamParams params = waterAt20(foam::Preset::physical);
  params.attractionLaw = foam::AttractionLaw::capillary;
  params.addedMass = 0, params.wetness = params.wetnessAloft = 0;
  params.dragLaw = foam::DragLaw::coefficient, params.dragCoefficient = 0;
  params.airDragLaw = foam::AirDragLaw::coefficient;
  params.airDragCoefficient = 6 * pi * params.viscosity * radius;
  return params;
}

/// Time [s] after which two bubbles, kApart at first, touch.
double meetingTime(double radius, double dt) {
  constexpr double kApart = 8e-3;  // [m]
  const foam::FoamParams params = creepingWater(radius);
  foam::StillPoolParams water;
  water.gravity = params.gravity, water.density = params.density;
  const foam::StillPool pool(water);
  foam::BubbleStore bubbles;
  for (const double x : {-0.5, 0.5})
    bubbles.add({.position = {x * kApart, 0, 0}, .radius = radius, .type = foam::BubbleClass::surface});
  foam::FoamSolver solver(params);
  double before = kApart;
  for (int step = 1;; ++step) {
    solver.step(bubbles, pool, dt);
    const double now = (bubbles.position[1] - bubbles.position[0]).norm();
    if (now <= 2 * radius) return dt * (step - (2 * radius - now) / (before - now));
    before = now;
  }
}

/// The same time from the law itself, by the midpoint rule in the distance.
double exactMeetingTime(double radius) {
  constexpr int kParts = 200000;  // leaves 1e-9 of the time
  constexpr double kApart = 8e-3;
  const foam::FoamParams params = creepingWater(radius);
  const double length = std::sqrt(params.surfaceTension / (params.density * 9.81)),
               load = params.density * 9.81 * 4 * pi / 3 * std::pow(radius, 3),
               part = (kApart - 2 * radius) / kParts;
  double time = 0;
  for (int k = 0; k < kParts; ++k) {
    const double d = 2 * radius + (k + 0.5) * part;
    const double pull =
        load * load * std::cyl_bessel_k(1.0, d / length) / (2 * pi * params.surfaceTension * length);
    time += part * 6 * pi * params.viscosity * radius / (2 * pull);
  }
  return time;
}

/// W2: how long two floating bubbles take from 8 mm to contact.
std::vector<ResultRow> approach(const StudyContext&) {
  struct Case {
    double radius, dt;
    const char* text;  // 10.54 s and 0.3245 s (accuracy, W2)
  };
  std::vector<ResultRow> rows;
  for (const Case& c : {Case{0.5e-3, 0.001, "10.538 s"}, Case{0.5e-3, 0.005, "10.538 s"},
                        Case{0.5e-3, 0.02, "10.538 s"}, Case{1e-3, 0.001, "0.32446 s"}}) {
    const double exact = exactMeetingTime(c.radius), ours = meetingTime(c.radius, c.dt);
    ResultRow row{.resolution = (c.radius < 1e-3 ? "r 0.5 mm, dt " : "r 1 mm, dt ") + stepName(c.dt),
                  .quantity = "time from 8 mm apart to contact, off",
                  .reference = c.text,
                  .source = "Stokes' drag and Vella and Mahadevan 2005, integrated"};
    rows.push_back(aimAtMost(row, 100 * (ours / exact - 1), 1, "%"));
  }
  return rows;
}

/// W4: what a wall does to a floating bubble.
std::vector<ResultRow> atWalls(const StudyContext&) {
  foam::FoamParams params = waterAt20(foam::Preset::physical);
  params.attractionLaw = foam::AttractionLaw::capillary;
  const double length = foam::capillaryLength(params), r = 1e-3, gas = 4 * pi / 3 * r * r * r,
               load = params.density * 9.81 * gas;
  std::vector<ResultRow> rows;
  for (const double angle : {60.0, 120.0}) {
    foam::SolidSurface glass;
    glass.contactAngle = angle;
    double worst = 0;
    bool rightWay = true;
    for (const double x : {0.5, 1.0, 2.0, 4.0}) {
      const double exact = load / std::tan(angle * pi / 180) * std::exp(-x);
      const double ours = foam::solidAttraction(params, glass, gas, r, x * length);
      worst = std::max(worst, std::abs(ours / exact - 1));
      rightWay = rightWay && (ours > 0) == (angle < 90);
    }
    ResultRow row{.resolution = "psi/Lc 0.5, 1, 2, 4",
                  .quantity = angle < 90
                                  ? "wetting wall (60 degrees) attracts: pull off f cot(angle) exp(-psi/Lc)"
                                  : "wall that is not wetted (120 degrees) repels: pull off the same",
                  .reference = "slope of the meniscus times the load",
                  .source = "exact"};
    rows.push_back(aimAtMost(row, rightWay ? worst : std::numeric_limits<double>::quiet_NaN(), 1e-6, "-"));
  }
  return rows;
}

}  // namespace

std::vector<Study> attractionStudies() {
  return {{"W1", "capillary attraction", 1, pairForce},
          {"W2", "two bubbles drawing together", 5, approach},
          {"W4", "attraction of walls", 1, atWalls}};
}

}  // namespace spume::apps
