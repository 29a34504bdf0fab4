#include "fluid/extrapolation.h"

#include <algorithm>
#include <array>

#include "fluid/level_set.h"
#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

/// Weight of a known neighbour that does not lie towards the liquid, relative to one that lies straight
/// towards it: only decides where no neighbour does (a medial line, the inside of a wall).
constexpr float kSidewaysWeight = 1e-3f;

bool holdsLiquid(const DenseField<float>& phi, const SolidBoundary& solids, int i, int j, int k) {
  return phi.contains(i, j, k) && phi(i, j, k) < 0 && solids.cellFraction(i, j, k) > 0;
}

}  // namespace

VelocityExtrapolator::VelocityExtrapolator(const GridSpec& grid) : grid_(grid) {
  for (int a = 0; a < 3; ++a) layers_[a] = LayerList(grid.cells + Eigen::Vector3i::Unit(a));
}

void VelocityExtrapolator::markKnown(int axis, const DenseField<float>& phi, const SolidBoundary& solids) {
  DenseField<std::uint8_t>& marks = layers_[axis].marks();
  const Eigen::Vector3i back = -Eigen::Vector3i::Unit(axis);
  forEachCell(marks.size(), [&](int i, int j, int k) {
    const bool wet = holdsLiquid(phi, solids, i, j, k) ||
                     holdsLiquid(phi, solids, i + back.x(), j + back.y(), k + back.z());
    const bool open = solids.open[axis](i, j, k) > 0;
    const bool known = (wet && open) || solids.prescribed[axis](i, j, k);
    marks(i, j, k) = known ? std::uint8_t{0} : LayerList::kUnreached;
  });
}

void VelocityExtrapolator::spread(int axis, int layer, const DenseField<float>& phi,
                                  DenseField<float>& component) const {
  const DenseField<std::uint8_t>& marks = layers_[axis].marks();
  const std::array<std::ptrdiff_t, 3> phiStride{phi.stride(0), phi.stride(1), 1};
  const float sideways = kSidewaysWeight * 2 * static_cast<float>(grid_.dx);
  const auto faces = layers_[axis].layer(layer);
  tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t n) {
    const std::ptrdiff_t face = faces[n];
    const int i = static_cast<int>(face / component.stride(0)) - kGhost;
    const int j = static_cast<int>(face % component.stride(0) / component.stride(1)) - kGhost;
    const int k = static_cast<int>(face % component.stride(1)) - kGhost;
    const std::uint8_t* mark = &marks(i, j, k);
    const float* p = &phi(i, j, k);  // the face lies between p and the cell before it: twice phi is their sum
    const std::ptrdiff_t back = phiStride[axis];
    float sum = 0, weights = 0;
    for (int a = 0; a < 3; ++a)
      for (const int side : {-1, 1}) {
        if (mark[side * marks.stride(a)] >= layer) continue;
        const float* q = p + side * phiStride[a];
        const float weight = std::max(p[0] + p[-back] - q[0] - q[-back], 0.0f) + sideways;
        sum += weight * component.data()[face + side * component.stride(a)];
        weights += weight;
      }
    component.data()[face] = sum / weights;
  });
}

void VelocityExtrapolator::apply(const DenseField<float>& phi, const SolidBoundary& solids, int layers,
                                 MacVelocity& velocity) {
  for (int axis = 0; axis < 3; ++axis) {
    markKnown(axis, phi, solids);
    layers_[axis].grow(layers);
    DenseField<float>& component = velocity[axis];
    const DenseField<std::uint8_t>& marks = layers_[axis].marks();
    for (int layer = 1; layer <= layers; ++layer) spread(axis, layer, phi, component);
    forEachCell(marks.size(), [&](int i, int j, int k) {
      if (marks(i, j, k) == LayerList::kUnreached) component(i, j, k) = 0;
    });
  }
  fillGhostLayers(velocity);
}

void constrainToSolids(const SolidBoundary& solids, MacVelocity& velocity) {
  for (int axis = 0; axis < 3; ++axis)
    forEachCell(velocity[axis].size(), [&](int i, int j, int k) {
      const bool closed = solids.open[axis](i, j, k) <= 0;
      if (closed || solids.prescribed[axis](i, j, k))
        velocity[axis](i, j, k) = solids.velocity[axis](i, j, k);
    });
  fillGhostLayers(velocity);
}

}  // namespace spume::fluid
