#include "fluid/extrapolation.h"

#include "fluid/level_set.h"
#include "fluid/parallel.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// Weight of a known neighbour that does not lie towards the liquid, relative to one that lies straight
/// towards it: only decides where no neighbour does (a medial line, the inside of a wall).
constexpr float kSidewaysWeight = 1e-3f;
/// Faces handled by one task at least.
constexpr std::size_t kFaceGrain = 256;

// The loops over a row stand alone so that nothing they read can alias what they write.

/// Marks the faces of a row that touch a cell with liquid and are open, or are prescribed: 0, else
/// kUnreached. The face k lies between the cells k - back and k; cells outside the grid have the fluid
/// fraction 0.
[[gnu::noinline]] void markKnownRow(const float* __restrict phi, const float* __restrict fraction,
                                    std::ptrdiff_t back, const float* __restrict open,
                                    const std::uint8_t* __restrict given, int count,
                                    std::uint8_t* __restrict mark) {
  for (int k = 0; k < count; ++k) {
    const bool upper = (phi[k] < 0) & (fraction[k] > 0);
    const bool lower = (phi[k - back] < 0) & (fraction[k - back] > 0);
    const bool known = ((upper | lower) & (open[k] > 0)) | (given[k] != 0);
    mark[k] = known ? std::uint8_t{0} : LayerList::kUnreached;
  }
}

[[gnu::noinline]] void clearBeyondRow(const std::uint8_t* __restrict mark, std::uint8_t lastLayer, int count,
                                      float* __restrict value) {
  for (int k = 0; k < count; ++k) value[k] = mark[k] > lastLayer ? 0 : value[k];
}

[[gnu::noinline]] void constrainRow(const float* __restrict open, const std::uint8_t* __restrict given,
                                    const float* __restrict solid, int count, float* __restrict value) {
  for (int k = 0; k < count; ++k) value[k] = (open[k] <= 0) | (given[k] != 0) ? solid[k] : value[k];
}

/// Mean of the known values around a face, weighted by how straight towards the liquid they lie.
struct WeightedMean {
  float sum = 0, weights = 0;
  void add(bool known, float towards, float value) {
    const float weight = known ? towards : 0;
    sum += known ? weight * value : 0;
    weights += weight;
  }
};

}  // namespace

VelocityExtrapolator::VelocityExtrapolator(const GridSpec& grid) : grid_(grid) {
  for (int a = 0; a < 3; ++a) layers_[a] = LayerList(grid.cells + Eigen::Vector3i::Unit(a));
}

void VelocityExtrapolator::markKnown(int axis, const DenseField<float>& phi, const SolidBoundary& solids) {
  DenseField<std::uint8_t>& marks = layers_[axis].marks();
  forEachRow(marks.size(), [&](int i, int j) {
    markKnownRow(&phi(i, j, 0), &solids.cellFraction(i, j, 0), phi.stride(axis), &solids.open[axis](i, j, 0),
                 &solids.prescribed[axis](i, j, 0), marks.size().z(), &marks(i, j, 0));
  });
}

void VelocityExtrapolator::spread(int axis, int layer, const DenseField<float>& phi,
                                  DenseField<float>& component) const {
  const DenseField<std::uint8_t>& marks = layers_[axis].marks();
  const std::ptrdiff_t back = phi.stride(axis);
  const float sideways = kSidewaysWeight * 2 * static_cast<float>(grid_.dx);
  const auto faces = layers_[axis].layer(layer);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), kFaceGrain), [&](const auto& range) {
    RowCursor at(component);
    for (std::size_t n = range.begin(); n < range.end(); ++n) {
      at.seek(faces[n]);
      const std::uint8_t* mark = &marks(at.i, at.j, at.k);
      const float* p = &phi(at.i, at.j, at.k);
      float* value = component.data() + faces[n];
      const float here = p[0] + p[-back] + sideways;  // the face lies between p and p - back: twice phi
      WeightedMean mean;
      for (int a = 0; a < 3; ++a)
        for (const int side : {-1, 1}) {
          const float* q = p + side * phi.stride(a);
          const float towards = larger(here - q[0] - q[-back], sideways);
          mean.add(mark[side * marks.stride(a)] < layer, towards, value[side * component.stride(a)]);
        }
      *value = mean.sum / mean.weights;
    }
  });
}

