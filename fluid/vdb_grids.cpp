#include "fluid/vdb_grids.h"

#include <openvdb/tools/Prune.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "fluid/level_set_repair.h"
#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

constexpr char kCellsKey[] = "spume_cells";
constexpr char kOriginKey[] = "spume_origin";
constexpr int kSurfaceMargin = kSurfaceBand + 1;  // voxels beyond the box that its closed surface needs

Coord toCoord(const Eigen::Vector3i& v) { return {v.x(), v.y(), v.z()}; }
Eigen::Vector3i toCell(const Coord& c) { return {c.x(), c.y(), c.z()}; }
openvdb::Vec3d toVdb(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

void describe(openvdb::GridBase& grid, const GridSpec& spec, const std::string& name) {
  const auto transform = openvdb::math::Transform::createLinearTransform(spec.dx);
  transform->postTranslate(toVdb(spec.cellCentre(0, 0, 0)));
  grid.setTransform(transform);
  grid.setName(name);
  grid.setSaveFloatAsHalf(false);
  grid.insertMeta(kCellsKey, openvdb::Vec3IMetadata({spec.cells.x(), spec.cells.y(), spec.cells.z()}));
  grid.insertMeta(kOriginKey, openvdb::Vec3DMetadata(toVdb(spec.origin)));
}

std::vector<Coord> leafOrigins(const CoordBBox& region, int dim) {
  std::vector<Coord> origins;
  const Coord low = region.min() & ~(dim - 1);
  for (int i = low.x(); i <= region.max().x(); i += dim)
    for (int j = low.y(); j <= region.max().y(); j += dim)
      for (int k = low.z(); k <= region.max().z(); k += dim) origins.emplace_back(i, j, k);
  return origins;
}

/// Builds a grid over `region` from voxel(coord, value), which returns whether the voxel is active; the value
/// of an inactive one is kept too (a level set's inside). Leaves are made in parallel and joined in order.
template <typename Grid, typename Voxel>
typename Grid::Ptr buildGrid(const CoordBBox& region, const typename Grid::ValueType& background,
                             const Voxel& voxel) {
  using Leaf = typename Grid::TreeType::LeafNodeType;
  const auto grid = Grid::create(background);
  const std::vector<Coord> origins = leafOrigins(region, Leaf::DIM);
  std::vector<std::unique_ptr<Leaf>> leaves(origins.size());
  tbb::parallel_for(std::size_t{0}, origins.size(), [&](std::size_t n) {
    leaves[n] = std::make_unique<Leaf>(origins[n], background);
    for (openvdb::Index offset = 0; offset < Leaf::SIZE; ++offset) {
      const Coord at = leaves[n]->offsetToGlobalCoord(offset);
      if (!region.isInside(at)) continue;
      typename Grid::ValueType value = background;
      const bool active = voxel(at, value);
      leaves[n]->setValueOnly(offset, value);
      leaves[n]->setActiveState(offset, active);
    }
  });
  for (auto& leaf : leaves) {
    if (leaf->isEmpty()) {
      grid->tree().addTile(1, leaf->origin(), leaf->getValue(0), false);
    } else {
      grid->tree().addLeaf(leaf.release());
    }
  }
  return grid;
}

/// The band [m], rounded up: OpenVDB refuses a background below three voxels by a rounding.
float bandOf(const GridSpec& grid) {
  return std::nextafter(static_cast<float>(kSurfaceBand * grid.dx), std::numeric_limits<float>::max());
}

/// Distance from a cell centre to the border of the grid's box [cells], < 0 inside.
double borderDistance(const GridSpec& grid, const Eigen::Vector3i& cell) {
  const Eigen::Array3d half = 0.5 * grid.cells.cast<double>().array();
  const Eigen::Array3d excess = (cell.cast<double>().array() + 0.5 - half).abs() - half;
  return excess.max(0.0).matrix().norm() + std::min(excess.maxCoeff(), 0.0);
}

Eigen::Vector3i clampedTo(const Eigen::Vector3i& size, const Eigen::Vector3i& cell, int margin = 0) {
  const Eigen::Vector3i low =
      Eigen::Vector3i::Constant(margin).cwiseMin((size - Eigen::Vector3i::Ones()) / 2);
  return cell.cwiseMax(low).cwiseMin(size - Eigen::Vector3i::Ones() - low);
}

/// Whether a cell touches two sides of the grid or more: there the closed surface has an edge, which is
/// repaired.
bool isAtEdge(const Eigen::Vector3i& size, const Eigen::Vector3i& cell) {
  const Eigen::Array3i last = size.array() - 1;
  return (cell.array() == 0 || cell.array() == last).count() >= 2;
}

/// phi closed at the border of the grid's box, clamped to the band and repaired, on the grid's cells and
/// kSurfaceMargin more on each side.
DenseField<float> closedSurface(const GridSpec& grid, const DenseField<float>& phi, float band) {
  const Eigen::Vector3i margin = Eigen::Vector3i::Constant(kSurfaceMargin);
  DenseField<float> closed(grid.cells + 2 * margin, band);
  forEachCell(closed.size(), [&](int i, int j, int k) {
    const Eigen::Vector3i cell = Eigen::Vector3i(i, j, k) - margin;
    const float border = static_cast<float>(borderDistance(grid, cell) * grid.dx);
    closed(i, j, k) = std::clamp(std::max(phi(clampedTo(grid.cells, cell)), border), -band, band);
  });
  repairLevelSet(closed, grid.dx, band);
  return closed;
}

Eigen::Vector3f centreVelocity(const MacVelocity& velocity, const Eigen::Vector3i& cell) {
  Eigen::Vector3f value;
  for (int axis = 0; axis < 3; ++axis)
    value[axis] = 0.5f * (velocity[axis](cell) + velocity[axis](cell + Eigen::Vector3i::Unit(axis)));
  return value;
}

/// The minus faces of a cell; those of the cell past the last exist along one axis only, the others are 0.
Eigen::Vector3f minusFaces(const MacVelocity& velocity, const Eigen::Vector3i& cell) {
  Eigen::Vector3f value;
  for (int axis = 0; axis < 3; ++axis) {
    const bool exists = velocity[axis].contains(cell.x(), cell.y(), cell.z());
    value[axis] = exists ? velocity[axis](cell) : 0.0f;
  }
  return value;
}

DenseField<float> readField(const openvdb::FloatGrid& grid) {
  const GridSpec spec = gridSpecOf(grid);
  DenseField<float> field(spec.cells);
  forEachRow(spec.cells, [&](int i, int j) {
    const auto accessor = grid.getConstAccessor();
    for (int k = 0; k < spec.cells.z(); ++k) field(i, j, k) = accessor.getValue({i, j, k});
  });
  return field;
}

}  // namespace

