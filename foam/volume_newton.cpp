#include "foam/volume_newton.h"

#include <functional>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// Far above what a diagonally dominant system needs; what is left over is corrected in the next step.
constexpr int kMaxIterations = 200;

using Column = std::vector<double>;

/// Products of the residual, with itself preconditioned and with itself.
struct Products {
  double slope = 0, size = 0;
  Products operator+(const Products& other) const { return {slope + other.slope, size + other.size}; }
};

/// Sums value(i), which may write row i along: one pass over memory, and threads that meet once.
template <typename Value, typename Item>
Value sumRows(std::size_t n, const Item& value) {
  return reduceIndices(n, Value(), value, std::plus<>());
}

/// -dV_i/dw_j of the two cells of a pair [m].
float couplingOf(const FoamTopology& topology, std::int32_t pair) {
  const std::int32_t f = topology.overlaps[pair].film;
  if (f < 0) return 0;
  const Film& film = topology.films[f];
  return static_cast<float>(film.area / (2 * film.distance));
}

/// The derivatives of the volumes by the weights, row by row: what a row reads of another stands beside its
/// neighbours, in single precision, which is far finer than the linearisation and half the memory.
class VolumeDerivatives {
 public:
  VolumeDerivatives(const FoamTopology& topology, const Neighbours& neighbours, const Column& radius,
                    const std::vector<char>& fixed)
      : neighbours_(neighbours), coupling_(neighbours.other.size()), diagonal_(radius.size()) {
    forEachIndex(radius.size(), [&](std::size_t i) {
      if (fixed[i]) return;
      double sum = topology.freeArea[i] / (2 * radius[i]);
      for (std::int32_t e = neighbours.start[i]; e < neighbours.start[i + 1]; ++e) {
        const float coupling = couplingOf(topology, neighbours.pair[e]);
        sum += coupling;
        coupling_[e] = fixed[neighbours.other[e]] ? 0 : coupling;
      }
      diagonal_[i] = sum;
    });
  }

  /// Row i times x.
  double product(std::size_t i, const Column& x) const {
    if (isEmpty(i)) return 0;
    double sum = diagonal_[i] * x[i];
    for (std::int32_t e = neighbours_.start[i]; e < neighbours_.start[i + 1]; ++e)
      sum -= coupling_[e] * x[neighbours_.other[e]];
    return sum;
  }
  /// Divides by the diagonal; a row without one has nothing to say.
  double precondition(std::size_t i, double x) const { return diagonal_[i] > 0 ? x / diagonal_[i] : 0; }
  bool isEmpty(std::size_t i) const { return !(diagonal_[i] > 0); }

 private:
  const Neighbours& neighbours_;
  std::vector<float> coupling_;  ///< with each neighbour [m]
  Column diagonal_;
};

}  // namespace

void solveWeightChanges(const FoamTopology& topology, const Neighbours& neighbours,
                        const std::vector<double>& radius, const std::vector<double>& wanted,
                        const std::vector<char>& fixed, double tolerance, std::vector<double>& change) {
  const std::size_t n = radius.size();
  const VolumeDerivatives matrix(topology, neighbours, radius, fixed);
  Column residual(n), direction(n), step(n), scaled(n);
  change.assign(n, 0.0);
  auto left = sumRows<Products>(n, [&](std::size_t i) -> Products {
    residual[i] = matrix.isEmpty(i) ? 0 : wanted[i];
    direction[i] = matrix.precondition(i, residual[i]);
    return {residual[i] * direction[i], residual[i] * residual[i]};
  });
  const double goal = tolerance * tolerance * left.size;
  for (int iteration = 0; iteration < kMaxIterations && left.size > goal; ++iteration) {
    const double curvature = sumRows<double>(n, [&](std::size_t i) {
      step[i] = matrix.product(i, direction);
      return direction[i] * step[i];
    });
    const double length = left.slope / curvature;
    const auto next = sumRows<Products>(n, [&](std::size_t i) -> Products {
      change[i] += length * direction[i], residual[i] -= length * step[i];
      scaled[i] = matrix.precondition(i, residual[i]);
      return {residual[i] * scaled[i], residual[i] * residual[i]};
    });
    const double turn = next.slope / left.slope;
    forEachIndex(n, [&](std::size_t i) { direction[i] = scaled[i] + turn * direction[i]; });
    left = next;
  }
}

double volumeLost(const FoamTopology& topology, const Neighbours& neighbours,
                  const std::vector<double>& change, std::size_t i) {
  double sum = 0;
  for (std::int32_t e = neighbours.start[i]; e < neighbours.start[i + 1]; ++e)
    if (const double of = change[neighbours.other[e]]; of != 0)
      sum += couplingOf(topology, neighbours.pair[e]) * of;
  return sum;
}

}  // namespace spume::foam
