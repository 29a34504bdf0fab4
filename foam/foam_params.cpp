#include "foam/foam_params.h"

#include <cmath>
#include <sstream>

#include "foam/errors.h"

namespace spume::foam {
namespace {

void requireRange(const char* name, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;
  std::ostringstream message;
  message << "foam." << name << " = " << value << ": must lie in [" << low << ", " << high << "] " << unit;
  throw InvalidParameter(message.str());
}

void requireMaterials(const FoamParams& p) {
  // 1e4 m/s^2 is a thousand times the Earth's: room for every stress test, none for a lost unit.
  requireRange("gravity (length)", p.gravity.norm(), 0, 1e4, "m/s^2");
  requireRange("density", p.density, 1, 20000, "kg/m^3");
  requireRange("gasDensity", p.gasDensity, 0, 1000, "kg/m^3");
  requireRange("viscosity", p.viscosity, 1e-5, 100, "Pa s");
  requireRange("gasViscosity", p.gasViscosity, 0, 1, "Pa s");
  requireRange("surfaceTension", p.surfaceTension, 0.001, 1, "N/m");
}

void requireStructure(const FoamParams& p) {
  requireRange("wetness", p.wetness, 0, 1, "");
  requireRange("wetnessAloft", p.wetnessAloft, 0, 1, "");
  requireRange("wetnessHeight", p.wetnessHeight, 1e-6, 1e6, "m");
  requireRange("springStiffness", p.springStiffness, 0, 1e7, "N/m");
  requireRange("springSurfaceTensionFactor", p.springSurfaceTensionFactor, 0.5, 1, "");
  requireRange("springFloor", p.springFloor, 0, 1000, "");
  requireRange("contactDamping", p.contactDamping, 0, 5, "");
  requireRange("borderRate", p.borderRate, 0, 100, "1/s");
  requireRange("volumeRate", p.volumeRate, 0, 1000, "1/s");
  requireRange("volumeTolerance", p.volumeTolerance, 1e-10, 0.1, "");
  requireRange("radiusLimit", p.radiusLimit, 1.1, 10, "");
}

void requireSurroundings(const FoamParams& p) {
  requireRange("dragCoefficient", p.dragCoefficient, 0, 1e5, "kg/m^3");
  requireRange("dragCoefficientLimit", p.dragCoefficientLimit, 0, 1, "m");
  requireRange("airDragCoefficient", p.airDragCoefficient, 0, 1e3, "kg/s");
  requireRange("addedMass", p.addedMass, 0, 2, "");
  requireRange("liquidAdhesion", p.liquidAdhesion, 0, 100, "N/m");
  requireRange("attraction", p.attraction, 0, 1, "N");
  requireRange("wallStiffnessFactor", p.wallStiffnessFactor, 0, 1000, "");
}

void requireSolid(const SolidSurface& solid) {
  requireRange("solid.adhesion", solid.adhesion, 0, 100, "N/m");
  requireRange("solid.detachRadius", solid.detachRadius, 0, 1, "m");
  requireRange("solid.attraction", solid.attraction, 0, 1, "N m");
  requireRange("solid.contactAngle", solid.contactAngle, 0, 180, "degrees");
}

void requireLifeAndSolver(const FoamParams& p) {
  requireRange("burstMedianLife", p.burstMedianLife, 1e-3, 1e9, "s");
  requireRange("burstReferenceRadius", p.burstReferenceRadius, 1e-6, 1, "m");
  requireRange("burstShape", p.burstShape, 0.5, 10, "");
  requireRange("burstWallFactor", p.burstWallFactor, 0, 1, "");
  requireRange("burstWallDistance", p.burstWallDistance, 1e-6, 1, "m");
  requireRange("solverTolerance", p.solverTolerance, 1e-12, 1e-1, "");
  requireRange("solverIterations", p.solverIterations, 1, 100000, "");
}

}  // namespace

void FoamParams::validate() const {
  requireMaterials(*this);
  requireStructure(*this);
  requireSurroundings(*this);
  requireSolid(walls);
  for (const SolidSurface& solid : solids) requireSolid(solid);
  requireLifeAndSolver(*this);
  if (gasDensity == 0 && addedMass == 0)
    throw InvalidParameter(
        "foam.gasDensity and foam.addedMass are both 0: an immersed bubble has no inertia");
}

}  // namespace spume::foam
