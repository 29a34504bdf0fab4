#include "coupling/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "coupling/domain_box.h"
#include "coupling/object_label.h"
#include "coupling/shapes.h"
#include "coupling/solid_file_store.h"
#include "coupling/solid_motion.h"

namespace spume::coupling {
namespace {

constexpr int kFewestCells = 4;       // along an edge: the stencils of the solver overlap on fewer
constexpr double kLargestSolid = 20;  // of a file, over the domain: larger ones are in another unit
constexpr double kNozzleCells = 3;    // [dx] length of an inflow's region, so that no sub-step empties it

ShapeSpec nozzle(const InflowSpec& inflow, double dx) {
  ShapeSpec region;
  region.kind = ShapeKind::cylinder;
  region.axis = inflow.direction.normalized();
  region.height = kNozzleCells * dx;
  region.centre = inflow.centre - 0.5 * region.height * region.axis;
  region.radius = inflow.radius;
  return region;
}

fluid::Inflow buildInflow(const InflowSpec& spec, double dx) {
  const double fastest = spec.speed.largest() > 0 ? spec.speed.largest() : 1;  // of a closed one: any
  fluid::Inflow inflow;
  inflow.name = spec.name;
  inflow.sdf = [region = nozzle(spec, dx)](const Eigen::Vector3d& x) { return signedDistance(region, x); };
  inflow.velocity = fastest * spec.direction.normalized();
  inflow.area = std::numbers::pi * spec.radius * spec.radius;
  inflow.turbulence = spec.turbulence;
  inflow.scale = [speed = spec.speed, start = spec.start, stop = spec.stop, fastest](double t) {
    const bool open = t >= start && t < stop;
    return open ? speed.at(t) / fastest : 0.0;
  };
  return inflow;
}

fluid::Outflow buildOutflow(const OutflowSpec& spec) {
  fluid::Outflow outflow;
  outflow.name = spec.name;
  outflow.sdf = [shape = spec.shape](const Eigen::Vector3d& x) { return signedDistance(shape, x); };
  outflow.free = spec.mode == DrainMode::free;
  outflow.rate = [spec](double t) {
    const bool open = t >= spec.start && t < spec.stop;
    return !open ? 0.0 : spec.mode == DrainMode::free ? 1.0 : spec.rate.at(t);
  };
  return outflow;
}

/// Signed distance to a solid where it was placed; one from a file is read and sampled.
SignedDistance placedDistance(const Scene& scene, std::size_t item) {
  const ShapeSpec& shape = scene.solids[item].shape;
  if (!isFromFile(shape.kind)) return [shape](const Eigen::Vector3d& x) { return signedDistance(shape, x); };
  std::shared_ptr<const DistanceField> field;
  checkItem(
      "solid", item,
      [&] {
        const double longest = kLargestSolid * scene.domain.size.maxCoeff();
        field = scene.solidFiles->distance(shape, scene.dx(), longest);
      },
      objectLabel("solid", scene.solids[item].name, item));
  return [field](const Eigen::Vector3d& x) { return (*field)(x); };
}

/// The same as its motion has it at time t.
SignedDistance distanceAt(const SignedDistance& placed, const MotionSpec& motion, double t) {
  return [placed, pose = poseAt(motion, t)](const Eigen::Vector3d& x) { return placed(pose.toPlaced(x)); };
}

fluid::SolidObject buildSolid(const Scene& scene, std::size_t item) {
  const SolidSpec& spec = scene.solids[item];
  const SignedDistance placed = placedDistance(scene, item);
  fluid::SolidObject solid;
  solid.name = spec.name;
  solid.moves = moves(spec.motion);
  solid.psi = [placed, motion = spec.motion](const Eigen::Vector3d& x, double t) {
    return placed(poseAt(motion, t).toPlaced(x));
  };
  solid.frozen = [placed, motion = spec.motion](double t) { return distanceAt(placed, motion, t); };
  if (solid.moves)
    solid.velocity = [motion = spec.motion](const Eigen::Vector3d& x, double t) {
      return velocityAt(motion, x, t);
    };
  return solid;
}

/// Liquid in a vessel as it stands at the start: its surface is level, or across the vessel without gravity.
SignedDistance liquidInVessel(const SolidSpec& vessel, double depth, const Eigen::Vector3d& gravity) {
  const Pose pose = poseAt(vessel.motion, 0);
  const Eigen::Vector3d axis = vessel.shape.axis.normalized();
  const Eigen::Vector3d surface = pose.toWorld(vessel.shape.centre + depth * axis);
  const Eigen::Vector3d against = gravity.norm() > 0 ? gravity : Eigen::Vector3d(-(pose.rotation * axis));
  const Eigen::Vector3d up = -against.normalized();
  // Not the larger of two distances: up to the walls the liquid must be as deep as its surface says, on both
  // sides. Where the room ends, inside the wall, nothing reads it.
  return [shape = vessel.shape, pose, surface, up](const Eigen::Vector3d& x) {
    const bool inRoom = roomInVessel(shape, pose.toPlaced(x)) < 0;
    return inRoom ? up.dot(x - surface) : std::numeric_limits<double>::max();
  };
}

/// A box that ends at a closed side of the domain, continued behind it: the wall is no surface of the liquid,
/// and with surface tension what looks like its edge there would be pulled round.
ShapeSpec continuedBehindWalls(const Scene& scene, ShapeSpec shape) {
  if (shape.kind != ShapeKind::box) return shape;
  const double near = 1e-6 * scene.dx();  // round-off of what is written
  const auto [low, high] = DomainBox(scene);
  const double beyond = scene.domain.size.norm();
  for (int axis = 0; axis < 3; ++axis) {
    if (scene.domain.closed[2 * axis] && shape.lower[axis] <= low[axis] + near)
      shape.lower[axis] = std::min(shape.lower[axis], low[axis] - beyond);
    if (scene.domain.closed[2 * axis + 1] && shape.upper[axis] >= high[axis] - near)
      shape.upper[axis] = std::max(shape.upper[axis], high[axis] + beyond);
  }
  return shape;
}

SignedDistance distanceTo(const Scene& scene, const LiquidBodySpec& body) {
  if (const SolidSpec* vessel = vesselOf(scene, body))
    return liquidInVessel(*vessel, body.depth, scene.liquid.gravity);
  return [shape = continuedBehindWalls(scene, body.shape)](const Eigen::Vector3d& x) {
    return signedDistance(shape, x);
  };
}

}  // namespace

fluid::GridSpec gridOf(const Scene& scene) {
  fluid::GridSpec grid;
  grid.dx = scene.dx();
  grid.origin = scene.domain.lower;
  for (int axis = 0; axis < 3; ++axis)
    grid.cells[axis] =
        std::max(kFewestCells, static_cast<int>(std::lround(scene.domain.size[axis] / grid.dx)));
  return grid;
}

fluid::LiquidSetup buildLiquidSetup(const Scene& scene) {
  checkObjects(scene);
  fluid::LiquidSetup setup;
  setup.grid = gridOf(scene);
  setup.walls.closed = scene.domain.closed;
  for (std::size_t i = 0; i < scene.solids.size(); ++i) setup.solids.push_back(buildSolid(scene, i));
  for (const InflowSpec& inflow : scene.inflows) setup.inflows.push_back(buildInflow(inflow, scene.dx()));
  for (const OutflowSpec& outflow : scene.outflows) setup.outflows.push_back(buildOutflow(outflow));
  return setup;
}

const SolidSpec* vesselOf(const Scene& scene, const LiquidBodySpec& body) {
  const auto isMeant = [&](const SolidSpec& solid) {
    return solid.name == body.vessel && solid.shape.kind == ShapeKind::vessel;
  };
  const auto found = std::find_if(scene.solids.begin(), scene.solids.end(), isMeant);
  return body.vessel.empty() || found == scene.solids.end() ? nullptr : &*found;
}

SignedDistance initialPhi(const Scene& scene) {
  std::vector<SignedDistance> bodies;
  for (const LiquidBodySpec& body : scene.liquidBodies) bodies.push_back(distanceTo(scene, body));
  return [bodies = std::move(bodies), farAway = scene.domain.size.norm()](const Eigen::Vector3d& x) {
    double phi = farAway;
    for (const SignedDistance& body : bodies) phi = std::min(phi, body(x));
    return phi;
  };
}

std::vector<SignedDistance> solidDistances(const Scene& scene, double t) {
  std::vector<SignedDistance> solids;
  for (std::size_t i = 0; i < scene.solids.size(); ++i)
    solids.push_back(distanceAt(placedDistance(scene, i), scene.solids[i].motion, t));
  return solids;
}

SignedDistance solidDistance(const Scene& scene, double t) {
  return [solids = solidDistances(scene, t)](const Eigen::Vector3d& x) {
    double psi = std::numeric_limits<double>::infinity();
    for (const SignedDistance& solid : solids) psi = std::min(psi, solid(x));
    return psi;
  };
}

SolidVelocity solidVelocity(const Scene& scene, double t) {
  const auto still = [](const SolidSpec& solid) { return !moves(solid.motion); };
  if (std::all_of(scene.solids.begin(), scene.solids.end(), still)) return {};
  std::vector<MotionSpec> motions;
  for (const SolidSpec& solid : scene.solids) motions.push_back(solid.motion);
  return [motions = std::move(motions), t](int object, const Eigen::Vector3d& x) {
    return object < 0 ? Eigen::Vector3d(0, 0, 0) : velocityAt(motions[object], x, t);
  };
}

}  // namespace spume::coupling
