#pragma once

#include "fluid/dense_field.h"
#include "fluid/multigrid.h"
#include "fluid/pocket_unknowns.h"

namespace spume::fluid {

struct SolveReport {
  int iterations = 0;
  double residual = 0;  ///< largest |b - A x| at the end, in the unit of b
  bool converged = false;
};

/// Conjugate gradients in double with the multigrid cycle as preconditioner. Keeps its vectors between
/// solves.
class ConjugateGradient {
 public:
  explicit ConjugateGradient(const Eigen::Vector3i& cells);

  /// Solves A x = b for the finest matrix of `multigrid` from x = 0 until max |b - A x| <= `tolerance`.
  /// `b` is used up: it holds the residual afterwards. `pockets` borders the matrix with unknowns of its own,
  /// held to the same tolerance.
  SolveReport solve(Multigrid& multigrid, DenseField<double>& b, DenseField<double>& x, double tolerance,
                    int maxIterations, PocketUnknowns& pockets);

 private:
  double precondition(Multigrid& multigrid, const DenseField<double>& residual, double norm,
                      const PocketUnknowns& pockets) const;
  DenseField<double> direction_, image_;
};

}  // namespace spume::fluid
