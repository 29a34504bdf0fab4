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

bool attracts(const FoamParams& given) { return given.attractionLaw != foam::AttractionLaw::none; }
bool wallsDelayBursting(const FoamParams& given) { return given.bursting && given.burstWallFactor != 1; }

constexpr char kNoAttraction[] = "foam.attraction_law is \"none\"";
constexpr char kNoBursting[] = "foam.bursting is false";

const ConditionalKey kConditionalKeys[] = {
    {"drag_coefficient", differs<&FoamParams::dragCoefficient>,
     is<&FoamParams::dragLaw, foam::DragLaw::coefficient>, "foam.drag_law is not \"coefficient\""},
    {"drag_coefficient_limit", differs<&FoamParams::dragCoefficientLimit>,
     is<&FoamParams::dragLaw, foam::DragLaw::coefficient>, "foam.drag_law is not \"coefficient\""},
    {"air_drag_coefficient", differs<&FoamParams::airDragCoefficient>,
     is<&FoamParams::airDragLaw, foam::AirDragLaw::coefficient>, "foam.air_drag_law is not \"coefficient\""},
    {"spring_stiffness", differs<&FoamParams::springStiffness>,
     is<&FoamParams::springFromSurfaceTension, false>, "foam.spring_from_surface_tension is true"},
    {"spring_surface_tension_factor", differs<&FoamParams::springSurfaceTensionFactor>,
     is<&FoamParams::springFromSurfaceTension, true>, "foam.spring_from_surface_tension is false"},
    {"gas_viscosity", differs<&FoamParams::gasViscosity>,
     is<&FoamParams::airDragLaw, foam::AirDragLaw::stokes>, "foam.air_drag_law is not \"stokes\""},
    {"weak_pairs", differs<&FoamParams::weakPairs>, attracts, kNoAttraction},
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
     kNoBursting},
    {"burst_reference_radius", differs<&FoamParams::burstReferenceRadius>, is<&FoamParams::bursting, true>,
     kNoBursting},
    {"burst_shape", differs<&FoamParams::burstShape>, is<&FoamParams::bursting, true>, kNoBursting},
    {"burst_wall_factor", differs<&FoamParams::burstWallFactor>, is<&FoamParams::bursting, true>,
     kNoBursting},
    {"burst_wall_distance", differs<&FoamParams::burstWallDistance>, wallsDelayBursting,
     "foam.bursting is false or foam.burst_wall_factor is 1"},
};

/// The same of how bubbles take to one solid, whose table is `table`.
void noteUnusedOf(const foam::SolidSurface& solid, const FoamParams& foam, const std::string& table,
                  FindingList& findings) {
  const foam::SolidSurface standard;
  const auto note = [&](const char* key, bool isSet, bool counts, const std::string& cause) {
    if (isSet && !counts) findings.note(table + "." + key, "does nothing: ", cause);
  };
  note("adhesion", solid.adhesion != standard.adhesion, solid.detachRadius > 0,
       table + ".detach_radius is 0: nothing sticks");
  note("detach_radius", solid.detachRadius != standard.detachRadius, solid.adhesion > 0,
       table + ".adhesion is 0: nothing sticks");
  note("attraction", solid.attraction != standard.attraction,
       foam.attractionLaw == foam::AttractionLaw::coefficient, "foam.attraction_law is not \"coefficient\"");
  note("contact_angle", solid.contactAngle != standard.contactAngle,
       foam.attractionLaw == foam::AttractionLaw::capillary, "foam.attraction_law is not \"capillary\"");
}

}  // namespace

void noteUnusedKeys(const Scene& scene, FindingList& findings) {
  const FoamParams preset = foam::makePreset(scene.preset);
  for (const ConditionalKey& key : kConditionalKeys)
    if (key.differs(scene.foam, preset) && !key.counts(scene.foam))
      findings.note(std::string("foam.") + key.name, "does nothing: ", key.cause);
  noteUnusedOf(scene.foam.walls, scene.foam, "foam.walls", findings);
  for (std::size_t i = 0; i < scene.solids.size(); ++i)
    noteUnusedOf(scene.solids[i].surface, scene.foam, "solid." + std::to_string(i), findings);
  if (scene.stillPool.enabled && !scene.liquidBodies.empty())
    findings.note("liquid_body",
                  "does nothing: a pool at rest is all the liquid of the scene; set "
                  "still_pool.level");
  if (!scene.stillPool.enabled && scene.stillPool.level != StillPoolSpec{}.level)
    findings.note("still_pool.level", "does nothing: still_pool.enabled is false");
}

}  // namespace spume::coupling
