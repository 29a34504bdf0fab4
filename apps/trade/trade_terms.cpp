#include "apps/trade/trade_terms.h"

#include <algorithm>

namespace spume::apps {
namespace {

using coupling::Overrides;
using coupling::Scene;

/// A term that one or two keys switch off, whether it is at work, and what takes its place.
struct Term {
  const char *name, *title;
  Overrides off;
  bool (*works)(const Scene&);
  const char* without = "off";
};

const std::vector<Term>& foamTerms() {
  static const std::vector<Term> kTerms{
      {"drag",
       "drag of the liquid",
       {{"foam.drag_law", "coefficient"}, {"foam.drag_coefficient", "0"}},
       [](const Scene& s) {
         return s.foam.dragLaw != foam::DragLaw::coefficient || s.foam.dragCoefficient > 0;
       }},
      {"dirt",
       "contaminated water",
       {{"foam.drag_law", "clean"}},
       [](const Scene& s) { return s.foam.dragLaw == foam::DragLaw::contaminated; },
       "clean"},
      {"added_mass",
       "added mass",
       {{"foam.added_mass", "0"}},
       [](const Scene& s) { return s.foam.addedMass > 0; }},
      {"pressure_gradient",
       "buoyancy from the liquid's pressure",
       {{"foam.buoyancy_law", "hydrostatic"}},
       [](const Scene& s) {
         return s.solvesLiquid() && s.foam.buoyancyLaw == foam::BuoyancyLaw::pressureGradient;
       },
       "hydrostatic"},
      {"air_drag",
       "drag of the air",
       {{"foam.air_drag_law", "coefficient"}, {"foam.air_drag_coefficient", "0"}},
       [](const Scene& s) {
         return s.foam.airDragLaw != foam::AirDragLaw::coefficient || s.foam.airDragCoefficient > 0;
       }},
      {"adhesion",
       "adhesion to the liquid's surface",
       {{"foam.liquid_adhesion", "0"}},
       [](const Scene& s) { return s.foam.liquidAdhesion > 0; }},
      {"attraction",
       "attraction of floating bubbles and walls",
       {{"foam.attraction_law", "none"}},
       [](const Scene& s) { return s.foam.attractionLaw != foam::AttractionLaw::none; }},
      {"weak_pairs",
       "attraction of floating bubbles to each other",
       {{"foam.weak_pairs", "false"}},
       [](const Scene& s) { return s.foam.attractionLaw != foam::AttractionLaw::none && s.foam.weakPairs; }},
      {"damping",
       "damping of contacts",
       {{"foam.contact_damping", "0"}},
       [](const Scene& s) { return s.foam.contactDamping > 0; }},
      {"dry_aloft",
       "drier films aloft",
       {{"foam.wetness_law", "constant"}},
       [](const Scene& s) {
         return s.foam.wetnessLaw == foam::WetnessLaw::height && s.foam.wetnessAloft != s.foam.wetness;
       },
       "one wetness"},
      {"borders",
       "films that draw to Plateau's law",
       {{"foam.border_rate", "0"}},
       [](const Scene& s) { return s.foam.borderRate > 0; }},
      {"volume_correction",
       "correction of the cells' volumes",
       {{"foam.volume_mode", "relax"}, {"foam.volume_rate", "0"}},
       [](const Scene& s) { return s.foam.volumeMode == foam::VolumeMode::newton || s.foam.volumeRate > 0; }},
      {"bursting", "bursting", {{"foam.bursting", "false"}}, [](const Scene& s) { return s.foam.bursting; }},
      {"wall_bursting",
       "slower bursting at walls",
       {{"foam.burst_wall_factor", "1"}},
       [](const Scene& s) { return s.foam.bursting && s.foam.burstWallFactor < 1; }},
      {"dissolved_gas", "gas in solution", {{"dissolved_gas.enabled", "false"}}, [](const Scene& s) {
         return s.dissolvedGas.enabled;
       }}};
  return kTerms;
}

const std::vector<Term>& liquidTerms() {
  static const std::vector<Term> kTerms{{"immersed_gas",
                                         "room for the bubbles in the liquid",
                                         {{"coupling.immersed_gas", "false"}},
                                         [](const Scene& s) { return s.coupling.immersedGas; }},
                                        {"entrainment",
                                         "bubbles of entrained air",
                                         {{"coupling.entrainment.enabled", "false"}},
                                         [](const Scene& s) { return s.coupling.entrainment.enabled; }},
                                        {"viscosity",
                                         "viscosity of the liquid",
                                         {{"liquid.viscosity", "0"}},
                                         [](const Scene& s) { return s.liquid.viscosity > 0; }},
                                        {"surface_tension",
                                         "surface tension of the liquid",
                                         {{"liquid.surface_tension", "0"}},
                                         [](const Scene& s) { return s.liquid.surfaceTension > 0; }},
                                        {"volume_control",
                                         "control of the liquid's volume",
                                         {{"liquid.volume_control", "false"}},
                                         [](const Scene& s) { return s.liquid.volumeControl; }}};
  return kTerms;
}

void add(const std::vector<Term>& terms, const Scene& scene, std::vector<Dial>& dials) {
  for (const Term& term : terms)
    if (term.works(scene))
      dials.push_back({term.name, term.title, DialKind::term, {{term.without, term.off}}});
}

/// Walls and solids that hold bubbles hold none.
void addHolding(const Scene& scene, std::vector<Dial>& dials) {
  Overrides off;
  if (scene.foam.walls.detachRadius > 0) off.push_back({"foam.walls.detach_radius", "0"});
  for (std::size_t i = 0; i < scene.solids.size(); ++i)
    if (scene.solids[i].surface.detachRadius > 0)
      off.push_back({"solid." + std::to_string(i) + ".detach_radius", "0"});
  if (!off.empty())
    dials.push_back({"holding", "adhesion to walls and solids", DialKind::term, {{"off", off}}});
}

void addTurbulence(const Scene& scene, std::vector<Dial>& dials) {
  Overrides off;
  for (std::size_t i = 0; i < scene.inflows.size(); ++i)
    if (scene.inflows[i].turbulence > 0) off.push_back({"inflow." + std::to_string(i) + ".turbulence", "0"});
  if (!off.empty()) dials.push_back({"turbulence", "roughness of the jets", DialKind::term, {{"off", off}}});
}

void addTwoWay(const Scene& scene, std::vector<Dial>& dials) {
  const bool on = scene.coupling.twoWay;
  dials.push_back({"two_way",
                   "push of the bubbles on the liquid",
                   DialKind::term,
                   {{on ? "off" : "on", {{"coupling.two_way", on ? "false" : "true"}}}}});
}

}  // namespace

std::vector<Dial> termsOf(const Scene& scene) {
  std::vector<Dial> dials;
  add(foamTerms(), scene, dials);
  addHolding(scene, dials);
  if (!scene.solvesLiquid()) return dials;
  add(liquidTerms(), scene, dials);
  addTurbulence(scene, dials);
  addTwoWay(scene, dials);
  return dials;
}

}  // namespace spume::apps
