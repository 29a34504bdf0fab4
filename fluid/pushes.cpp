#include "fluid/pushes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace spume::fluid {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// The faces around a point, and what share of a push each takes; shares sum to 1 or are all 0.
struct Stencil {
  std::array<Vector3i, 8> face;
  std::array<double, 8> share;
};

bool isWet(const DenseField<float>& phi, const DenseField<float>& open, const Vector3i& face, int axis) {
  const Vector3i behind = face - Vector3i::Unit(axis);
  return open(face) > 0 && (phi(face) < 0 || phi(behind) < 0);
}

Stencil stencilAt(const GridSpec& grid, const DenseField<float>& phi, const DenseField<float>& open,
                  const Vector3d& position, int axis) {
  Vector3d at = grid.toCells(position) - Vector3d::Constant(0.5);
  at[axis] += 0.5;
  const Vector3d low = at.array().floor();
  const Vector3d part = at - low;
  Stencil stencil;
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3i step(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const Vector3i face = low.cast<int>() + step;
    stencil.face[corner] = face;
    const Vector3i end = grid.cells + Vector3i::Unit(axis);
    const bool inside = (face.array() >= 0).all() && (face.array() < end.array()).all();
    double share = inside && isWet(phi, open, face, axis) ? 1.0 : 0.0;
    for (int a = 0; a < 3; ++a) share *= step[a] ? part[a] : 1 - part[a];
    stencil.share[corner] = share;
    sum += share;
  }
  if (sum > 0)
    for (double& share : stencil.share) share /= sum;
  return stencil;
}

}  // namespace

void Pushes::gather(const GridSpec& grid, const DenseField<float>& phi, const DenseField<float>& open,
                    const std::vector<Push>& pushes, int axis) {
  for (auto* field : {&impulse_, &resistance_}) {
    if (field->size() != open.size()) *field = DenseField<double>(open.size());
    field->fill(0);
  }
  for (const Push& push : pushes) {
    const Stencil stencil = stencilAt(grid, phi, open, push.position, axis);
    for (int corner = 0; corner < 8; ++corner) {
      if (stencil.share[corner] == 0) continue;
      impulse_(stencil.face[corner]) += stencil.share[corner] * push.impulse[axis];
      resistance_(stencil.face[corner]) += stencil.share[corner] * push.resistance;
    }
  }
}

PushReport Pushes::apply(const GridSpec& grid, double density, const DenseField<float>& phi,
                         const MacField<float>& open, const std::vector<Push>& pushes,
                         MacVelocity& velocity) {
  PushReport report;
  if (pushes.empty()) return report;
  const double mass = density * grid.cellVolume();
  for (int axis = 0; axis < 3; ++axis) {
    gather(grid, phi, open.axis[axis], pushes, axis);
    const Vector3i n = impulse_.size();
    for (int i = 0; i < n.x(); ++i)
      for (int j = 0; j < n.y(); ++j)
        for (int k = 0; k < n.z(); ++k) {
          const double impulse = impulse_(i, j, k);
          if (impulse == 0) continue;
          const double taken = impulse * mass / std::max(mass, resistance_(i, j, k));
          velocity.axis[axis](i, j, k) += static_cast<float>(taken / mass);
          report.given[axis] += taken;
        }
  }
  for (const Push& push : pushes) report.withheld += push.impulse;
  report.withheld -= report.given;
  return report;
}

}  // namespace spume::fluid