openvdb::FloatGrid::Ptr surfaceGrid(const GridSpec& grid, const DenseField<float>& phi) {
  const float band = bandOf(grid);
  const DenseField<float> closed = closedSurface(grid, phi, band);
  const CoordBBox region(toCoord(Eigen::Vector3i::Constant(-kSurfaceMargin)),
                         toCoord(grid.cells + Eigen::Vector3i::Constant(kSurfaceMargin - 1)));
  const auto voxel = [&](const Coord& at, float& value) {
    value = closed(toCell(at) + Eigen::Vector3i::Constant(kSurfaceMargin));
    return std::abs(value) < band;
  };
  const auto surface = buildGrid<openvdb::FloatGrid>(region, band, voxel);
  surface->setGridClass(openvdb::GRID_LEVEL_SET);
  describe(*surface, grid, "surface");
  openvdb::tools::pruneLevelSet(surface->tree());
  return surface;
}

openvdb::Vec3SGrid::Ptr velocityGrid(const LiquidState& liquid, bool staggered) {
  const Eigen::Vector3i& cells = liquid.grid.cells;
  const float band = bandOf(liquid.grid);
  const Eigen::Vector3i last = staggered ? cells : Eigen::Vector3i(cells - Eigen::Vector3i::Ones());
  const auto voxel = [&](const Coord& at, openvdb::Vec3s& value) {
    const Eigen::Vector3i cell = toCell(at);
    if (liquid.phi(clampedTo(cells, cell)) >= band) return false;
    const Eigen::Vector3f v =
        staggered ? minusFaces(liquid.velocity, cell) : centreVelocity(liquid.velocity, cell);
    value = {v.x(), v.y(), v.z()};
    return true;
  };
  const auto grid =
      buildGrid<openvdb::Vec3SGrid>({Coord(0, 0, 0), toCoord(last)}, openvdb::Vec3s(0.0f), voxel);
  grid->setGridClass(staggered ? openvdb::GRID_STAGGERED : openvdb::GRID_UNKNOWN);
  grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
  describe(*grid, liquid.grid, "vel");
  return grid;
}

