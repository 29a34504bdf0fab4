#include "fluid/viscosity.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "fluid/errors.h"
#include "fluid/level_set.h"
#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

// Largest residual over its diagonal, relative to the largest speed: below the rounding of float velocities.
constexpr double kTolerance = 1e-8;
// A cell with less liquid than this counts as air: faces of next to no mass spoil the matrix.
constexpr float kLeastFraction = 0.05f;
// A cavity of 1000 cells across would take as many iterations at infinite viscosity.
constexpr int kMostIterations = 2000;
// A domain wall lies half a cell from the faces beside it: its shear is twice that over a whole cell.
constexpr float kWallShear = 2;

Eigen::Vector3i unit(int axis) { return Eigen::Vector3i::Unit(axis); }

/// The axis that is neither a nor b.
int third(int a, int b) { return 3 - a - b; }

/// Sum over all faces of body(axis, i, j), each a row along z; does not depend on the number of threads.
template <typename Body, typename Join>
double reduceRows(const Eigen::Vector3i& cells, const Body& body, const Join& join) {
  double total = 0;
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3i size = cells + unit(a);
    total = join(total, reduceSlabs(
                            size.x(), 0.0,
                            [&](int i) {
                              double sum = 0;
                              for (int j = 0; j < size.y(); ++j) sum = join(sum, body(a, i, j, size.z()));
                              return sum;
                            },
                            join));
  }
  return total;
}

double plus(double a, double b) { return a + b; }
double largest(double a, double b) { return std::max(a, b); }

double dot(const Eigen::Vector3i& cells, const MacField<double>& x, const MacField<double>& y) {
  return reduceRows(
      cells,
      [&](int a, int i, int j, int count) {
        const double *p = &x[a](i, j, 0), *q = &y[a](i, j, 0);
        double sum = 0;
        for (int k = 0; k < count; ++k) sum += p[k] * q[k];
        return sum;
      },
      plus);
}

}  // namespace

Viscosity::Viscosity(const GridSpec& grid, const FluidParams& params)
    : grid_(grid), kinematic_(params.viscosity / params.density), noSlip_(params.noSlip) {
  if (kinematic_ == 0) return;
  fraction_ = DenseField<float>(grid.cells);
  mass_ = inverse_ = MacField<float>(grid.cells);
  for (int a = 0; a < 3; ++a) shear_[a] = DenseField<float>(grid.cells + Eigen::Vector3i::Ones() - unit(a));
  for (Vector* v : {&start_, &change_, &residual_, &direction_, &image_}) *v = Vector(grid.cells);
}

/// Whether a face's velocity is that of a solid or an inflow.
bool Viscosity::isHeld(const SolidBoundary& boundary, int axis, const Eigen::Vector3i& face) const {
  return boundary.prescribed[axis](face) != 0 || !(boundary.open[axis](face) > 0);
}

/// Whether a face inside the grid carries no liquid and is not held.
bool Viscosity::isDry(int axis, const Eigen::Vector3i& face) const {
  return mass_[axis].contains(face.x(), face.y(), face.z()) && mass_[axis](face) == 0;
}

/// W of the edge along the third axis at the low corner of cell c across a and b.
float Viscosity::edgeWeight(const SolidBoundary& boundary, int a, int b, const Eigen::Vector3i& c) const {
  float scale = 1;
  for (const int n : {a, b}) {
    if (c[n] > 0 && c[n] < grid_.cells[n]) continue;
    if (!boundary.walls.closed[2 * n + (c[n] > 0)] || !noSlip_) return 0;  // free of traction
    scale *= kWallShear;
  }
  const Eigen::Vector3i la = c - unit(a), lb = c - unit(b);
  if (scale == 1 && !noSlip_ &&
      (isHeld(boundary, a, c) || isHeld(boundary, a, lb) || isHeld(boundary, b, c) ||
       isHeld(boundary, b, la)))
    return 0;
  if (isDry(a, c) || isDry(a, lb) || isDry(b, c) || isDry(b, la)) return 0;
  return scale * 0.25f * (fraction_(c) + fraction_(la) + fraction_(lb) + fraction_(la - unit(b)));
}

