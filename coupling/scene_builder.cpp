#include "coupling/scene_builder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "coupling/foam_objects.h"
#include "coupling/shapes.h"
#include "coupling/toml_slot.h"

namespace spume::coupling {
namespace {

constexpr int kFewestCells = 4;       // along an edge: the stencils of the solver overlap on fewer
constexpr double kNozzleCells = 3;    // [dx] length of an inflow's region, so that no sub-step empties it
constexpr double kRequiredCells = 2;  // [dx] of it that must lie inside the domain
constexpr double kLeastOutletRadius = 0.75;  // [dx] a smaller disc may miss every cell centre
constexpr int kRimPoints = 16;               // of an outlet, tested against solids

std::string text(const Eigen::Vector3d& v) {
  return "[" + exactText(v.x()) + ", " + exactText(v.y()) + ", " + exactText(v.z()) + "]";
}

/// "inflow 'jet'", or "inflow 0" for an object without a name.
std::string label(const std::string& table, const std::string& name, std::size_t item) {
  return name.empty() ? table + " " + std::to_string(item) : table + " '" + name + "'";
}

Eigen::Vector3d domainUpper(const Scene& scene) { return gridOf(scene).upper(); }

std::string domainText(const Scene& scene) {
  return "the domain from " + text(scene.domain.lower) + " to " + text(domainUpper(scene)) + " m";
}

bool insideDomain(const Scene& scene, const Eigen::Vector3d& x) {
  return (x.array() >= scene.domain.lower.array()).all() && (x.array() <= domainUpper(scene).array()).all();
}

ShapeSpec nozzle(const InflowSpec& inflow, double dx) {
  ShapeSpec region;
  region.kind = ShapeKind::cylinder;
  region.axis = inflow.direction.normalized();
  region.height = kNozzleCells * dx;
  region.centre = inflow.centre - 0.5 * region.height * region.axis;
  region.radius = inflow.radius;
  return region;
}

/// The centre of the outlet and points round its rim.
std::vector<Eigen::Vector3d> outletPoints(const InflowSpec& inflow) {
  const Eigen::Vector3d axis = inflow.direction.normalized();
  const Eigen::Vector3d across = axis.unitOrthogonal(), other = axis.cross(across);
  std::vector<Eigen::Vector3d> points{inflow.centre};
  for (int i = 0; i < kRimPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kRimPoints;
    points.push_back(inflow.centre + inflow.radius * (std::cos(angle) * across + std::sin(angle) * other));
  }
  return points;
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

fluid::SolidObject buildSolid(const SolidSpec& spec) {
  fluid::SolidObject solid;
  solid.name = spec.name;
  solid.psi = [shape = spec.shape](const Eigen::Vector3d& x, double) { return signedDistance(shape, x); };
  return solid;
}

void checkName(const std::string& name, const std::string& object, std::set<std::string>& names) {
  if (!name.empty() && !names.insert(name).second)
    throw SceneError(object + ": another object has the same name; give each its own");
}

void checkBody(const Scene& scene, const ShapeSpec& shape, const std::string& object) {
  const std::string problem = defect(shape);
  if (!problem.empty()) throw SceneError(object + " (" + nameOf(shape.kind) + "): " + problem);
  const auto [lower, upper] = bounds(shape);
  const bool apart = (lower.array() >= domainUpper(scene).array()).any() ||
                     (upper.array() <= scene.domain.lower.array()).any();
  if (apart) throw SceneError(object + ": lies outside " + domainText(scene) + "; move it or remove it");
}

void checkInflow(const Scene& scene, const InflowSpec& inflow, const std::string& object,
                 const SignedDistance& psi) {
  const double dx = scene.dx();
  if (inflow.radius < kLeastOutletRadius * dx)
    throw SceneError(object + ": radius " + exactText(inflow.radius) + " m is too small for cells of " +
                     exactText(dx) + " m; at least " + exactText(kLeastOutletRadius * dx) +
                     " m, or a finer domain.resolution");
  for (const Eigen::Vector3d& point : outletPoints(inflow)) {
    if (!insideDomain(scene, point))
      throw SceneError(object + ": its outlet leaves " + domainText(scene) + " at " + text(point) +
                       "; move the centre or shrink the radius");
    if (psi(point) <= 0)
      throw SceneError(object + ": its outlet is inside a solid at " + text(point) +
                       "; move the inflow or the solid");
  }
  const Eigen::Vector3d back = inflow.centre - kRequiredCells * dx * inflow.direction.normalized();
  if (!insideDomain(scene, back))
    throw SceneError(
        object + ": the nozzle needs " + exactText(kRequiredCells * dx) +
        " m behind its outlet inside the domain; move the centre along its direction by at least that");
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
  for (const SolidSpec& solid : scene.solids) setup.solids.push_back(buildSolid(solid));
  for (const InflowSpec& inflow : scene.inflows) setup.inflows.push_back(buildInflow(inflow, scene.dx()));
  return setup;
}

SignedDistance initialPhi(const Scene& scene) {
  const double farAway = scene.domain.size.norm();
  return [bodies = scene.liquidBodies, farAway](const Eigen::Vector3d& x) {
    double phi = farAway;
    for (const LiquidBodySpec& body : bodies) phi = std::min(phi, signedDistance(body.shape, x));
    return phi;
  };
}

SignedDistance solidDistance(const Scene& scene) {
  return [solids = scene.solids](const Eigen::Vector3d& x) {
    double psi = std::numeric_limits<double>::infinity();
    for (const SolidSpec& solid : solids) psi = std::min(psi, signedDistance(solid.shape, x));
    return psi;
  };
}

void checkObjects(const Scene& scene) {
  std::set<std::string> names;
  const SignedDistance psi = solidDistance(scene);
  for (std::size_t i = 0; i < scene.solids.size(); ++i) {
    const std::string object = label("solid", scene.solids[i].name, i);
    checkName(scene.solids[i].name, object, names);
    checkBody(scene, scene.solids[i].shape, object);
  }
  for (std::size_t i = 0; i < scene.liquidBodies.size(); ++i) {
    const std::string object = label("liquid_body", scene.liquidBodies[i].name, i);
    checkName(scene.liquidBodies[i].name, object, names);
    checkBody(scene, scene.liquidBodies[i].shape, object);
  }
  for (std::size_t i = 0; i < scene.inflows.size(); ++i) {
    const std::string object = label("inflow", scene.inflows[i].name, i);
    checkName(scene.inflows[i].name, object, names);
    checkInflow(scene, scene.inflows[i], object, psi);
  }
  checkFoamObjects(scene);
}

}  // namespace spume::coupling
