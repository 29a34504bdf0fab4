#include "coupling/liquid_cache.h"

#include <algorithm>

#include "coupling/vdb_file.h"
#include "fluid/level_set.h"
#include "fluid/parallel.h"
#include "fluid/reinitialize.h"
#include "fluid/vdb_grids.h"

namespace spume::coupling {
namespace {

/// Distance [m] to the box of the grid, > 0 inside: what psi is when only the walls are there.
fluid::DenseField<float> boxDistance(const fluid::GridSpec& grid) {
  fluid::DenseField<float> psi(grid.cells);
  fluid::forEachCell(grid.cells, [&](int i, int j, int k) {
    const Eigen::Vector3d centre = grid.cellCentre(i, j, k);
    psi(i, j, k) = static_cast<float>((centre - grid.origin).cwiseMin(grid.upper() - centre).minCoeff());
  });
  return psi;
}

/// The liquid closed half a cell inside solids, as the grid closes it at the walls of the domain. phi is
/// continued into solids from both sides: in a thin wall it would jump from deep liquid to far air without a
/// voxel of the band in between, which no level set may. The half cell keeps a drawn liquid in touch with its
/// glass. The larger of two distances is none round the edges where surface and glass meet: near solids it is
/// made one again.
fluid::DenseField<float> closedInSolids(const fluid::LiquidState& liquid,
                                        const fluid::DenseField<float>& psi) {
  if (psi.size() != liquid.grid.cells) return liquid.phi;  // without solids
  const float reach = static_cast<float>(0.5 * liquid.grid.dx);
  fluid::DenseField<float> closed(liquid.grid.cells);
  fluid::forEachCell(liquid.grid.cells, [&](int i, int j, int k) {
    closed(i, j, k) = std::max(liquid.phi(i, j, k), -psi(i, j, k) - reach);
  });
  fluid::fillGhostLayers(closed);
  fluid::Reinitializer(liquid.grid).apply(closed);
  const float far = static_cast<float>((fluid::kSurfaceBand + 1) * liquid.grid.dx);
  fluid::forEachCell(liquid.grid.cells, [&](int i, int j, int k) {
    if (psi(i, j, k) > far) closed(i, j, k) = liquid.phi(i, j, k);
  });
  return closed;
}

}  // namespace

void writeLiquidFrame(const std::string& path, const fluid::LiquidState& liquid,
                      const fluid::SolidBoundary& solids, const FrameStamp& stamp,
                      const LiquidCacheOptions& options) {
  openvdb::initialize();
  openvdb::GridPtrVec grids{fluid::surfaceGrid(liquid.grid, closedInSolids(liquid, solids.psi)),
                            fluid::velocityGrid(liquid, options.staggeredVelocity)};
  if (options.solid) grids.push_back(fluid::solidGrid(liquid.grid, solids.psi));
  for (const auto& grid : grids) stampGrid(*grid, stamp);
  writeVdb(path, {grids.begin(), grids.end()});
}

LiquidFrame readLiquidFrame(const std::string& path) {
  const openvdb::GridPtrVec grids = readVdb(path);
  const auto surface = findGrid<openvdb::FloatGrid>(grids, "surface");
  const auto velocity = findGrid<openvdb::Vec3SGrid>(grids, "vel");
  const auto solid = findGrid<openvdb::FloatGrid>(grids, "solid");
  if (!surface || !velocity)
    throw SceneError(path + ": holds no liquid: the grids surface and vel are needed");
  LiquidFrame frame;
  try {
    frame.stamp = stampOf(*surface);
    frame.liquid.grid = fluid::gridSpecOf(*surface);
    frame.liquid.time = frame.stamp.time;
    frame.liquid.phi = fluid::phiFrom(*surface);
    frame.liquid.velocity = fluid::velocityFrom(*velocity);
    frame.psi = solid ? fluid::psiFrom(*solid) : boxDistance(frame.liquid.grid);
    frame.hasSolid = solid != nullptr;
  } catch (const std::invalid_argument& error) {
    throw SceneError(path + ": was not written by this program: " + error.what());
  }
  return frame;
}

}  // namespace spume::coupling