void Viscosity::weigh(const DenseField<float>& phi, const SolidBoundary& boundary) {
  const float dx = static_cast<float>(grid_.dx);
  const Eigen::Vector3i top = grid_.cells - Eigen::Vector3i::Ones();
  forEachCell(grid_.cells + Eigen::Vector3i::Constant(2), [&](int i, int j, int k) {
    const Eigen::Vector3i c(i - 1, j - 1, k - 1), from = c.cwiseMax(0).cwiseMin(top);
    const float liquid = liquidFractionOfCell(phi, dx, from.x(), from.y(), from.z());
    fraction_(c) = liquid < kLeastFraction ? 0 : liquid;
  });
  for (int a = 0; a < 3; ++a)
    forEachCell(mass_[a].size(), [&](int i, int j, int k) {
      const Eigen::Vector3i c(i, j, k);
      const float both = 0.5f * (fraction_(c) + fraction_(c - unit(a)));
      mass_[a](c) = isHeld(boundary, a, c) ? -1 : both;  // -1 until invertDiagonal
    });
  for (int along = 0; along < 3; ++along) {
    const int a = (along + 1) % 3, b = (along + 2) % 3;
    forEachCell(shear_[along].size(), [&](int i, int j, int k) {
      shear_[along](i, j, k) = edgeWeight(boundary, std::min(a, b), std::max(a, b), {i, j, k});
    });
  }
}

/// 1/diagonal of the faces to solve for: those neither held nor without any liquid around.
void Viscosity::invertDiagonal(double k) {
  for (int a = 0; a < 3; ++a)
    forEachCell(mass_[a].size(), [&](int i, int j, int l) {
      const Eigen::Vector3i c(i, j, l);
      float& mass = mass_[a](c);
      double diagonal =
          mass + 2 * k * (fraction_(c) * (c[a] < grid_.cells[a]) + fraction_(c - unit(a)) * (c[a] > 0));
      for (int b = 0; b < 3; ++b)
        if (b != a) {
          const DenseField<float>& edge = shear_[third(a, b)];
          diagonal += k * (edge(c) + edge(c + unit(b)));
        }
      inverse_[a](c) = mass >= 0 && diagonal > 0 ? static_cast<float>(1 / diagonal) : 0;
      mass = std::max(mass, 0.0f);
    });
}

/// y = A x on one row of faces across `axis`, 0 where nothing is solved for.
void Viscosity::multiplyRow(const Vector& x, double k, int axis, int i, int j, double* y) const {
  const int count = mass_[axis].size().z();
  const DenseField<double>& u = x[axis];
  const auto back = u.stride(axis);
  const double* here = &u(i, j, 0);
  const float* mass = &mass_[axis](i, j, 0);
  const float* upper = &fraction_(i, j, 0);
  const float* lower = upper - fraction_.stride(axis);
  const int n = axis == 0 ? i : j;
  for (int l = 0; l < count; ++l) {
    const int at = axis == 2 ? l : n;
    const double above = at < grid_.cells[axis] ? upper[l] * (here[l + back] - here[l]) : 0;
    const double below = at > 0 ? lower[l] * (here[l] - here[l - back]) : 0;
    y[l] = mass[l] * here[l] + 2 * k * (below - above);
  }
  for (int b = 0; b < 3; ++b) {
    if (b == axis) continue;
    const DenseField<double>& v = x[b];
    const DenseField<float>& edge = shear_[third(axis, b)];
    const auto ub = u.stride(b), va = v.stride(axis), vb = v.stride(b), eb = edge.stride(b);
    const double* w = &v(i, j, 0);
    const float* weight = &edge(i, j, 0);
    for (int l = 0; l < count; ++l) {
      const double low = here[l] - here[l - ub] + w[l] - w[l - va];
      const double high = here[l + ub] - here[l] + w[l + vb] - w[l + vb - va];
      y[l] += k * (weight[l] * low - weight[l + eb] * high);
    }
  }
  const float* inverse = &inverse_[axis](i, j, 0);
  for (int l = 0; l < count; ++l) y[l] = inverse[l] > 0 ? y[l] : 0;
}

void Viscosity::multiply(const Vector& x, double k, Vector& y) const {
  for (int a = 0; a < 3; ++a)
    forEachRow(mass_[a].size(), [&](int i, int j) { multiplyRow(x, k, a, i, j, &y[a](i, j, 0)); });
}