openvdb::FloatGrid::Ptr solidGrid(const GridSpec& grid, const DenseField<float>& psi) {
  const CoordBBox region(Coord(0, 0, 0), toCoord(grid.cells - Eigen::Vector3i::Ones()));
  const auto voxel = [&](const Coord& at, float& value) {
    value = psi(toCell(at));
    return true;
  };
  const auto solid = buildGrid<openvdb::FloatGrid>(region, bandOf(grid), voxel);
  describe(*solid, grid, "solid");
  return solid;
}

GridSpec gridSpecOf(const openvdb::GridBase& grid) {
  const auto cells = grid.getMetadata<openvdb::Vec3IMetadata>(kCellsKey);
  const auto origin = grid.getMetadata<openvdb::Vec3DMetadata>(kOriginKey);
  if (!cells || !origin)
    throw std::invalid_argument("grid '" + grid.getName() + "' has no metadata " + kCellsKey + " and " +
                                kOriginKey);
  GridSpec spec;
  for (int axis = 0; axis < 3; ++axis) {
    spec.cells[axis] = cells->value()[axis];
    spec.origin[axis] = origin->value()[axis];
  }
  spec.dx = grid.voxelSize().x();
  return spec;
}

DenseField<float> phiFrom(const openvdb::FloatGrid& surface) {
  const GridSpec spec = gridSpecOf(surface);
  const DenseField<float> closed = readField(surface);
  const double exactly = 1e-6 * spec.dx;  // float rounding of a few cells' distance
  const auto isBorder = [&](const Eigen::Vector3i& cell) {
    return closed(cell) <= borderDistance(spec, cell) * spec.dx + exactly;
  };
  DenseField<float> phi(spec.cells);
  forEachCell(spec.cells, [&](int i, int j, int k) {
    Eigen::Vector3i cell(i, j, k);
    if (isAtEdge(spec.cells, cell)) cell = clampedTo(spec.cells, cell, 1);
    phi(i, j, k) = closed(isBorder(cell) ? clampedTo(spec.cells, cell, kSurfaceBand) : cell);
  });
  return phi;
}

MacVelocity velocityFrom(const openvdb::Vec3SGrid& velocity) {
  const GridSpec spec = gridSpecOf(velocity);
  const bool staggered = velocity.getGridClass() == openvdb::GRID_STAGGERED;
  MacVelocity faces(spec.cells);
  for (int axis = 0; axis < 3; ++axis) {
    const Coord step = toCoord(Eigen::Vector3i::Unit(axis));
    forEachRow(faces[axis].size(), [&](int i, int j) {
      const auto accessor = velocity.getConstAccessor();
      for (int k = 0; k < faces[axis].size().z(); ++k) {
        const Coord plus(i, j, k), minus = plus - step;
        openvdb::Vec3s below(0.0f), above(0.0f);
        const bool hasBelow = accessor.probeValue(minus, below), hasAbove = accessor.probeValue(plus, above);
        const float mean =
            hasBelow && hasAbove ? 0.5f * (below[axis] + above[axis]) : below[axis] + above[axis];
        faces[axis](i, j, k) = staggered ? above[axis] : mean;
      }
    });
  }
  return faces;
}

DenseField<float> psiFrom(const openvdb::FloatGrid& solid) { return readField(solid); }

}  // namespace spume::fluid
