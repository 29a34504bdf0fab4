#include "coupling/scene_keys.h"

#include "coupling/foam_keys.h"
#include "coupling/key_table_builder.h"
#include "coupling/shape_keys.h"

namespace spume::coupling {
namespace {

constexpr double kLargestSeed = 9e18;  // TOML integers end at 2^63

KeyTable sceneTable() {
  return KeyTableBuilder<Scene>("scene", "What is simulated.",
                                [](Scene& s, std::size_t) -> Scene& { return s; })
      .key("name", &Scene::name,
           "names the output folder; letters, digits, _ and -; default: the file's name, other characters as "
           "_")
      .key("title", &Scene::title, "one line about the scene")
      .key("seed", &Scene::seed, {0, kLargestSeed, "-"}, "of every random number of the run")
      .key(
          "gravity", [](Scene & s) -> auto& { return s.liquid.gravity; }, {-1000, 1000, "m/s^2"}, "y is up")
      .build();
}

KeyTable domainTable() {
  return partTable("domain", "The box that is simulated, a glass with walls on its closed sides.",
                   &Scene::domain)
      .key("lower", &DomainSpec::lower, kPlace, "low corner")
      .key("size", &DomainSpec::size, {1e-4, 1e4, "m"}, "edges, rounded to whole cells")
      .required()
      .key("resolution", &DomainSpec::resolution, {8, 1024, "cells"}, "cells along the longest edge")
      .key("walls", &DomainSpec::closed, "sides that are walls; the others are open to the air")
      .build();
}

KeyTable timeTable() {
  return partTable("time", "Frames and steps.", &Scene::time)
      .key("fps", &TimeSpec::fps, {1, 1000, "1/s"}, "frames a second")
      .key("frames", &TimeSpec::frames, {1, 1e6, "-"}, "length of the run")
      .key("min_step", &TimeSpec::minDt, {1e-6, 1, "s"}, "shortest step liquid and foam share")
      .key("max_step", &TimeSpec::maxDt, {1e-6, 1, "s"}, "longest step liquid and foam share")
      .key("max_substeps", &TimeSpec::maxSubSteps, {1, 100, "-"},
           "liquid sub-steps the shared step is sized for")
      .build();
}

KeyTable liquidTable() {
  using fluid::FluidParams;
  return partTable("liquid", "The liquid and the particle level set that carries it.", &Scene::liquid)
      .key("density", &FluidParams::density, {1, 20000, "kg/m^3"}, "rho; water 1000")
      .choice("level_set_transport", &FluidParams::levelSetTransport, {"semi_lagrangian", "weno5"},
              "the markers carry the accuracy, so the first will do")
      .choice("velocity_advection", &FluidParams::velocityAdvection,
              {"semi_lagrangian", "maccormack", "trapezoidal"},
              "maccormack is second order in space, clamped; trapezoidal in time, too: smooth flows")
      .key("cfl", &FluidParams::cfl, {0.2, 10, "-"}, "largest max|u| dt/dx of a sub-step")
      .key("markers_per_cell", &FluidParams::markersPerCell, {8, 64, "-"},
           "level-set markers a cell and sign")
      .key("marker_band", &FluidParams::markerBand, {2, 5, "cells"}, "half-width of the seeded band")
      .key("marker_radius_min", &FluidParams::markerRadiusMin, {0.01, 0.5, "dx"}, "smallest marker")
      .key("marker_radius_max", &FluidParams::markerRadiusMax, {0.1, 1, "dx"}, "largest marker")
      .key("reseed_interval", &FluidParams::reseedInterval, {1, 1000, "-"}, "sub-steps between reseedings")
      .key("escape_depth", &FluidParams::escapeDepth, {0.5, 3, "dx"}, "depth at which air markers become gas")
      .key("impact_reach", &FluidParams::impactReach, {1e-4, 1, "m"},
           "how far around lost air streams that meet are looked for")
      .key("pressure_tolerance", &FluidParams::pressureTolerance, {1e-12, 1e-2, "-"}, "relative residual")
      .key("pressure_iterations", &FluidParams::pressureIterations, {1, 10000, "-"},
           "limit of a pressure solve")
      .key("volume_control", &FluidParams::volumeControl, "hold every connected body at its booked volume")
      .key("volume_control_time", &FluidParams::volumeControlTime, {0.001, 10, "s"},
           "relaxation time of its error")
      .key("viscosity", &FluidParams::viscosity, {0, 1e4, "Pa s"}, "mu; 0: none; water 1e-3, honey 10")
      .key("no_slip", &FluidParams::noSlip, "viscous liquid sticks to solids")
      .key("surface_tension", &FluidParams::surfaceTension, {0, 10, "N/m"},
           "sigma; 0: none; water 0.0728; shortens the sub-steps")
      .build();
}

KeyTable couplingTable() {
  return partTable("coupling", "What liquid and foam do to each other.", &Scene::coupling)
      .key("immersed_gas", &CouplingSpec::immersedGas, "bubbles under the surface raise it")
      .key("two_way", &CouplingSpec::twoWay,
           "the liquid feels the drag of the bubbles: plumes rise with them")
      .build();
}

KeyTable entrainmentTable() {
  const auto find = [](Scene& s, std::size_t) -> EntrainmentSpec& { return s.coupling.entrainment; };
  return KeyTableBuilder<EntrainmentSpec>("coupling.entrainment", "How air dragged under becomes bubbles.",
                                          find)
      .key("enabled", &EntrainmentSpec::enabled, "bubbles are born from escaped markers")
      .key("length", &EntrainmentSpec::length, {1e-5, 0.1, "m"}, "L_e, thickness of the captured air film")
      .key("onset", &EntrainmentSpec::onset, {0, 10, "m/s"}, "smallest impact speed that entrains")
      .key("block_size", &EntrainmentSpec::blockSize, {1e-4, 0.1, "m"}, "edge of the blocks that collect gas")
      .key("median_radius", &EntrainmentSpec::medianRadius, {1e-5, 0.1, "m"}, "of the lognormal distribution")
      .key("sigma", &EntrainmentSpec::sigma, {0, 2, "-"}, "of ln r")
      .key("min_radius", &EntrainmentSpec::minRadius, {1e-5, 0.1, "m"}, "smallest bubble")
      .key("max_radius", &EntrainmentSpec::maxRadius, {1e-5, 0.1, "m"}, "largest bubble")
      .build();
}

KeyTable outputTable() {
  return partTable("output", "What a run writes.", &Scene::output)
      .key("liquid", &OutputSpec::liquid, "liquid/liquid.####.vdb")
      .key("bubbles_vdb", &OutputSpec::bubblesVdb, "bubbles/bubbles.####.vdb")
      .key("bubbles_ply", &OutputSpec::bubblesPly, "bubbles/bubbles.####.ply")
      .key("drops_vdb", &OutputSpec::dropsVdb, "drops/drops.####.vdb")
      .key("drops_ply", &OutputSpec::dropsPly, "drops/drops.####.ply")
      .key("films", &OutputSpec::films,
           "films/films.####.ply: the films as a mesh, curved as soap films are; half a second per 1000 "
           "bubbles")
      .key("preview", &OutputSpec::preview, "preview/preview.####.png")
      .key("staggered_velocity", &OutputSpec::staggeredVelocity, "vel on faces instead of cell centres")
      .key("every", &OutputSpec::every, {1, 1000, "frames"}, "frames between cached ones")
      .key("checkpoint_every", &OutputSpec::checkpointEvery, {1, 10000, "frames"},
           "frames between checkpoints")
      .key("preview_size", &OutputSpec::previewSize, {16, 8192, "pixels"}, "width and height")
      .build();
}

KeyTable cameraTable() {
  return partTable("camera", "Of the pictures. Where eye and target are equal it is placed by itself.",
                   &Scene::camera)
      .key("eye", &CameraSpec::eye, kPlace, "where it stands")
      .key("target", &CameraSpec::target, kPlace, "what it looks at")
      .key("field_of_view", &CameraSpec::fieldOfView, {5, 120, "degrees"}, "vertical")
      .build();
}

KeyTable lookTable() {
  const KeyRange film{1e-9, 1e-5, "m"};
  return partTable("look", "Of the pictures: materials and light.", &Scene::look)
      .key("liquid_colour", &LookSpec::liquidColour, {0.001, 1, "-"},
           "red, green, blue left of white light after colour_depth; linear")
      .key("colour_depth", &LookSpec::colourDepth, {1e-4, 100, "m"}, "path in the liquid for liquid_colour")
      .choice("backdrop", &LookSpec::backdrop, {"light", "dark"}, "of the studio")
      .choice("box", &LookSpec::box, {"glass", "none"}, "walls of the domain: drawn as panes, or not")
      .key("glass_thickness", &LookSpec::glassThickness, {0, 1, "m"},
           "of the panes; 0: a fortieth of the longest edge")
      .choice("solids", &LookSpec::solids, {"automatic", "glass", "matte"},
              "automatic: vessels are glass, others matte")
      .choice(
          "films", &LookSpec::films, {"plane", "curved"},
          "plane faces of cells; curved as soap films are, in pictures of `render`: half a second per 1000 "
          "bubbles")
      .key("film_thin", &LookSpec::filmThin, film, "thinnest film between or around bubbles")
      .key("film_thick", &LookSpec::filmThick, film, "thickest film, of new bubbles")
      .key("film_drainage", &LookSpec::filmDrainage, {1e-3, 1e6, "s"}, "time films take to thin")
      .key("plateau_border", &LookSpec::plateauBorder, {0, 0.5, "-"},
           "width of the rounding where films meet, over the bubble's radius")
      .build();
}

KeyTable solidTable() {
  using enum ShapeKind;
  auto table = listTable("solid", "A solid, at rest or moved by keys.", &Scene::solids);
  table.key("name", &SolidSpec::name, "for messages");
  ShapeKeys<SolidSpec> shape(table, {box, sphere, cylinder, halfSpace, vessel, mesh, levelSet});
  shape.addPrimitives();
  shape.addVessel();
  shape.addFile();
  const auto motion = [](auto member) {
    return [member](SolidSpec & s) -> auto& { return s.motion.*member; };
  };
  table.key("position", motion(&MotionSpec::position), kPlace, "shift from where its shape places it");
  table.key("rotation", motion(&MotionSpec::rotation), {-1e6, 1e6, "degrees"},
            "turn about rotation_axis through pivot, before the shift; may be animated");
  table.key("rotation_axis", motion(&MotionSpec::rotationAxis), kDirection, "right-handed; any length");
  table.key("pivot", motion(&MotionSpec::pivot), kPlace, "a point of the axis it turns about");
  addSurfaceKeys(table, [](SolidSpec& s) -> foam::SolidSurface& { return s.surface; });
  return table.build();
}

KeyTable liquidBodyTable() {
  using enum ShapeKind;
  auto table = listTable("liquid_body", "Liquid that is there at the start; bodies may overlap.",
                         &Scene::liquidBodies);
  table.key("name", &LiquidBodySpec::name, "for messages");
  table.key("vessel", &LiquidBodySpec::vessel, "name of the vessel it fills, instead of a shape");
  table.key("depth", &LiquidBodySpec::depth, {0, 1e4, "m"}, "of the liquid in the vessel")
      .onlyIf([](const LiquidBodySpec& body) { return !body.vessel.empty(); }, "bodies in a vessel");
  ShapeKeys<LiquidBodySpec> shape(table, {box, sphere, cylinder, halfSpace});
  shape.addPrimitives();
  return table.build();
}

KeyTable inflowTable() {
  return listTable("inflow", "A round nozzle that pours liquid in.", &Scene::inflows)
      .key("name", &InflowSpec::name, "for messages")
      .key("centre", &InflowSpec::centre, kPlace, "of the outlet disc")
      .key("direction", &InflowSpec::direction, kDirection, "of the jet; any length")
      .key("radius", &InflowSpec::radius, kLength, "of the outlet disc")
      .key("speed", &InflowSpec::speed, {0, 100, "m/s"}, "of the jet; may be animated")
      .key("turbulence", &InflowSpec::turbulence, {0, 0.5, "-"}, "rms relative fluctuation of the speed")
      .key("start", &InflowSpec::start, {0, 1e9, "s"}, "opens")
      .key("stop", &InflowSpec::stop, {0, 1e9, "s"}, "closes")
      .build();
}

KeyTable outflowTable() {
  using enum ShapeKind;
  auto table = listTable("outflow", "A region that takes liquid out.", &Scene::outflows);
  table.key("name", &OutflowSpec::name, "for messages");
  table.choice("mode", &OutflowSpec::mode, {"free", "rate"},
               "free: open to the air, all that comes in is gone; rate: a pump");
  table.key("rate", &OutflowSpec::rate, {0, 1e3, "m^3/s"}, "of a pump; may be animated")
      .onlyIf([](const OutflowSpec& outflow) { return outflow.mode == DrainMode::rate; }, "mode rate");
  table.key("start", &OutflowSpec::start, {0, 1e9, "s"}, "opens");
  table.key("stop", &OutflowSpec::stop, {0, 1e9, "s"}, "closes");
  ShapeKeys<OutflowSpec> shape(table, {box, sphere, cylinder, halfSpace});
  shape.addPrimitives();
  return table.build();
}

KeyTable probeTable() {
  using enum ShapeKind;
  auto table = listTable("probe", "A measurement: columns of probes.csv, a row a step.", &Scene::probes);
  table.key("name", &ProbeSpec::name, "names its columns; letters, digits, _ and -");
  table.choice("kind", &ProbeSpec::kind, {"height", "pressure", "velocity", "volume"},
               "a height gauge, a point, or the liquid in a region");
  table.key("position", &ProbeSpec::position, kPlace, "the point, or the foot of the gauge")
      .onlyIf([](const ProbeSpec& probe) { return probe.kind != ProbeKind::volume; },
              "height, pressure, velocity");
  ShapeKeys<ProbeSpec> shape(table, {box, sphere, cylinder, halfSpace});
  shape.addPrimitives();
  return table.build();
}

KeyTable bubbleSourceTable() {
  using enum ShapeKind;
  auto table = listTable("bubble_source", "Blows bubbles into a region.", &Scene::bubbleSources);
  table.key("name", &BubbleSourceSpec::name, "for messages");
  ShapeKeys<BubbleSourceSpec> shape(table, {box, sphere, cylinder, halfSpace});
  shape.addPrimitives();
  addSourceKeys(table);
  return table.build();
}

KeyTable bubbleKillTable() {
  using enum ShapeKind;
  auto table = listTable("bubble_kill", "Removes the bubbles whose centre is inside.", &Scene::bubbleKills);
  table.key("name", &BubbleKillSpec::name, "for messages");
  ShapeKeys<BubbleKillSpec> shape(table, {box, sphere, cylinder, halfSpace});
  shape.addPrimitives();
  addTimeKeys(table);
  return table.build();
}

}  // namespace

const std::vector<KeyTable>& sceneTables() {
  static const std::vector<KeyTable> kTables{
      sceneTable(),        domainTable(),       timeTable(),      liquidTable(),   stillPoolTable(),
      liquidCacheTable(),  foamTable(),         wallTable(),      couplingTable(), entrainmentTable(),
      dissolvedGasTable(), outputTable(),       cameraTable(),    lookTable(),     solidTable(),
      liquidBodyTable(),   inflowTable(),       outflowTable(),   probeTable(),    bubblesTable(),
      nucleationTable(),   bubbleSourceTable(), bubbleKillTable()};
  return kTables;
}

}  // namespace spume::coupling
