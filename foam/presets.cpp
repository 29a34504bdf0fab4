#include "foam/presets.h"

namespace spume::foam {
namespace {

FoamParams paperPreset() {
  FoamParams params;
  params.springStiffness = 2;
  params.springFromSurfaceTension = false;
  params.dragLaw = DragLaw::coefficient;
  params.dragCoefficient = 500;
  params.dragCoefficientLimit = 2.5e-3;  // above it a bubble of 500 kg/m^3 rises twice as fast as a real one
  params.buoyancyLaw = BuoyancyLaw::hydrostatic;
  params.airDragLaw = AirDragLaw::coefficient;
  params.attractionLaw = AttractionLaw::coefficient;
  return params;
}

FoamParams physicalPreset() {
  FoamParams params;
  params.springFromSurfaceTension = true;
  params.dragLaw = DragLaw::contaminated;
  params.buoyancyLaw = BuoyancyLaw::pressureGradient;
  params.airDragLaw = AirDragLaw::stokes;
  params.attractionLaw = AttractionLaw::capillary;
  return params;
}

}  // namespace

FoamParams makePreset(Preset preset) { return preset == Preset::paper ? paperPreset() : physicalPreset(); }

}  // namespace spume::foam
