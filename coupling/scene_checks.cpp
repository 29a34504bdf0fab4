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

void checkName(const std::string& name, std::set<std::string>& names) {
  if (!name.empty() && !names.insert(name).second)
    throw KeyFault("name", "= " + quoted(name) + " is that of another object too; give each its own");
}

void checkShape(const Scene& scene, const ShapeSpec& shape) {
  requireUsable(shape);
  DomainBox(scene).requireOverlap(shape);
}

void checkSolid(const Scene& scene, const SolidSpec& solid) {
  requireUsable(solid.shape);
  if (!(solid.motion.rotationAxis.norm() > 0))
    throw KeyFault("rotation_axis", "= [0, 0, 0] has no direction; [0, 1, 0] points upwards");
  const Pose pose = poseAt(solid.motion, 0);
  const bool placed = pose.rotation.isIdentity() && pose.offset.isZero();
  if (placed && !moves(solid.motion)) DomainBox(scene).requireOverlap(solid.shape);
}

void checkLiquidBody(const Scene& scene, const LiquidBodySpec& body) {
  if (body.vessel.empty()) return checkShape(scene, body.shape);
  const SolidSpec* vessel = vesselOf(scene, body);
  if (!vessel)
    throw KeyFault("vessel", "= " + quoted(body.vessel) +
                                 " is not the name of a [[solid]] of shape \"vessel\"; give one that name");
  if (!(body.depth > 0 && body.depth <= vessel->shape.innerHeight))
    throw KeyFault("depth", "= " + exactText(body.depth) + " m does not fit the vessel '" + body.vessel +
                                "'; allowed: more than 0, up to its inner_height of " +
                                exactText(vessel->shape.innerHeight) + " m");
}

void checkInflow(const Scene& scene, const InflowSpec& inflow, const SignedDistance& psi) {
  const DomainBox domain(scene);
  const double dx = scene.dx();
  const std::string centre = "= " + exactText(inflow.centre) + " m";
  if (inflow.radius < kLeastOutletRadius * dx)
    throw KeyFault("radius", "= " + exactText(inflow.radius) + " m is too small for cells of " +
                                 exactText(dx) + " m; at least " + exactText(kLeastOutletRadius * dx) +
                                 " m, or a finer domain.resolution");
  for (const Eigen::Vector3d& point : outletPoints(inflow)) {
    if (!domain.holds(point))
      throw KeyFault("centre", centre + ": its outlet leaves " + domain.words() + " at " + exactText(point) +
                                   " m; move the centre or shrink the radius");
    if (psi(point) <= 0)
      throw KeyFault("centre", centre + ": its outlet is inside a solid at " + exactText(point) +
                                   " m; move the inflow or the solid");
  }
  const Eigen::Vector3d back = inflow.centre - kRequiredCells * dx * inflow.direction.normalized();
  if (!domain.holds(back))
    throw KeyFault("centre", centre + ": the nozzle needs " + exactText(kRequiredCells * dx) +
                                 " m behind its outlet inside the domain; move the centre along its "
                                 "direction by at least that");
}

void checkOutflow(const Scene& scene, const OutflowSpec& outflow) {
  checkShape(scene, outflow.shape);
  const fluid::GridSpec grid = gridOf(scene);
  const int fewest = outflow.mode == DrainMode::free ? fluid::kFewestFreeCells : 1;
  int cells = 0;
  for (int i = 0; i < grid.cells.x() && cells < fewest; ++i)
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k)
        cells += signedDistance(outflow.shape, grid.cellCentre(i, j, k)) < 0;
  const auto& [key, value] = sizeKey(outflow.shape);
  if (cells < fewest)
    throw KeyFault(key, value + ": the outflow holds " + std::to_string(cells) + " centres of cells of " +
                            exactText(grid.dx) + " m, at least " + std::to_string(fewest) +
                            " are needed; make it larger or raise domain.resolution");
}

void checkProbe(const Scene& scene, const ProbeSpec& probe) {
  if (probe.kind == ProbeKind::volume) return checkShape(scene, probe.shape);
  if (!DomainBox(scene).holds(probe.position))
    throw KeyFault("position", "= " + exactText(probe.position) + " m lies outside " +
                                   DomainBox(scene).words() + "; move the probe or the domain");
}

}  // namespace

void checkObjects(const Scene& scene) {
  std::set<std::string> names;
  const auto checkEach = [&](const std::string& table, const auto& objects, const auto& check) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const auto checkOne = [&] {
        checkName(objects[i].name, names);
        check(scene, objects[i]);
      };
      checkItem(table, i, checkOne, objectLabel(table, objects[i].name, i));
    }
  };
  checkEach("solid", scene.solids, checkSolid);
  const SignedDistance psi = solidDistance(scene);
  checkEach("liquid_body", scene.liquidBodies, checkLiquidBody);
  checkEach("inflow", scene.inflows,
            [&](const Scene& s, const InflowSpec& inflow) { checkInflow(s, inflow, psi); });
  checkEach("outflow", scene.outflows, checkOutflow);
  checkEach("probe", scene.probes, checkProbe);
  checkFoamObjects(scene);
}

}  // namespace spume::coupling
