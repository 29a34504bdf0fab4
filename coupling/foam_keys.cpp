#include "coupling/foam_keys.h"

#include "foam/presets.h"

namespace spume::coupling {
namespace {

const KeyRange kPlace{-1e4, 1e4, "m"};
const KeyRange kVelocity{-100, 100, "m/s"};
const KeyRange kRadius{1e-6, 1, "m"};
const KeyRange kTime{0, 1e9, "s"};

/// Comes first in its table: choosing a preset fills all other keys, which may then override it.
KeyRow presetRow() {
  KeyRow row;
  row.name = "preset";
  row.meaning = "where the defaults of this table come from";
  row.slot = [](Scene& scene, std::size_t) -> Slot {
    return ChoiceSlot{{"paper", "physical"},
                      [&scene] { return static_cast<int>(scene.preset); },
                      [&scene](int index) {
                        scene.preset = static_cast<foam::Preset>(index);
                        scene.foam = foam::makePreset(scene.preset);
                      }};
  };
  return row;
}

/// Materials and wetness.
void addMaterialKeys(KeyTableBuilder<foam::FoamParams>& table) {
  using foam::FoamParams;
  table.key("gas_density", &FoamParams::gasDensity, {0, 1000, "kg/m^3"}, "of the gas; air 1.2")
      .key("liquid_viscosity", &FoamParams::viscosity, {1e-5, 100, "Pa s"}, "for the drag law")
      .key("gas_viscosity", &FoamParams::gasViscosity, {0, 1, "Pa s"}, "for the damping aloft")
      .key("surface_tension", &FoamParams::surfaceTension, {0.001, 1, "N/m"}, "sigma")
      .choice("wetness_law", &FoamParams::wetnessLaw, {"constant", "height", "per_bubble"},
              "lambda is wetness, or goes from wetness to wetness_aloft above the liquid, or is each "
              "bubble's")
      .key("wetness", &FoamParams::wetness, {0, 1, "-"}, "lambda of Eq. 1 at the liquid; 0 dry, 1 wet")
      .key("wetness_aloft", &FoamParams::wetnessAloft, {0, 1, "-"}, "lambda at wetness_height and above")
      .key("wetness_height", &FoamParams::wetnessHeight, {1e-6, 1e4, "m"}, "height lambda changes over");
}

/// Forces.
void addForceKeys(KeyTableBuilder<foam::FoamParams>& table) {
  using foam::FoamParams;
  table.key("spring_stiffness", &FoamParams::springStiffness, {0, 1e7, "N/m"}, "k of Eq. 2")
      .key("spring_from_surface_tension", &FoamParams::springFromSurfaceTension,
           "k = 2 pi sigma s instead of spring_stiffness")
      .key("spring_surface_tension_factor", &FoamParams::springSurfaceTensionFactor, {0.5, 1, "-"}, "s there")
      .key("spring_floor", &FoamParams::springFloor, {0, 1000, "-"}, "smallest k in rho g r_i r_j")
      .choice("drag_law", &FoamParams::dragLaw, {"coefficient", "contaminated", "clean"},
              "Eq. 3 with drag_coefficient, or C_D(d) of bubbles in contaminated or clean water")
      .key("drag_coefficient", &FoamParams::dragCoefficient, {0, 1e5, "kg/m^3"}, "c of Eq. 3")
      .key("drag_coefficient_limit", &FoamParams::dragCoefficientLimit, {0, 1, "m"},
           "largest radius c is used for; larger ones as contaminated")
      .choice("buoyancy_law", &FoamParams::buoyancyLaw, {"hydrostatic", "pressure_gradient"},
              "Eq. 4, or from the liquid's pressure")
      .choice("air_drag_law", &FoamParams::airDragLaw, {"coefficient", "stokes"},
              "of the air on bubbles aloft: Stokes with gas_viscosity, or air_drag_coefficient")
      .key("air_drag_coefficient", &FoamParams::airDragCoefficient, {0, 1e3, "kg/s"}, "c_vis of Eq. 10")
      .key("added_mass", &FoamParams::addedMass, {0, 2, "-"}, "C_M, part of the inertia only")
      .key("liquid_adhesion", &FoamParams::liquidAdhesion, {0, 100, "N/m"}, "s_lad of Eq. 5")
      .choice("attraction_law", &FoamParams::attractionLaw, {"none", "coefficient", "capillary"},
              "between floating bubbles and to solids: Eq. 6 and 8 made symmetric, or from surface tension")
      .key("weak_pairs", &FoamParams::weakPairs, "floating bubbles attract each other; else only solids do")
      .key("attraction", &FoamParams::attraction, {0, 1, "N"}, "alpha of Eq. 6")
      .key("wall_stiffness_factor", &FoamParams::wallStiffnessFactor, {0, 1000, "-"}, "wall spring over k")
      .key("contact_damping", &FoamParams::contactDamping, {0, 5, "-"}, "zeta of Eq. 10, made pairwise")
      .key("border_rate", &FoamParams::borderRate, {0, 100, "1/s"},
           "how fast films aloft draw their borders to Plateau's law, at most a tenth of the way in a step; "
           "0: not at all");
}

/// Volume, lives and the solver.
void addLifeKeys(KeyTableBuilder<foam::FoamParams>& table) {
  using foam::FoamParams;
  table
      .choice("connectivity", &FoamParams::connectivity, {"local", "global"},
              "engine of contacts and cells; the global one is the reference, and some twenty times slower")
      .choice("volume_mode", &FoamParams::volumeMode, {"relax", "newton"},
              "cells regain their gas each by itself, or solved together")
      .key("volume_rate", &FoamParams::volumeRate, {0, 1000, "1/s"}, "gamma, how fast a cell regains its gas")
      .key("volume_tolerance", &FoamParams::volumeTolerance, {1e-10, 0.1, "-"},
           "newton: largest error of a cell's volume it leaves")
      .key("radius_limit", &FoamParams::radiusLimit, {1.1, 10, "-"},
           "largest radius over that of the free gas")
      .key("bursting", &FoamParams::bursting, "bubbles burst; their clock runs above water only")
      .key("burst_median_life", &FoamParams::burstMedianLife, {1e-3, 1e9, "s"}, "at burst_reference_radius")
      .key("burst_reference_radius", &FoamParams::burstReferenceRadius, {1e-6, 1, "m"},
           "see burst_median_life")
      .key("burst_shape", &FoamParams::burstShape, {0.5, 10, "-"}, "Weibull: 2 Rayleigh, 4/3 thin films")
      .key("burst_wall_factor", &FoamParams::burstWallFactor, {0, 1, "-"},
           "rate of bursting at a wall over that in the open; 1: walls do not matter")
      .key("burst_wall_distance", &FoamParams::burstWallDistance, {1e-6, 1, "m"}, "where the open begins")
      .choice(
          "solver", &FoamParams::solver, {"pcg_jacobi", "pcg_ic", "cholmod"},
          "of the implicit step: conjugate gradients with diagonal blocks or an incomplete Cholesky factor, "
          "or a direct factorisation")
      .key("solver_tolerance", &FoamParams::solverTolerance, {1e-12, 1e-1, "-"}, "relative residual")
      .key("solver_iterations", &FoamParams::solverIterations, {1, 1e5, "-"}, "limit of the implicit step");
}

/// The keys of a distribution of radii, where `place` says.
template <typename Object, typename Place>
void addRadiusKeys(KeyTableBuilder<Object>& table, const Place& place) {
  using foam::RadiusLaw;
  const auto lawIs = [place](RadiusLaw law) {
    return [place, law](const Object& object) { return place(const_cast<Object&>(object)).law == law; };
  };
  table.choice(
      "radius_law", [place](Object & o) -> auto& { return place(o).law; },
      {"uniform", "lognormal", "power_law"}, "how radii are distributed between min_radius and max_radius");
  table
      .key(
          "median_radius", [place](Object & o) -> auto& { return place(o).median; }, kRadius,
          "before the cut")
      .onlyIf(lawIs(RadiusLaw::lognormal), "radius_law = \"lognormal\"");
  table
      .key(
          "sigma", [place](Object & o) -> auto& { return place(o).sigma; }, {0, 2, "-"}, "of ln r")
      .onlyIf(lawIs(RadiusLaw::lognormal), "radius_law = \"lognormal\"");
  table
      .key(
          "exponent", [place](Object & o) -> auto& { return place(o).exponent; }, {-20, 20, "-"},
          "density goes as r^exponent")
      .onlyIf(lawIs(RadiusLaw::powerLaw), "radius_law = \"power_law\"");
  table.key(
      "min_radius", [place](Object & o) -> auto& { return place(o).least; }, kRadius, "smallest bubble");
  table.key(
      "max_radius", [place](Object & o) -> auto& { return place(o).most; }, kRadius, "largest bubble");
}

bool wetnessIsPerBubble(const Scene& scene) { return scene.foam.wetnessLaw == foam::WetnessLaw::perBubble; }
constexpr char kPerBubble[] = "foam.wetness_law = \"per_bubble\"";

}  // namespace

KeyTable foamTable() {
  auto builder =
      partTable("foam", "The bubbles. The preset fills every key; those given override it.", &Scene::foam);
  addMaterialKeys(builder);
  addForceKeys(builder);
  addLifeKeys(builder);
  KeyTable table = builder.build();
  table.keys.insert(table.keys.begin(), presetRow());
  return table;
}

KeyTable wallTable() {
  KeyTableBuilder<foam::SolidSurface> table(
      "foam.walls", "How bubbles take to the walls of the domain.",
      [](Scene& scene, std::size_t) -> foam::SolidSurface& { return scene.foam.walls; });
  addSurfaceKeys(table, [](foam::SolidSurface& s) -> foam::SolidSurface& { return s; });
  return table.build();
}

KeyTable stillPoolTable() {
  return partTable("still_pool", "Liquid at rest in closed form: only the foam is computed.",
                   &Scene::stillPool)
      .key("enabled", &StillPoolSpec::enabled, "the liquid rests, with a flat surface, and costs nothing")
      .key("level", &StillPoolSpec::level, kPlace, "height of the surface, against gravity")
      .build();
}

KeyTable liquidCacheTable() {
  return partTable("liquid_cache", "A liquid that was computed before: only the foam is.",
                   &Scene::liquidCache)
      .key("run", &LiquidCacheSpec::run,
           "folder of the run whose caches hold it, beside the scene; \"\": it is solved (`spume foam` sets "
           "it)")
      .build();
}

KeyTable dissolvedGasTable() {
  using foam::DissolvedGasParams;
  return partTable("dissolved_gas", "Gas in solution, from which bubbles under the surface grow.",
                   &Scene::dissolvedGas)
      .key("enabled", &DissolvedGasParams::enabled, "bubbles exchange gas with the liquid")
      .key("concentration", &DissolvedGasParams::concentration, {0, 1e5, "mol/m^3"},
           "at the start and of liquid poured in; cola 148")
      .key("henry", &DissolvedGasParams::henry, {1e-9, 1, "mol/(m^3 Pa)"},
           "what a pressure keeps in solution")
      .key("diffusivity", &DissolvedGasParams::diffusivity, {1e-12, 1e-6, "m^2/s"},
           "of the gas in the liquid")
      .key("pressure", &DissolvedGasParams::pressure, {1, 1e8, "Pa"}, "of the air")
      .key("temperature", &DissolvedGasParams::temperature, {200, 500, "K"}, "of liquid and gas")
      .key("depletes", &DissolvedGasParams::depletes, "the liquid loses what bubbles take")
      .build();
}

KeyTable bubblesTable() {
  const auto single = [](const BubblesSpec& bubbles) { return bubbles.file.empty(); };
  const std::string words = "bubbles without a file";
  return listTable("bubbles", "Bubbles that are there at the start: one, or those of a file.",
                   &Scene::bubbles)
      .key("file", &BubblesSpec::file,
           "id,x,y,z,r of many, and vx,vy,vz and wetness where it has them; .csv, .ply or .vdb, beside the "
           "scene; their ids are kept")
      .key(
          "position", [](BubblesSpec & b) -> auto& { return b.bubble.position; }, kPlace, "centre")
      .onlyIf(single, words)
      .key(
          "velocity", [](BubblesSpec & b) -> auto& { return b.bubble.velocity; }, kVelocity, "at the start")
      .onlyIf(single, words)
      .key(
          "radius", [](BubblesSpec & b) -> auto& { return b.bubble.radius; }, kRadius, "of the free bubble")
      .required()
      .onlyIf(single, words)
      .key(
          "wetness", [](BubblesSpec & b) -> auto& { return b.bubble.wetness; }, {0, 1, "-"},
          "its lambda, or that of a file's bubbles without the column")
      .onlyWhere(wetnessIsPerBubble, kPerBubble)
      .build();
}

KeyTable nucleationTable() {
  auto table =
      listTable("nucleation", "Sites on solids where bubbles come out of solution.", &Scene::nucleation);
  table.key("name", &NucleationSpec::name, "for messages")
      .key("solid", &NucleationSpec::solid, "name of one, \"walls\" for those of the domain, \"\" for all")
      .key("density", &NucleationSpec::density, {0, 1e8, "1/m^2"}, "sites on an area")
      .key("waiting", &NucleationSpec::waiting, {1e-4, 1e6, "s"},
           "mean time from a bubble's leaving to the next at its site");
  addRadiusKeys(table, [](NucleationSpec& n) -> foam::RadiusDistribution& { return n.radius; });
  addTimeKeys(table);
  return table.build();
}

void addSourceKeys(KeyTableBuilder<BubbleSourceSpec>& table) {
  const auto measureIs = [](SourceMeasure measure) {
    return [measure](const BubbleSourceSpec& source) { return source.measure == measure; };
  };
  table.choice("measure", &BubbleSourceSpec::measure, {"number", "gas"}, "what is given: rate or gas_rate")
      .key("rate", &BubbleSourceSpec::rate, {0, 1e7, "1/s"}, "bubbles a second; may be animated")
      .onlyIf(measureIs(SourceMeasure::number), "measure = \"number\"")
      .key("gas_rate", &BubbleSourceSpec::gasRate, {0, 1, "m^3/s"}, "gas blown in; may be animated")
      .onlyIf(measureIs(SourceMeasure::gas), "measure = \"gas\"");
  addRadiusKeys(table, [](BubbleSourceSpec& s) -> foam::RadiusDistribution& { return s.radius; });
  table.key("velocity", &BubbleSourceSpec::velocity, kVelocity, "of new bubbles")
      .key("wetness", &BubbleSourceSpec::wetness, {0, 1, "-"}, "lambda of new bubbles")
      .onlyWhere(wetnessIsPerBubble, kPerBubble)
      .key("immersed", &BubbleSourceSpec::immersed, "blows only where there is liquid");
  addTimeKeys(table);
}

}  // namespace spume::coupling
