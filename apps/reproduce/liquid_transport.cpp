#include <algorithm>
#include <cmath>
#include <string>

#include "apps/reproduce/liquid_studies.h"
#include "fluid/transport_study.h"

namespace spume::apps {
namespace {

/// A row of accuracy: what is asked of a case at a resolution.
struct Asked {
  int cells = 64;
  double cfl = 0.5;
  double volumeLimit = 0, shapeLimit = 0;  ///< 0: reported only
  std::string volumeReference = {}, shapeReference = {};
};

ResultRow row(const std::string& resolution, const std::string& quantity, const std::string& reference,
              const std::string& source) {
  ResultRow r;
  r.resolution = resolution;
  r.quantity = quantity;
  r.reference = reference;
  r.source = source;
  return r;
}

/// Figure with an aim, or without one where `limit` is 0.
ResultRow finished(ResultRow r, double figure, double limit, const std::string& unit) {
  return limit > 0 ? aimAtMost(r, figure, limit, unit) : reportOnly(r, figure, unit);
}

std::string resolutionOf(const fluid::TransportCase& scene, const fluid::TransportOptions& options) {
  return std::to_string(options.cells) + (scene.planar ? "^2, " : "^3, ") +
         std::to_string(options.params.markersPerCell) + " markers a cell, CFL " +
         std::to_string(options.cfl).substr(0, 3);
}

fluid::TransportOptions optionsFor(const Asked& asked, int markers) {
  fluid::TransportOptions options;
  options.cells = asked.cells;
  options.cfl = asked.cfl;
  options.params.markersPerCell = markers;
  options.params.reseedInterval = 20;
  return options;
}

std::vector<ResultRow> transport(const fluid::TransportCase& scene, const Asked& asked, int markers) {
  constexpr const char* kVolumeSource = "PLS, Enright et al. 2002, from memory";
  constexpr const char* kShapeSource = "published, see accuracy cases";
  const fluid::TransportOptions options = optionsFor(asked, markers);
  const fluid::TransportResult result = fluid::runTransport(scene, options);
  const std::string resolution = resolutionOf(scene, options);
  const char* const what = scene.planar ? "area change" : "volume change";
  return {finished(row(resolution, what, asked.volumeReference, kVolumeSource), 100 * result.volumeChange,
                   asked.volumeLimit, "%"),
          finished(row(resolution, "shape error E1", asked.shapeReference, kShapeSource), result.shapeError,
                   asked.shapeLimit, scene.planar ? "L^2" : "L^3")};
}

Study transportStudy(const std::string& key, const fluid::TransportCase& scene, const Asked& asked,
                     double cost, int markers = 16) {
  return {key, scene.name, cost, [=](const StudyContext&) { return transport(scene, asked, markers); }};
}

/// Sphere carried across the box and back along a skew line; 5 crossings.
fluid::TransportCase translation(double radius) {
  fluid::TransportCase scene;
  scene.name = "sub-cell translation";
  scene.size = {1, 0.5, 0.5};
  scene.duration = 5;
  scene.phi0 = [=](const Eigen::Vector3d& x) {
    return (x - Eigen::Vector3d(0.3, 0.2, 0.22)).norm() - radius;
  };
  scene.velocity = [](const Eigen::Vector3d&) { return Eigen::Vector3d(0.4, 0.13, 0.07); };
  scene.timeFactor = [](double t) { return std::fmod(t, 2) < 1 ? 1.0 : -1.0; };
  return scene;
}

std::vector<ResultRow> subCellTranslation(const StudyContext&) {
  constexpr int kCells = 48;
  const auto carried = [](double radius, const std::string& quantity) {
    fluid::TransportCase scene = translation(radius / kCells);
    scene.duration = 4;  // two ways there and back, 77 cells in all
    const fluid::TransportOptions options = optionsFor({.cells = kCells, .cfl = 0.7}, 16);
    ResultRow r = row(resolutionOf(scene, options), quantity, "zero", "exact");
    return reportOnly(r, 100 * fluid::runTransport(scene, options).volumeChange, "%");
  };
  ResultRow large = carried(3, "volume change, radius 3 dx"),
            small = carried(1.5, "volume change, radius 1.5 dx");
  small.aim = "survives";
  small.verdict = small.figure > -100 ? Verdict::met : Verdict::missed;
  return {aimAtMost(large, large.figure, 1, "%"), small};
}

}  // namespace

std::vector<Study> transportStudies() {
  return {transportStudy("L1", fluid::zalesakDisk(),
                         {.cells = 100, .volumeLimit = 0.3, .volumeReference = "0.31 %"}, 40),
          transportStudy("L1b", fluid::zalesakDisk(),
                         {.cells = 200,
                          .volumeReference = "0.20 %",
                          .shapeReference = "PLIC 8.7e-3 of the box of 4, = 5.4 here"},
                         250),
          transportStudy("L2", fluid::zalesakSphere(),
                         {.cells = 100,
                          .volumeLimit = 1,
                          .shapeLimit = 4.5e-4,
                          .volumeReference = "2 %",
                          .shapeReference = "THINC/QQ 4.67e-4"},
                         300),
          transportStudy("L3", fluid::singleVortex(),
                         {.cells = 128,
                          .volumeLimit = 0.5,
                          .shapeLimit = 1.2e-3,
                          .volumeReference = "0.71 %",
                          .shapeReference = "EMFPA 1.07e-3, THINC/QQ 3.06e-3"},
                         60),
          transportStudy("L4", fluid::enrightDeformation(),
                         {.cells = 64,
                          .volumeLimit = 3,
                          .shapeLimit = 2.5e-3,
                          .volumeReference = "2.6 % (100^3)",
                          .shapeReference = "FMFPA 2.79e-3, THINC/QQ 2.89e-3"},
                         120),
          transportStudy("L5", fluid::enrightDeformation(),
                         {.cells = 64,
                          .cfl = 4.9,
                          .volumeReference = "2.6 % (100^3)",
                          .shapeReference = "1.3 times L4 at a fifth of its time"},
                         20),
          {"L8", "sub-cell translation", 20, subCellTranslation}};
}

}  // namespace spume::apps
