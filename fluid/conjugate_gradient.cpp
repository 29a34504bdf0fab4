#include "fluid/conjugate_gradient.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "fluid/pressure_rows.h"

namespace spume::fluid {
namespace {

double largest(double a, double b) { return std::max(a, b); }

double maxNorm(const std::vector<ActiveRow>& rows, const DenseField<double>& v) {
  return reduceActiveRows(
      rows,
      [&](const ActiveRow& row) { return maxMagnitude(&v(row.i, row.j, row.begin), row.end - row.begin); },
      largest);
}

/// x += step d, r -= step A d; returns max |r|.
double advance(const std::vector<ActiveRow>& rows, double step, const DenseField<double>& direction,
               const DenseField<double>& image, DenseField<double>& x, DenseField<double>& r) {
  return reduceActiveRows(
      rows,
      [&](const ActiveRow& row) {
        const double* __restrict d = &direction(row.i, row.j, 0);
        const double* __restrict ad = &image(row.i, row.j, 0);
        double* __restrict xs = &x(row.i, row.j, 0);
        double* __restrict rs = &r(row.i, row.j, 0);
        for (int k = row.begin; k < row.end; ++k) {
          xs[k] += step * d[k];
          rs[k] -= step * ad[k];
        }
        return maxMagnitude(rs + row.begin, row.end - row.begin);
      },
      largest);
}

/// d = scale z + factor d.
void turn(const std::vector<ActiveRow>& rows, double scale, const DenseField<float>& z, double factor,
          DenseField<double>& direction) {
  forEachActiveRow(rows, [&](const ActiveRow& row) {
    const float* __restrict zs = &z(row.i, row.j, 0);
    double* __restrict d = &direction(row.i, row.j, 0);
    for (int k = row.begin; k < row.end; ++k) d[k] = scale * zs[k] + factor * d[k];
  });
}

}  // namespace

ConjugateGradient::ConjugateGradient(const Eigen::Vector3i& cells) : direction_(cells), image_(cells) {}

/// multigrid.solution() = M r / norm; returns r.M r / norm. The float cycle works on the residual scaled to a
/// largest entry of 1: a pool nearly at rest would otherwise run into denormal numbers.
double ConjugateGradient::precondition(Multigrid& multigrid, const DenseField<double>& residual, double norm,
                                       const PocketUnknowns& pockets) const {
  const auto& rows = multigrid.finest().rows;
  forEachActiveRow(rows, [&](const ActiveRow& row) {
    const double* __restrict from = &residual(row.i, row.j, 0);
    float* __restrict to = &multigrid.rightHandSide()(row.i, row.j, 0);
    const double scale = 1 / norm;
    for (int k = row.begin; k < row.end; ++k) to[k] = static_cast<float>(scale * from[k]);
  });
  std::vector<float>& pocketRhs = multigrid.pocketRightHandSide();
  pocketRhs.clear();
  for (const double value : pockets.residual) pocketRhs.push_back(static_cast<float>(value / norm));
  multigrid.cycle();
  const double inCells = reduceActiveRows(
      rows,
      [&](const ActiveRow& row) {
        return dotProduct(&residual(row.i, row.j, row.begin), &multigrid.solution()(row.i, row.j, row.begin),
                          row.end - row.begin);
      },
      std::plus<>());
  return inCells + pockets.dot(multigrid.pocketSolution());
}

SolveReport ConjugateGradient::solve(Multigrid& multigrid, DenseField<double>& b, DenseField<double>& x,
                                     double tolerance, int maxIterations, PocketUnknowns& pockets) {
  const PressureMatrix& matrix = multigrid.finest();
  SolveReport report;
  multigrid.border(pockets);
  report.residual = std::max(maxNorm(matrix.rows, b), pockets.largestResidual());
  for (DenseField<double>* field : {&x, &direction_})  // their ghosts are never written
    forEachRow(field->size(), [&](int i, int j) { std::fill_n(&(*field)(i, j, 0), field->size().z(), 0.0); });
  double previous = 0;
  while (report.residual > tolerance && report.iterations < maxIterations) {
    const double norm = report.residual;
    const double product = norm * precondition(multigrid, b, norm, pockets);
    const double factor = previous != 0 ? product / previous : 0;
    turn(matrix.rows, norm, multigrid.solution(), factor, direction_);
    pockets.turn(norm, multigrid.pocketSolution(), factor);
    previous = product;
    const double within = matrix.multiply(direction_, image_);
    const double energy = within + pockets.multiply(direction_, image_);
    if (!(energy > 0)) break;
    const double step = product / energy;
    pockets.advance(step);
    report.residual =
        std::max(advance(matrix.rows, step, direction_, image_, x, b), pockets.largestResidual());
    ++report.iterations;
  }
  report.converged = report.residual <= tolerance;
  return report;
}

}  // namespace spume::fluid
