#include "coupling/scene_keys.h"

#include "coupling/foam_keys.h"
#include "coupling/key_table_builder.h"
#include "coupling/shapes.h"

namespace spume::coupling {
namespace {

const KeyRange kPlace{-1e4, 1e4, "m"};
const KeyRange kLength{1e-6, 1e4, "m"};
const KeyRange kDirection{-1e6, 1e6, "-"};
constexpr double kLargestSeed = 9e18;  // TOML integers end at 2^63

KeyTable sceneTable() {
  return KeyTableBuilder<Scene>("scene", "What is simulated.",
                                [](Scene& s, std::size_t) -> Scene& { return s; })
      .key("name", &Scene::name,
           "names the output folder; letters, digits, _ and -; default: the file's name")
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
      .choice("velocity_advection", &FluidParams::velocityAdvection, {"semi_lagrangian", "maccormack"},
              "maccormack is second order, clamped")
      .key("cfl", &FluidParams::cfl, {0.2, 10, "-"}, "largest max|u| dt/dx of a sub-step")
      .key("markers_per_cell", &FluidParams::markersPerCell, {8, 64, "-"},
           "level-set markers a cell and sign")
      .key("marker_band", &FluidParams::markerBand, {2, 5, "cells"}, "half-width of the seeded band")
      .key("marker_radius_min", &FluidParams::markerRadiusMin, {0.01, 0.5, "dx"}, "smallest marker")
      .key("marker_radius_max", &FluidParams::markerRadiusMax, {0.1, 1, "dx"}, "largest marker")
      .key("reseed_interval", &FluidParams::reseedInterval, {1, 1000, "-"}, "sub-steps between reseedings")
      .key("escape_depth", &FluidParams::escapeDepth, {0.5, 3, "dx"}, "depth at which air markers become gas")
      .key("speed_memory", &FluidParams::speedMemory, {0.001, 1, "s"},
           "decay time of a marker's impact speed")
      .key("pressure_tolerance", &FluidParams::pressureTolerance, {1e-12, 1e-2, "-"}, "relative residual")
      .key("pressure_iterations", &FluidParams::pressureIterations, {1, 10000, "-"},
           "limit of a pressure solve")
      .key("volume_control", &FluidParams::volumeControl, "hold every connected body at its booked volume")
      .key("volume_control_time", &FluidParams::volumeControlTime, {0.001, 10, "s"},
           "relaxation time of its error")
      .build();
}

KeyTable couplingTable() {
  return partTable("coupling", "What liquid and foam do to each other.", &Scene::coupling)
      .key("immersed_gas", &CouplingSpec::immersedGas, "bubbles under the surface raise it")
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
      .key("onset_bubbles", &EntrainmentSpec::onsetBubbles, {0, 1e6, "-"},
           "a block pays once it was offered the gas of this many mean bubbles")
      .key("onset_memory", &EntrainmentSpec::onsetMemory, {1e-3, 1e9, "s"}, "in about this time")
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

/// The keys of `Object::shape`, each only where the kind of the shape uses it.
template <typename Object>
void addShapeKeys(KeyTableBuilder<Object>& table) {
  const auto isOneOf = [](auto... kinds) {
    return [=](const Object& object) { return ((object.shape.kind == kinds) || ...); };
  };
  using enum ShapeKind;
  table.choice(
      "shape", [](Object & o) -> auto& { return o.shape.kind; },
      {nameOf(box), nameOf(sphere), nameOf(cylinder), nameOf(halfSpace)}, "kind of the shape");
  table
      .key(
          "lower", [](Object & o) -> auto& { return o.shape.lower; }, kPlace, "low corner")
      .onlyIf(isOneOf(box), "box");
  table
      .key(
          "upper", [](Object & o) -> auto& { return o.shape.upper; }, kPlace, "high corner")
      .onlyIf(isOneOf(box), "box");
  table
      .key(
          "centre", [](Object & o) -> auto& { return o.shape.centre; }, kPlace,
          "centre, or a point of the plane")
      .onlyIf(isOneOf(sphere, cylinder, halfSpace), "sphere, cylinder, half_space");
  table
      .key(
          "axis", [](Object & o) -> auto& { return o.shape.axis; }, kDirection,
          "axis, or normal out of the shape")
      .onlyIf(isOneOf(cylinder, halfSpace), "cylinder, half_space");
  table
      .key(
          "radius", [](Object & o) -> auto& { return o.shape.radius; }, kLength, "radius")
      .onlyIf(isOneOf(sphere, cylinder), "sphere, cylinder");
  table
      .key(
          "height", [](Object & o) -> auto& { return o.shape.height; }, kLength, "length along the axis")
      .onlyIf(isOneOf(cylinder), "cylinder");
}

KeyTable solidTable() {
  auto table = listTable("solid", "A solid at rest.", &Scene::solids);
  table.key("name", &SolidSpec::name, "for messages");
  addShapeKeys(table);
  addSurfaceKeys(table, [](SolidSpec& s) -> foam::SolidSurface& { return s.surface; });
  return table.build();
}

KeyTable liquidBodyTable() {
  auto table = listTable("liquid_body", "Liquid that is there at the start; bodies may overlap.",
                         &Scene::liquidBodies);
  table.key("name", &LiquidBodySpec::name, "for messages");
  addShapeKeys(table);
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

KeyTable bubbleSourceTable() {
  auto table = listTable("bubble_source", "Blows bubbles into a region.", &Scene::bubbleSources);
  table.key("name", &BubbleSourceSpec::name, "for messages");
  addShapeKeys(table);
  addSourceKeys(table);
  return table.build();
}

KeyTable bubbleKillTable() {
  auto table = listTable("bubble_kill", "Removes the bubbles whose centre is inside.", &Scene::bubbleKills);
  table.key("name", &BubbleKillSpec::name, "for messages");
  addShapeKeys(table);
  addTimeKeys(table);
  return table.build();
}

}  // namespace

const std::vector<KeyTable>& sceneTables() {
  static const std::vector<KeyTable> kTables{
      sceneTable(),   domainTable(),     timeTable(),         liquidTable(),      stillPoolTable(),
      foamTable(),    wallTable(),       couplingTable(),     entrainmentTable(), dissolvedGasTable(),
      outputTable(),  cameraTable(),     solidTable(),        liquidBodyTable(),  inflowTable(),
      bubblesTable(), nucleationTable(), bubbleSourceTable(), bubbleKillTable()};
  return kTables;
}

}  // namespace spume::coupling