/// What flows out of an air cell [m/s], shared by its faces that lie beyond it: unknown ones opposite to a
/// known one.
float VelocityExtrapolator::outflowShare(const Eigen::Vector3i& cell, const MacVelocity& velocity) const {
  float net = 0;
  int beyond = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3i upper = cell + Eigen::Vector3i::Unit(axis);
    const DenseField<std::uint8_t>& marks = layers_[axis].marks();
    net += velocity[axis](upper) - velocity[axis](cell);
    beyond += (marks(upper) == 0) != (marks(cell) == 0);
  }
  return net / static_cast<float>(beyond);
}

/// What to add to a face of the first layer so that the air cell between it and a known face keeps its
/// volume, no more than the change of velocity from the known face before that one goes on. 0 where known
/// faces lie on both sides: what closes there is not one flow.
float VelocityExtrapolator::continuation(int axis, const Eigen::Vector3i& face, const DenseField<float>& phi,
                                         const SolidBoundary& solids, const MacVelocity& velocity) const {
  const DenseField<std::uint8_t>& marks = layers_[axis].marks();
  const DenseField<float>& u = velocity[axis];
  const Eigen::Vector3i step = Eigen::Vector3i::Unit(axis);
  const auto known = [&](int reach) {
    const Eigen::Vector3i f = face + reach * step;
    return f[axis] >= 0 && f[axis] < marks.size()[axis] && marks(f) == 0;
  };
  const bool below = known(-1), above = known(1);
  if (below == above) return 0;
  const int side = below ? -1 : 1;
  const Eigen::Vector3i cell = below ? Eigen::Vector3i(face - step) : face;
  if (!known(2 * side) || known(-2 * side)) return 0;
  if (!(phi(cell) >= 0) || solids.cellFraction(cell) < 1) return 0;
  const float balance = static_cast<float>(side) * outflowShare(cell, velocity);
  const float goesOn = 2 * u(face + side * step) - u(face + 2 * side * step) - u(face);
  if (!(balance * goesOn > 0)) return 0;
  return std::abs(balance) < std::abs(goesOn) ? balance : goesOn;
}

void VelocityExtrapolator::apply(const DenseField<float>& phi, const SolidBoundary& solids, int layers,
                                 MacVelocity& velocity, bool surfaceStands) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!surfaceStands || layers_[axis].layers() <= layers) {
      markKnown(axis, phi, solids);
      layers_[axis].grow(layers, 1);
    }
    DenseField<float>& component = velocity[axis];
    const DenseField<std::uint8_t>& marks = layers_[axis].marks();
    for (int layer = 1; layer <= layers; ++layer) spread(axis, layer, phi, component);
    forEachRow(marks.size(), [&](int i, int j) {
      clearBeyondRow(&marks(i, j, 0), static_cast<std::uint8_t>(layers), marks.size().z(),
                     &component(i, j, 0));
    });
  }
  fillGhostLayers(velocity);
}

void VelocityExtrapolator::goOn(const DenseField<float>& phi, const SolidBoundary& solids,
                                MacVelocity& velocity, bool surfaceStands) {
  for (int axis = 0; axis < 3 && !surfaceStands; ++axis) {
    markKnown(axis, phi, solids);
    layers_[axis].grow(1, 1);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto faces = layers_[axis].layer(1);
    change_[axis].resize(faces.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), kFaceGrain), [&](const auto& range) {
      RowCursor at(velocity[axis]);
      for (std::size_t n = range.begin(); n < range.end(); ++n) {
        at.seek(faces[n]);
        change_[axis][n] = continuation(axis, {at.i, at.j, at.k}, phi, solids, velocity);
      }
    });
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto faces = layers_[axis].layer(1);
    for (std::size_t n = 0; n < faces.size(); ++n) velocity[axis].data()[faces[n]] += change_[axis][n];
  }
  fillGhostLayers(velocity);
}

void constrainToSolids(const SolidBoundary& solids, MacVelocity& velocity) {
  for (int axis = 0; axis < 3; ++axis)
    forEachRow(velocity[axis].size(), [&](int i, int j) {
      constrainRow(&solids.open[axis](i, j, 0), &solids.prescribed[axis](i, j, 0),
                   &solids.velocity[axis](i, j, 0), velocity[axis].size().z(), &velocity[axis](i, j, 0));
    });
  fillGhostLayers(velocity);
}

}  // namespace spume::fluid
