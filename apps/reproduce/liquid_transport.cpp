#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "apps/reproduce/liquid_studies.h"
#include "apps/reproduce/transport_bench.h"
#include "fluid/level_set.h"
#include "fluid/reinitialize.h"
#include "fluid/sampling.h"

namespace spume::apps {
namespace {

/// A case at a resolution and what is asked of it.
struct Asked {
  Carriage carriage = {};
  double volumeLimit = 0, shapeLimit = 0;  ///< 0: reported only
  std::string volumeReference = {}, shapeReference = {};
};

/// Figure with an aim, or without one where `limit` is 0.
ResultRow finished(ResultRow r, double figure, double limit, const std::string& unit) {
  return limit > 0 ? aimAtMost(r, figure, limit, unit) : reportOnly(r, figure, unit);
}

constexpr const char* kVolumeSource = "PLS, Enright et al. 2002, from memory";
constexpr const char* kShapeSource = "published, see accuracy cases";

/// Volume and shape of a round trip, with the mean distance of the surfaces and the thickest part that is
/// lost.
std::vector<ResultRow> roundTrip(const fluid::TransportCase& scene, const fluid::TransportOptions& options,
                                 const Asked& asked, const fluid::TransportResult& result) {
  const std::string resolution = resolutionOf(scene, options);
  ResultRow volume = transportRow(resolution, scene.planar ? "area change" : "volume change",
                                  asked.volumeReference, kVolumeSource);
  ResultRow shape = transportRow(resolution, "shape error E1", asked.shapeReference, kShapeSource);
  const double dx = scene.size.maxCoeff() / options.cells;
  char text[128];
  std::snprintf(text, sizeof text, "mean distance of the surfaces %.2g dx, thickest part lost %.2g dx",
                result.interfaceError / dx, result.lostThickness / dx);
  shape.note = text;
  return {finished(volume, 100 * result.volumeChange, asked.volumeLimit, "%"),
          finished(shape, result.shapeError, asked.shapeLimit, scene.planar ? "L^2" : "L^3")};
}

Study transportStudy(const std::string& key, const fluid::TransportCase& scene, const Asked& asked,
                     double cost) {
  return {key, scene.name, cost, [=](const StudyContext&) {
            const fluid::TransportOptions options = optionsFor(asked.carriage);
            return roundTrip(scene, options, asked, fluid::runTransport(scene, options));
          }};
}

/// Distance [dx] from a point of the plane to the surface of a slab, from samples much finer than the grid.
double distanceToSurface(const fluid::LiquidState& state, const Eigen::Vector3d& point) {
  constexpr int kPerCell = 40, kReach = 3 * kPerCell;
  const fluid::FieldView phi(state.phi);
  const Eigen::Vector3f at = state.grid.toCells(point).cast<float>();
  const float middle = 0.5f * static_cast<float>(state.grid.cells.z());
  const auto sign = [&](int i, int j) {
    return fluid::sampleCentred(phi, at.x() + static_cast<float>(i) / kPerCell,
                                at.y() + static_cast<float>(j) / kPerCell, middle) < 0;
  };
  double nearest = kReach;
  for (int i = -kReach; i < kReach; ++i)
    for (int j = -kReach; j < kReach; ++j)
      if (sign(i, j) != sign(i + 1, j) || sign(i, j) != sign(i, j + 1))
        nearest = std::min(nearest, std::hypot(i, j));
  return nearest / kPerCell;
}

/// L1: the slotted disk, and how far its four corners have been rounded off: those that end the slot and
/// those of its mouth; with as many markers as Enright et al. give a cell in space, too.
std::vector<ResultRow> slottedDisk(const StudyContext&) {
  const fluid::TransportCase scene = fluid::zalesakDisk();
  const double rim = 75 - std::sqrt(15 * 15 - 2.5 * 2.5);
  std::vector<ResultRow> rows;
  for (const int markers : {16, 64}) {
    const Asked asked{{.cells = 100, .markers = markers}, 0.3, 0, "0.31 %", ""};
    const fluid::TransportOptions options = optionsFor(asked.carriage);
    const fluid::TransportResult result = fluid::runTransport(scene, options);
    const auto worse = [&](double y) {
      return std::max(distanceToSurface(result.state, {47.5, y, 0}),
                      distanceToSurface(result.state, {52.5, y, 0}));
    };
    for (const ResultRow& r : roundTrip(scene, options, asked, result)) rows.push_back(r);
    ResultRow inner =
        transportRow(resolutionOf(scene, options),
                     "distance of the surface from the slot's two corners, the worse", "zero", "exact");
    inner.note = "values at cell centres round off the exact disk by 0.13 to 0.41 dx, as it is turned";
    ResultRow outer =
        transportRow(resolutionOf(scene, options), "the same for the edges of its mouth", "zero", "exact");
    rows.push_back(aimAtMost(inner, worse(85), 0.5, "dx"));
    rows.push_back(reportOnly(outer, worse(rim), "dx"));
  }
  return rows;
}

/// L1b: Rudman's disk; his error is relative to the disk's area.
std::vector<ResultRow> rudmanDisk(const StudyContext&) {
  const fluid::TransportCase scene = fluid::rudmanDisk();
  const Asked asked{{.cells = 200}, 0, 0, "", ""};
  const fluid::TransportOptions options = optionsFor(asked.carriage);
  const fluid::TransportResult result = fluid::runTransport(scene, options);
  std::vector<ResultRow> rows = roundTrip(scene, options, asked, result);
  const fluid::GridSpec& grid = result.state.grid;
  const fluid::DenseField<float> exact = fluid::sampledFraction(grid, scene.phi0);
  double area = 0;
  for (int i = 0; i < grid.cells.x(); ++i)
    for (int j = 0; j < grid.cells.y(); ++j) area += exact(i, j, 0) * grid.dx * grid.dx;
  ResultRow relative = transportRow(resolutionOf(scene, options), "shape error E1, of the disk's area",
                                    "EMFPA-SIR 8.7e-3, Youngs 1.07e-2, THINC/QQ 1.42e-2", kShapeSource);
  rows.push_back(aimAtMost(relative, result.shapeError / area, 1e-2, ""));
  return rows;
}

/// Length of the steps at which L5 asks for the accuracy of the high-order run, and one that mostly gives it
/// in that time.
constexpr double kLongCfl = 4.9, kMiddleCfl = 2.5;

/// Shape and time of a semi-Lagrangian run beside those of the high-order one, asked for or only told.
void addRatios(const fluid::TransportCase& scene, const fluid::TransportOptions& options,
               const fluid::TransportResult& result, const fluid::TransportResult& fine, bool asked,
               std::vector<ResultRow>& rows) {
  const std::string resolution = resolutionOf(scene, options);
  ResultRow shape = transportRow(resolution, "shape error E1, of that of WENO5 at CFL 0.5", "", "");
  ResultRow time = transportRow(resolution, "wall time, of that run's", "", "");
  rows.push_back(finished(shape, result.shapeError / fine.shapeError, asked ? 1.3 : 0, ""));
  rows.push_back(finished(time, result.seconds / fine.seconds, asked ? 0.2 : 0, ""));
  if (!asked || scene.timeFactor) return;  // a flow that turns back takes its errors back, too
  const double perStep = 2 * std::numbers::pi / result.steps;  // [rad]
  char text[128];
  std::snprintf(text, sizeof text, "%.2g rad a step: the midpoint rule turns %.2g rad too far in all",
                perStep, result.steps * std::pow(perStep, 3) / 6);
  rows[rows.size() - 2].note = text;
}

/// L5: the semi-Lagrangian level set with long steps beside the high-order run of the same case.
std::vector<ResultRow> longSteps(const StudyContext&) {
  const std::pair<fluid::TransportCase, int> cases[] = {{fluid::zalesakDisk(), 100},
                                                        {fluid::zalesakSphere(), 100},
                                                        {fluid::singleVortex(), 128},
                                                        {fluid::enrightDeformation(), 64}};
  std::vector<ResultRow> rows;
  for (const auto& [scene, cells] : cases) {
    const fluid::TransportResult fine = fluid::runTransport(scene, optionsFor({.cells = cells}));
    std::vector<ResultRow> ofCase;
    for (const double cfl : {kLongCfl, kMiddleCfl}) {
      const fluid::TransportOptions options =
          optionsFor({.cells = cells, .cfl = cfl, .scheme = fluid::LevelSetTransport::semiLagrangian});
      const fluid::TransportResult quick = fluid::runTransport(scene, options);
      if (cfl == kLongCfl) ofCase = roundTrip(scene, options, {}, quick);
      addRatios(scene, options, quick, fine, cfl == kLongCfl, ofCase);
    }
    for (ResultRow& r : ofCase) r.title = scene.name + ", long steps";
    rows.insert(rows.end(), ofCase.begin(), ofCase.end());
  }
  return rows;
}

/// One choice of transport on the Enright deformation: its shape error, beside what it costs and loses.
ResultRow choice(const Carriage& carriage) {
  const fluid::TransportResult result =
      fluid::runTransport(fluid::enrightDeformation(), optionsFor(carriage));
  char text[128];
  std::snprintf(text, sizeof text, "%d^3, %s, CFL %.2g, %d markers a cell", carriage.cells,
                nameOf(carriage.scheme), carriage.cfl, carriage.markers);
  ResultRow r = transportRow(text, "shape error E1", "", "");
  std::snprintf(text, sizeof text, "volume %+.2f %%, %d steps of %.1f ms", 100 * result.volumeChange,
                result.steps, 1e3 * result.seconds / result.steps);
  r.note = text;
  return reportOnly(r, result.shapeError, "L^3");
}

/// What each choice of transport costs and gives: for who trades accuracy for speed.
std::vector<ResultRow> transportChoices(const StudyContext&) {
  using enum fluid::LevelSetTransport;
  std::vector<ResultRow> rows;
  for (const int cells : {32, 64}) {
    for (const int markers : {0, 8, 16, 32, 64})
      rows.push_back(choice({cells, 4.9, semiLagrangian, markers}));
    for (const int markers : {0, 16, 64}) rows.push_back(choice({cells, 0.5, semiLagrangian, markers}));
    for (const int markers : {0, 16, 64}) rows.push_back(choice({cells, 0.5, weno5, markers}));
  }
  return rows;
}

/// L9: how well a distance is kept when it is made one again and again.
std::vector<ResultRow> signedDistance(const StudyContext&) {
  constexpr int kCells = 48, kTimes = 50;
  constexpr double kRadius = 0.3, kBand = 3;
  const fluid::GridSpec grid{Eigen::Vector3i::Constant(kCells), 1.0 / kCells, Eigen::Vector3d::Zero()};
  const Eigen::Vector3d centre(0.51, 0.493, 0.478);
  fluid::DenseField<float> phi;
  fluid::initialiseLevelSet(
      grid, [&](const Eigen::Vector3d& x) { return (x - centre).norm() - kRadius; }, phi);
  const fluid::DenseField<float> before = phi;
  fluid::Reinitializer reinitializer(grid);
  for (int n = 0; n < kTimes; ++n) reinitializer.apply(phi);
  double slope = 0, shift = 0;
  for (int i = 1; i + 1 < kCells; ++i)
    for (int j = 1; j + 1 < kCells; ++j)
      for (int k = 1; k + 1 < kCells; ++k) {
        const double distance = std::abs(before(i, j, k)) / grid.dx;
        if (distance > kBand) continue;
        const Eigen::Vector3d gradient(phi(i + 1, j, k) - phi(i - 1, j, k),
                                       phi(i, j + 1, k) - phi(i, j - 1, k),
                                       phi(i, j, k + 1) - phi(i, j, k - 1));
        slope = std::max(slope, std::abs(gradient.norm() / (2 * grid.dx) - 1));
        if (distance < 1) shift = std::max(shift, std::abs(phi(i, j, k) - before(i, j, k)) / grid.dx);
      }
  ResultRow steepness =
      transportRow("48^3, radius 14 dx", "largest error of the slope within 3 dx, 50 times", "zero", "exact");
  ResultRow place =
      transportRow("48^3, radius 14 dx", "largest shift of the surface, 50 times", "zero", "exact");
  return {aimAtMost(steepness, 100 * slope, 2, "%"), aimAtMost(place, shift, 0.02, "dx")};
}

}  // namespace

std::vector<Study> transportStudies() {
  return {{"L1", "zalesak disk", 40, slottedDisk},
          {"L1b", "slotted disk of Rudman", 250, rudmanDisk},
          transportStudy("L2", fluid::zalesakSphere(),
                         {.carriage = {.cells = 100},
                          .volumeLimit = 1,
                          .shapeLimit = 4.5e-4,
                          .volumeReference = "2 %",
                          .shapeReference = "THINC/QQ 4.67e-4"},
                         300),
          transportStudy("L3", fluid::singleVortex(),
                         {.carriage = {.cells = 128},
                          .volumeLimit = 0.5,
                          .shapeLimit = 1.2e-3,
                          .volumeReference = "0.71 %",
                          .shapeReference = "EMFPA 1.07e-3, THINC/QQ 3.06e-3"},
                         60),
          transportStudy("L4", fluid::enrightDeformation(),
                         {.carriage = {.cells = 64},
                          .volumeLimit = 3,
                          .shapeLimit = 2.5e-3,
                          .volumeReference = "2.6 % (100^3)",
                          .shapeReference = "FMFPA 2.79e-3, THINC/QQ 2.89e-3"},
                         120),
          transportStudy("L4b", fluid::enrightDeformation(),
                         {.carriage = {.cells = 128},
                          .volumeLimit = 1,
                          .shapeLimit = 7e-4,
                          .volumeReference = "2.6 % (100^3)",
                          .shapeReference = "LVIRA 6.37e-4, FMFPA 7.14e-4, THINC/QQ 9.05e-4"},
                         500),
          {"L5", "long steps", 150, longSteps},
          {"L45", "enright deformation, choices of transport", 150, transportChoices},
          {"L9", "signed distance", 10, signedDistance}};
}

}  // namespace spume::apps
