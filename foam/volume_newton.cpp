#include "foam/volume_newton.h"

#include <functional>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// Far above what a diagonally dominant system needs; what is left over is corrected in the next step.
constexpr int kMaxIterations = 200;

using Column = std::vector<double>;

double dot(const Column& a, const Column& b) {
  return reduceIndices(
      a.size(), 0.0, [&](std::size_t i) { return a[i] * b[i]; }, std::plus<>());
}

/// The derivatives of the volumes by the weights, row by row.
class VolumeDerivatives {
 public:
  VolumeDerivatives(const FoamTopology& topology, const Column& radius, const std::vector<char>& fixed)
      : start_(radius.size() + 1, 0), diagonal_(radius.size()) {
    const std::vector<Film>& films = topology.films;
    for (const Film& film : films) ++start_[film.i + 1], ++start_[film.j + 1];
    for (std::size_t i = 0; i < radius.size(); ++i) start_[i + 1] += start_[i];
    std::vector<std::int32_t> next(start_.begin(), start_.end() - 1);
    entry_.resize(start_.back());
    for (const Film& film : films) {
      const double coupling = film.area / (2 * film.distance);
      entry_[next[film.i]++] = {film.j, coupling}, entry_[next[film.j]++] = {film.i, coupling};
    }
    forEachIndex(radius.size(), [&](std::size_t i) {
      double sum = topology.freeArea[i] / (2 * radius[i]);
      for (std::int32_t e = start_[i]; e < start_[i + 1]; ++e) {
        sum += entry_[e].coupling;
        if (fixed[i] || fixed[entry_[e].other]) entry_[e].coupling = 0;
      }
      diagonal_[i] = fixed[i] ? 0 : sum;
    });
  }

  void apply(const Column& x, Column& out) const {
    forEachIndex(x.size(), [&](std::size_t i) {
      double sum = diagonal_[i] * x[i];
      for (std::int32_t e = start_[i]; e < start_[i + 1]; ++e) sum -= entry_[e].coupling * x[entry_[e].other];
      out[i] = sum;
    });
  }
  /// Divides by the diagonal; a row without one has nothing to say.
  double precondition(std::size_t i, double x) const { return diagonal_[i] > 0 ? x / diagonal_[i] : 0; }
  bool isEmpty(std::size_t i) const { return !(diagonal_[i] > 0); }

 private:
  struct Entry {
    std::int32_t other;
    double coupling;  ///< [m]
  };

  std::vector<std::int32_t> start_;  ///< n + 1; entries of each row
  std::vector<Entry> entry_;
  Column diagonal_;
};

}  // namespace

void solveWeightChanges(const FoamTopology& topology, const std::vector<double>& radius,
                        const std::vector<double>& wanted, const std::vector<char>& fixed, double tolerance,
                        std::vector<double>& change) {
  const std::size_t n = radius.size();
  const VolumeDerivatives matrix(topology, radius, fixed);
  Column residual(n), direction(n), step(n), scaled(n);
  change.assign(n, 0.0);
  forEachIndex(n, [&](std::size_t i) {
    residual[i] = matrix.isEmpty(i) ? 0 : wanted[i];
    direction[i] = matrix.precondition(i, residual[i]);
  });
  double size = dot(residual, residual), slope = dot(residual, direction);
  const double goal = tolerance * tolerance * size;
  for (int iteration = 0; iteration < kMaxIterations && size > goal; ++iteration) {
    matrix.apply(direction, step);
    const double length = slope / dot(direction, step);
    forEachIndex(n, [&](std::size_t i) {
      change[i] += length * direction[i], residual[i] -= length * step[i];
      scaled[i] = matrix.precondition(i, residual[i]);
    });
    const double next = dot(residual, scaled), turn = next / slope;
    forEachIndex(n, [&](std::size_t i) { direction[i] = scaled[i] + turn * direction[i]; });
    slope = next, size = dot(residual, residual);
  }
}

}  // namespace spume::foam
