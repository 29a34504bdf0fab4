#include "coupling/unused_keys.h"

#include "foam/presets.h"

namespace spume::coupling {
namespace {

using foam::FoamParams;

/// A key that counts only under a condition; `cause` is the key that decides.
struct ConditionalKey {
  const char* name;
  bool (*differs)(const FoamParams& given, const FoamParams& preset);
  bool (*counts)(const FoamParams& given);
  const char* cause;
};

template <auto member>
bool differs(const FoamParams& given, const FoamParams& preset) {
  return given.*member != preset.*member;
}

template <auto member, auto value>
bool is(const FoamParams& given) {
  return given.*member == value;
}

const ConditionalKey kConditionalKeys[] = {
    {"drag_coefficient", differs<&FoamParams::dragCoefficient>,
     is<&FoamParams::dragLaw, foam::DragLaw::coefficient>, "foam.drag_law is not \"coefficient\""},
    {"drag_coefficient_limit", differs<&FoamParams::dragCoefficientLimit>,
     is<&FoamParams::dragLaw, foam::DragLaw::coefficient>, "foam.drag_law is not \"coefficient\""},
    {"air_drag_coefficient", differs<&FoamParams::airDragCoefficient>,
     is<&FoamParams::airDragLaw, foam::AirDragLaw::coefficient>, "foam.air_drag_law is not \"coefficient\""},
    {"spring_stiffness", differs<&FoamParams::springStiffness>,
     is<&FoamParams::springFromSurfaceTension, false>, "foam.spring_from_surface_tension is true"},
    {"attraction", differs<&FoamParams::attraction>,
     is<&FoamParams::attractionLaw, foam::AttractionLaw::coefficient>,
     "foam.attraction_law is not \"coefficient\""},
    {"wetness_aloft", differs<&FoamParams::wetnessAloft>,
     is<&FoamParams::wetnessLaw, foam::WetnessLaw::height>, "foam.wetness_law is not \"height\""},
    {"wetness_height", differs<&FoamParams::wetnessHeight>,
     is<&FoamParams::wetnessLaw, foam::WetnessLaw::height>, "foam.wetness_law is not \"height\""},
    {"volume_tolerance", differs<&FoamParams::volumeTolerance>,
     is<&FoamParams::volumeMode, foam::VolumeMode::newton>, "foam.volume_mode is not \"newton\""},
    {"burst_median_life", differs<&FoamParams::burstMedianLife>, is<&FoamParams::bursting, true>,
     "foam.bursting is false"},
};

}  // namespace

void noteUnusedKeys(const Scene& scene, FindingList& findings) {
  const FoamParams preset = foam::makePreset(scene.preset);
  for (const ConditionalKey& key : kConditionalKeys)
    if (key.differs(scene.foam, preset) && !key.counts(scene.foam))
      findings.note(std::string("foam.") + key.name, "does nothing: ", key.cause);
  if (scene.stillPool.enabled && !scene.liquidBodies.empty())
    findings.note("liquid_body",
                  "does nothing: a pool at rest is all the liquid of the scene; set "
                  "still_pool.level");
  if (!scene.stillPool.enabled && scene.stillPool.level != StillPoolSpec{}.level)
    findings.note("still_pool.level", "does nothing: still_pool.enabled is false");
}

}  // namespace spume::coupling
