#pragma once

#include <string>

#include "apps/reproduce/result_table.h"
#include "fluid/transport_study.h"

namespace spume::apps {

/// Smallest marker radius of these runs [dx]: the closest-point reinitialisation holds surfaces well enough
/// that markers may speak up from here on; flows full of spray are run with the larger one of the defaults.
inline constexpr double kFineRadius = 0.03;

/// How a surface is carried.
struct Carriage {
  int cells = 64;
  double cfl = 0.5;
  fluid::LevelSetTransport scheme = fluid::LevelSetTransport::weno5;
  int markers = 16;  ///< a cell; 0: none
};

inline fluid::TransportOptions optionsFor(const Carriage& carriage) {
  fluid::TransportOptions options;
  options.cells = carriage.cells;
  options.cfl = carriage.cfl;
  options.markers = carriage.markers > 0;
  if (options.markers) options.params.markersPerCell = carriage.markers;
  options.params.reseedInterval = 20;
  options.params.markerRadiusMin = kFineRadius;
  options.params.levelSetTransport = carriage.scheme;
  return options;
}

inline const char* nameOf(fluid::LevelSetTransport scheme) {
  return scheme == fluid::LevelSetTransport::weno5 ? "WENO5" : "semi-Lagrangian";
}

inline std::string resolutionOf(const fluid::TransportCase& scene, const fluid::TransportOptions& options) {
  return std::to_string(options.cells) + (scene.planar ? "^2, " : "^3, ") +
         nameOf(options.params.levelSetTransport) + ", " + std::to_string(options.params.markersPerCell) +
         " markers a cell from 0.03 dx, CFL " + std::to_string(options.cfl).substr(0, 3);
}

inline ResultRow transportRow(const std::string& resolution, const std::string& quantity,
                              const std::string& reference, const std::string& source) {
  ResultRow r;
  r.resolution = resolution;
  r.quantity = quantity;
  r.reference = reference;
  r.source = source;
  return r;
}

}  // namespace spume::apps
