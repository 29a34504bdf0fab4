#include "fluid/wall_slip.h"

#include <tbb/parallel_for.h>

#include <optional>

#include "fluid/level_set.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// How far in front of the wall the velocity is taken [cells]: all faces around lie in the liquid there.
constexpr float kInFront = 1;
/// Slope of the distance below which it has no direction: in the middle of a wall.
constexpr float kLeastSlope = 0.1f;

/// Signed distance to the nearest solid and its gradient [cells].
struct Distance {
  float value = 0;
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
};

/// In the middle of a face, from the corners of the cells on both sides of it: the centres of cells lie too
/// far apart for a wall of two cells, whose other side they would see.
Distance distanceAt(const DenseField<float>& nodePsi, float dx, int axis, const Eigen::Vector3i& face) {
  const Eigen::Vector3i along = Eigen::Vector3i::Unit(axis);
  const Eigen::Vector3i last = nodePsi.size() - Eigen::Vector3i::Ones();
  const int p = (axis + 1) % 3, q = (axis + 2) % 3;
  Distance psi;
  for (int corner = 0; corner < 4; ++corner) {
    const int atP = corner & 1, atQ = corner >> 1;
    const Eigen::Vector3i node = face + atP * Eigen::Vector3i::Unit(p) + atQ * Eigen::Vector3i::Unit(q);
    const float here = nodePsi(node);
    psi.value += here / 4;
    psi.gradient[p] += (atP ? here : -here) / 2;
    psi.gradient[q] += (atQ ? here : -here) / 2;
    const Eigen::Vector3i ahead = (node + along).cwiseMin(last), behind = (node - along).cwiseMax(0);
    psi.gradient[axis] += (nodePsi(ahead) - nodePsi(behind)) / 8;
  }
  psi.value /= dx, psi.gradient /= dx;
  return psi;
}

/// Where a face looks that is cut and has its middle inside a solid [cells]; nowhere for others.
std::optional<Eigen::Vector3f> pointInFront(const SolidBoundary& solids, const GridSpec& grid, int axis,
                                            const Eigen::Vector3i& face) {
  const float open = solids.open[axis](face);
  if (open <= 0 || open >= 1 || solids.prescribed[axis](face)) return std::nullopt;
  const Distance psi = distanceAt(solids.nodePsi, static_cast<float>(grid.dx), axis, face);
  if (psi.value > 0 || psi.gradient.norm() < kLeastSlope) return std::nullopt;
  Eigen::Vector3f middle = face.cast<float>() + Eigen::Vector3f::Constant(0.5f);
  middle[axis] -= 0.5f;
  const Eigen::Vector3f inside = middle + (kInFront - psi.value) * psi.gradient.normalized();
  const Eigen::Array3f top = grid.cells.cast<float>().array() - 0.5f;
  if ((inside.array() < 0.5f).any() || (inside.array() > top).any()) return std::nullopt;
  return inside;
}

}  // namespace

void WallSlip::rebuild(const SolidBoundary& solids) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3i& size = solids.open[axis].size();
    std::vector<std::vector<CutFace>> slabs(size.x());
    tbb::parallel_for(0, size.x(), [&](int i) {
      for (int j = 0; j < size.y(); ++j)
        for (int k = 0; k < size.z(); ++k)
          if (const auto inside = pointInFront(solids, grid_, axis, {i, j, k}))
            slabs[i].push_back({static_cast<std::int32_t>(solids.open[axis].index(i, j, k)), *inside});
    });
    faces_[axis].clear();
    for (const auto& slab : slabs) faces_[axis].insert(faces_[axis].end(), slab.begin(), slab.end());
  }
}

void WallSlip::apply(MacVelocity& velocity) {
  const MacView seen(velocity);
  for (int axis = 0; axis < 3; ++axis) {
    values_[axis].resize(faces_[axis].size());
    tbb::parallel_for(std::size_t{0}, faces_[axis].size(), [&](std::size_t n) {
      const Eigen::Vector3f& x = faces_[axis][n].inside;
      const Velocity3f u = sampleInnerVelocity(seen, x.x(), x.y(), x.z());
      values_[axis][n] = axis == 0 ? u.x : axis == 1 ? u.y : u.z;
    });
  }
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t n = 0; n < faces_[axis].size(); ++n)
      velocity[axis].data()[faces_[axis][n].offset] = values_[axis][n];
}

}  // namespace spume::fluid
