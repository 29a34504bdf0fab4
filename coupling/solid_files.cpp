#include "coupling/solid_files.h"

// The only file that includes OpenVDB's conversion of meshes, which is slow to compile.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>

#include <cmath>
#include <limits>

#include "coupling/errors.h"
#include "coupling/object_label.h"
#include "coupling/toml_slot.h"
#include "coupling/triangle_mesh.h"
#include "coupling/vdb_file.h"

namespace spume::coupling {
namespace {

constexpr double kVoxelsPerCell =
    2;  // the distance is interpolated: its error stays below that of the cut cells
constexpr double kFarthest = 1e4;    // [m] from the origin, as the keys of a scene allow
constexpr int kMargin = 8;           // [voxels] sampled round a solid
constexpr float kHalfWidth = 3;      // [voxels] of the band that is measured against the triangles
constexpr double kBandShare = 0.99;  // of a level set's background: values closer to it are not distances

using Box = std::pair<Eigen::Vector3d, Eigen::Vector3d>;

/// Points that fill a box and its margin, at whole multiples of the spacing.
DistanceField fieldAround(const ShapeSpec& shape, const Box& box, double dx, double longest) {
  const Eigen::Vector3d size = box.second - box.first;
  const double reach = box.first.cwiseAbs().cwiseMax(box.second.cwiseAbs()).maxCoeff();
  if (!(size.maxCoeff() <= longest && reach <= kFarthest))
    throw KeyFault("scale", shape.file + ": is ",
                   exactText(size.maxCoeff()) + " m long and reaches " + exactText(reach) +
                       " m from its origin at scale = " + exactText(shape.scale) +
                       " [m per unit of the file]; at most " + exactText(longest) + " m and " +
                       exactText(kFarthest) +
                       " m in this domain; write scale = 0.01 for centimetres, 0.001 for millimetres");
  const double voxel = DistanceField::affordableVoxel(
      (size.array() + 2 * kMargin * dx / kVoxelsPerCell).matrix(), dx / kVoxelsPerCell);
  const Eigen::Vector3i first = (box.first / voxel).array().floor().cast<int>() - kMargin;
  const Eigen::Vector3i last = (box.second / voxel).array().ceil().cast<int>() + kMargin;
  return {voxel * first.cast<double>(), voxel, last - first + Eigen::Vector3i::Ones()};
}

template <typename Body>
void forEachPoint(const DistanceField& field, const Body& body) {
  for (int i = 0; i < field.points().x(); ++i)
    for (int j = 0; j < field.points().y(); ++j)
      for (int k = 0; k < field.points().z(); ++k) body(i, j, k);
}

Box boundsOf(const std::vector<Eigen::Vector3d>& vertices) {
  Box box{vertices.front(), vertices.front()};
  for (const Eigen::Vector3d& x : vertices) {
    box.first = box.first.cwiseMin(x);
    box.second = box.second.cwiseMax(x);
  }
  return box;
}

DistanceField meshDistance(const ShapeSpec& shape, double dx, double longest) {
  TriangleMesh mesh = readMesh(shape.file);
  requireClosed(mesh, shape.file);
  for (Eigen::Vector3d& x : mesh.vertices) x *= shape.scale;
  DistanceField field = fieldAround(shape, boundsOf(mesh.vertices), dx, longest);
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  for (const Eigen::Vector3d& x : mesh.vertices) points.emplace_back(x.x(), x.y(), x.z());
  for (const Eigen::Vector3i& t : mesh.triangles) triangles.emplace_back(t.x(), t.y(), t.z());
  const auto transform = openvdb::math::Transform::createLinearTransform(field.voxel());
  const auto grid =
      openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*transform, points, triangles, kHalfWidth);
  const auto accessor = grid->getConstAccessor();
  const Eigen::Vector3i first =
      (field.position(0, 0, 0) / field.voxel()).array().round().cast<int>().matrix();
  forEachPoint(field, [&](int i, int j, int k) {
    float value = 0;
    const bool measured = accessor.probeValue({first.x() + i, first.y() + j, first.z() + k}, value);
    measured ? field.setKnown(i, j, k, value) : field.setSide(i, j, k, value < 0);
  });
  field.extend();
  return field;
}

openvdb::FloatGrid::Ptr levelSetIn(const std::string& path) {
  for (const auto& grid : readVdb(path))
    if (grid->isType<openvdb::FloatGrid>() && grid->getGridClass() == openvdb::GRID_LEVEL_SET)
      return openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
  throw SceneError(path + ": holds no level set: a grid of floats with class GRID_LEVEL_SET is needed");
}

Box worldBounds(const openvdb::FloatGrid& grid) {
  const openvdb::BBoxd box = grid.transform().indexToWorld(grid.evalActiveVoxelBoundingBox());
  return {{box.min().x(), box.min().y(), box.min().z()}, {box.max().x(), box.max().y(), box.max().z()}};
}

DistanceField levelSetDistance(const ShapeSpec& shape, double dx, double longest) {
  const openvdb::FloatGrid::Ptr grid = levelSetIn(shape.file);
  if (grid->activeVoxelCount() == 0) throw SceneError(shape.file + ": its level set is empty");
  const Box box = worldBounds(*grid);
  DistanceField field = fieldAround(shape, {shape.scale * box.first, shape.scale * box.second}, dx, longest);
  const auto accessor = grid->getConstAccessor();
  const openvdb::tools::GridSampler<openvdb::FloatGrid::ConstAccessor, openvdb::tools::BoxSampler> sampler(
      accessor, grid->transform());
  forEachPoint(field, [&](int i, int j, int k) {
    const Eigen::Vector3d x = field.position(i, j, k) / shape.scale;
    const float value = sampler.wsSample({x.x(), x.y(), x.z()});
    const bool measured = std::abs(value) < kBandShare * grid->background();
    measured ? field.setKnown(i, j, k, shape.scale * value) : field.setSide(i, j, k, value < 0);
  });
  field.extend();
  return field;
}

}  // namespace

DistanceField distanceFromFile(const ShapeSpec& shape, double dx, double longest) {
  return shape.kind == ShapeKind::mesh ? meshDistance(shape, dx, longest)
                                       : levelSetDistance(shape, dx, longest);
}

}  // namespace spume::coupling
