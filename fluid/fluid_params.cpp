#include "fluid/fluid_params.h"

#include <cstdio>
#include <string>

#include "fluid/errors.h"

namespace spume::fluid {
namespace {

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

/// NaN is out of every range.
void require(const char* field, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;
  throw InvalidParameter(std::string("liquid.") + field + " = " + text(value) + " is out of range: choose " +
                         text(low) + " to " + text(high) + (*unit ? std::string(" ") + unit : ""));
}

}  // namespace

void FluidParams::validate() const {
  for (int a = 0; a < 3; ++a) require("gravity", gravity[a], -1000, 1000, "m/s^2");
  require("density", density, 1, 20000, "kg/m^3");
  require("cfl", cfl, 0.2, 10, "");
  require("markersPerCell", markersPerCell, 8, 64, "");
  require("markerBand", markerBand, 2, 5, "cells");
  require("markerRadiusMin", markerRadiusMin, 0.01, 0.5, "dx");
  require("markerRadiusMax", markerRadiusMax, markerRadiusMin, 1, "dx");
  require("reseedInterval", reseedInterval, 1, 1000, "sub-steps");
  require("escapeDepth", escapeDepth, 0.5, 3, "dx");
  require("impactReach", impactReach, 1e-4, 1, "m");
  require("pressureTolerance", pressureTolerance, 1e-12, 1e-2, "");
  require("pressureIterations", pressureIterations, 1, 10000, "");
  require("volumeControlTime", volumeControlTime, 0.001, 10, "s");
  require("viscosity", viscosity, 0, 1e4, "Pa s");
  require("surfaceTension", surfaceTension, 0, 10, "N/m");
}

}  // namespace spume::fluid