/// Conjugate gradients with the diagonal as preconditioner, from change_ = 0 and residual_ = b, to kTolerance
/// of the fastest speed, or of the first error: liquid at rest may border on a nozzle that pours. Whether it
/// got there.
bool Viscosity::solve(double fastest, double k) {
  const Eigen::Vector3i& cells = grid_.cells;
  for (int a = 0; a < 3; ++a) change_[a].fill(0), direction_[a].fill(0), image_[a].fill(0);
  double previous = 0, tolerance = 0;
  for (iterations_ = 0;; ++iterations_) {
    error_ = reduceRows(
        cells,
        [&](int a, int i, int j, int count) {
          const double* r = &residual_[a](i, j, 0);
          const float* inverse = &inverse_[a](i, j, 0);
          double most = 0;
          for (int l = 0; l < count; ++l) most = std::max(most, std::abs(r[l] * inverse[l]));
          return most;
        },
        largest);
    if (iterations_ == 0) tolerance = kTolerance * std::max(fastest, error_);
    if (!(error_ > tolerance) || iterations_ == kMostIterations) return error_ <= tolerance;
    const double product = reduceRows(
        cells,
        [&](int a, int i, int j, int count) {
          const double* r = &residual_[a](i, j, 0);
          const float* inverse = &inverse_[a](i, j, 0);
          double sum = 0;
          for (int l = 0; l < count; ++l) sum += r[l] * r[l] * inverse[l];
          return sum;
        },
        plus);
    const double factor = previous > 0 ? product / previous : 0;
    previous = product;
    for (int a = 0; a < 3; ++a)
      forEachCell(mass_[a].size(), [&](int i, int j, int l) {
        direction_[a](i, j, l) =
            residual_[a](i, j, l) * inverse_[a](i, j, l) + factor * direction_[a](i, j, l);
      });
    multiply(direction_, k, image_);
    const double step = product / dot(cells, direction_, image_);
    for (int a = 0; a < 3; ++a)
      forEachCell(mass_[a].size(), [&](int i, int j, int l) {
        change_[a](i, j, l) += step * direction_[a](i, j, l);
        residual_[a](i, j, l) -= step * image_[a](i, j, l);
      });
  }
}

void Viscosity::apply(const DenseField<float>& phi, const SolidBoundary& boundary, double dt,
                      MacVelocity& velocity) {
  if (kinematic_ == 0 || !(dt > 0)) return;
  const double k = dt * kinematic_ / (grid_.dx * grid_.dx);
  weigh(phi, boundary);
  invertDiagonal(k);
  double fastest = 0;
  for (int a = 0; a < 3; ++a) {
    start_[a].fill(0);  // beyond the walls: they are at rest
    forEachCell(mass_[a].size(), [&](int i, int j, int l) { start_[a](i, j, l) = velocity[a](i, j, l); });
  }
  fastest = reduceRows(
      grid_.cells,
      [&](int a, int i, int j, int count) {
        const double* u = &start_[a](i, j, 0);
        const float* inverse = &inverse_[a](i, j, 0);
        double most = 0;
        for (int l = 0; l < count; ++l) most = std::max(most, inverse[l] > 0 ? std::abs(u[l]) : 0);
        return most;
      },
      largest);
  // A (u* + change) = m u*, so A change = m u* - A u*.
  multiply(start_, k, residual_);
  for (int a = 0; a < 3; ++a)
    forEachCell(mass_[a].size(), [&](int i, int j, int l) {
      if (!(inverse_[a](i, j, l) > 0)) return;
      residual_[a](i, j, l) = mass_[a](i, j, l) * start_[a](i, j, l) - residual_[a](i, j, l);
    });
  if (!solve(fastest, k)) {
    std::ostringstream message;
    message << "viscosity: " << iterations_ << " iterations left an error of " << error_ << " m/s at dt "
            << dt << " s";
    throw NumericalFailure(message.str());
  }
  for (int a = 0; a < 3; ++a)
    forEachCell(mass_[a].size(), [&](int i, int j, int l) {
      if (inverse_[a](i, j, l) > 0)
        velocity[a](i, j, l) = static_cast<float>(start_[a](i, j, l) + change_[a](i, j, l));
    });
}

}  // namespace spume::fluid
