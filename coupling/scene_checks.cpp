#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>

#include "coupling/domain_box.h"
#include "coupling/foam_objects.h"
#include "coupling/object_label.h"
#include "coupling/scene_builder.h"
#include "coupling/shapes.h"
#include "coupling/solid_motion.h"
#include "coupling/toml_slot.h"

namespace spume::coupling {
namespace {

constexpr double kRequiredCells = 2;         // [dx] of a nozzle that must lie inside the domain
constexpr double kLeastOutletRadius = 0.75;  // [dx] a smaller disc may miss every cell centre
constexpr int kRimPoints = 16;               // of an outlet, tested against solids

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

void checkName(const std::string& name, const std::string& object, std::set<std::string>& names) {
  if (!name.empty() && !names.insert(name).second)
    throw SceneError(object + ": another object has the same name; give each its own");
}

void checkShape(const ShapeSpec& shape, const std::string& object) {
  const std::string problem = defect(shape);
  if (!problem.empty()) throw SceneError(object + " (" + nameOf(shape.kind) + "): " + problem);
}

void checkInDomain(const Scene& scene, const ShapeSpec& shape, const std::string& object) {
  DomainBox(scene).requireOverlap(shape, object);
}

void checkSolid(const Scene& scene, const SolidSpec& solid, const std::string& object) {
  checkShape(solid.shape, object);
  if (!(solid.motion.rotationAxis.norm() > 0))
    throw SceneError(object + ": rotation_axis must not be the zero vector");
  const Pose pose = poseAt(solid.motion, 0);
  const bool placed = pose.rotation.isIdentity() && pose.offset.isZero();
  if (placed && !moves(solid.motion)) checkInDomain(scene, solid.shape, object);
}

void checkLiquidBody(const Scene& scene, const LiquidBodySpec& body, const std::string& object) {
  if (body.vessel.empty()) {
    checkShape(body.shape, object);
    return checkInDomain(scene, body.shape, object);
  }
  const SolidSpec* vessel = vesselOf(scene, body);
  if (!vessel)
    throw SceneError(object + ": vessel = \"" + body.vessel +
                     "\" is not the name of a [[solid]] of shape \"vessel\"");
  if (!(body.depth > 0 && body.depth <= vessel->shape.innerHeight))
    throw SceneError(object + ": depth " + exactText(body.depth) + " m does not fit the vessel '" +
                     body.vessel + "'; allowed: more than 0, up to its inner_height of " +
                     exactText(vessel->shape.innerHeight) + " m");
}

void checkInflow(const Scene& scene, const InflowSpec& inflow, const std::string& object,
                 const SignedDistance& psi) {
  const DomainBox domain(scene);
  const double dx = scene.dx();
  if (inflow.radius < kLeastOutletRadius * dx)
    throw SceneError(object + ": radius " + exactText(inflow.radius) + " m is too small for cells of " +
                     exactText(dx) + " m; at least " + exactText(kLeastOutletRadius * dx) +
                     " m, or a finer domain.resolution");
  for (const Eigen::Vector3d& point : outletPoints(inflow)) {
    if (!domain.holds(point))
      throw SceneError(object + ": its outlet leaves " + domain.words() + " at " + exactText(point) +
                       "; move the centre or shrink the radius");
    if (psi(point) <= 0)
      throw SceneError(object + ": its outlet is inside a solid at " + exactText(point) +
                       "; move the inflow or the solid");
  }
  const Eigen::Vector3d back = inflow.centre - kRequiredCells * dx * inflow.direction.normalized();
  if (!domain.holds(back))
    throw SceneError(
        object + ": the nozzle needs " + exactText(kRequiredCells * dx) +
        " m behind its outlet inside the domain; move the centre along its direction by at least that");
}

void checkOutflow(const Scene& scene, const OutflowSpec& outflow, const std::string& object) {
  checkShape(outflow.shape, object);
  checkInDomain(scene, outflow.shape, object);
  const fluid::GridSpec grid = gridOf(scene);
  const int fewest = outflow.mode == DrainMode::free ? fluid::kFewestFreeCells : 1;
  int cells = 0;
  for (int i = 0; i < grid.cells.x() && cells < fewest; ++i)
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k)
        cells += signedDistance(outflow.shape, grid.cellCentre(i, j, k)) < 0;
  if (cells < fewest)
    throw SceneError(object + ": holds " + std::to_string(cells) + " cell centres, at least " +
                     std::to_string(fewest) + " are needed; make it larger or raise domain.resolution");
}

void checkProbe(const Scene& scene, const ProbeSpec& probe, const std::string& object) {
  if (probe.kind == ProbeKind::volume) {
    checkShape(probe.shape, object);
    checkInDomain(scene, probe.shape, object);
  } else if (!DomainBox(scene).holds(probe.position)) {
    throw SceneError(object + ": position " + exactText(probe.position) + " lies outside " +
                     DomainBox(scene).words());
  }
}

}  // namespace

void checkObjects(const Scene& scene) {
  std::set<std::string> names;
  const auto checkEach = [&](const std::string& table, const auto& objects, const auto& check) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const std::string object = objectLabel(table, objects[i].name, i);
      checkItem(table, i, [&] {
        checkName(objects[i].name, object, names);
        check(scene, objects[i], object);
      });
    }
  };
  checkEach("solid", scene.solids, checkSolid);
  const SignedDistance psi = solidDistance(scene);
  checkEach("liquid_body", scene.liquidBodies, checkLiquidBody);
  checkEach("inflow", scene.inflows,
            [&](const Scene& s, const InflowSpec& inflow, const std::string& object) {
              checkInflow(s, inflow, object, psi);
            });
  checkEach("outflow", scene.outflows, checkOutflow);
  checkEach("probe", scene.probes, checkProbe);
  checkFoamObjects(scene);
}

}  // namespace spume::coupling
