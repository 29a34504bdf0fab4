#include "foam/volume_newton.h"

#include <algorithm>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// Far above what a diagonally dominant system needs; what is left over is corrected in the next step.
constexpr int kMaxIterations = 200;

using Column = std::vector<double>;

double dot(const Column& a, const Column& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// The derivatives of the volumes by the weights, film by film.
class VolumeDerivatives {
 public:
  VolumeDerivatives(const FoamTopology& topology, const Column& radius, const std::vector<char>& fixed)
      : films_(topology.films), coupling_(films_.size()), diagonal_(radius.size()) {
    for (std::size_t i = 0; i < radius.size(); ++i) diagonal_[i] = topology.freeArea[i] / (2 * radius[i]);
    for (std::size_t f = 0; f < films_.size(); ++f) {
      coupling_[f] = films_[f].area / (2 * films_[f].distance);
      diagonal_[films_[f].i] += coupling_[f], diagonal_[films_[f].j] += coupling_[f];
    }
    for (std::size_t i = 0; i < radius.size(); ++i)
      if (fixed[i]) diagonal_[i] = 0;
    for (std::size_t f = 0; f < films_.size(); ++f)
      if (fixed[films_[f].i] || fixed[films_[f].j]) coupling_[f] = 0;
  }

  void apply(const Column& x, Column& out) const {
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = diagonal_[i] * x[i];
    for (std::size_t f = 0; f < films_.size(); ++f) {
      const Film& film = films_[f];
      out[film.i] -= coupling_[f] * x[film.j], out[film.j] -= coupling_[f] * x[film.i];
    }
  }
  /// Divides by the diagonal; a row without one has nothing to say.
  void precondition(const Column& x, Column& out) const {
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = diagonal_[i] > 0 ? x[i] / diagonal_[i] : 0;
  }
  bool isEmpty(std::size_t i) const { return !(diagonal_[i] > 0); }

 private:
  const std::vector<Film>& films_;
  Column coupling_, diagonal_;
};

}  // namespace

void solveWeightChanges(const FoamTopology& topology, const std::vector<double>& radius,
                        const std::vector<double>& wanted, const std::vector<char>& fixed, double tolerance,
                        std::vector<double>& change) {
  const std::size_t n = radius.size();
  const VolumeDerivatives matrix(topology, radius, fixed);
  Column residual = wanted, direction(n), step(n), scaled(n);
  change.assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    if (matrix.isEmpty(i)) residual[i] = 0;
  const double goal = tolerance * tolerance * dot(residual, residual);
  matrix.precondition(residual, direction);
  double slope = dot(residual, direction);
  for (int iteration = 0; iteration < kMaxIterations && dot(residual, residual) > goal; ++iteration) {
    matrix.apply(direction, step);
    const double length = slope / dot(direction, step);
    for (std::size_t i = 0; i < n; ++i) change[i] += length * direction[i], residual[i] -= length * step[i];
    matrix.precondition(residual, scaled);
    const double next = dot(residual, scaled), turn = next / slope;
    for (std::size_t i = 0; i < n; ++i) direction[i] = scaled[i] + turn * direction[i];
    slope = next;
  }
}

}  // namespace spume::foam
