#pragma once

#include "foam/coarse_correction.h"
#include "foam/incomplete_cholesky.h"
#include "foam/solve_watch.h"
#include "foam/swept_system.h"

namespace spume::foam {

/// Conjugate gradients on a SweptSystem with its incomplete Cholesky factor as preconditioner, arranged so
/// that an iteration costs one product: with C = D + L and A = C + C^T + (diag A - 2 D) + E, where E couples
/// blocks, each product with C^-1 A C^-T is a sweep back and a sweep forth [Eisenstat 1981]. Blocks are swept
/// in parallel; sums are taken group by group, so the result does not depend on the number of threads.
/// A CoarseCorrection adds to search directions, and to A times them, what clusters do as a whole: from the
/// start on the residual pulls no cluster, and each direction keeps it so.
///
/// All in single precision, in the coordinates in which D is the unit matrix (IncompleteCholesky): an
/// iteration waits for memory. What rounding leaves is for the caller to find and to improve again.
class BlockPcg {
 public:
  struct Result {
    int iterations;
    bool reached;  ///< the goal
    bool stopped;  ///< by the watch
    double norm;   ///< |b - A e| as far as the iteration knows, if either [kg m/s]
    double drift;  ///< by about how much it may be off: rounding of D e [kg m/s]
  };
  /// Adds to `x` (rows as in the BlockSystem) a solution of A e = b, until |b - A e| <= goal [kg m/s] as far
  /// as the iteration knows, or the watch ends it, or `maxIterations`. In the first two cases b becomes
  /// b - A e, again as far as it knows.
  Result improve(const SweptSystem& a, const IncompleteCholesky& factor, const CoarseCorrection& coarse,
                 double goal, int maxIterations, SolveWatch& watch, Vectors3& b, Vectors3& x);

 private:
  /// What the iteration knows of a row, in one cache line. With G of IncompleteCholesky and the search
  /// direction p:
  struct alignas(64) State {
    Eigen::Vector4f direction;  ///< G C^T p
    Eigen::Vector4f residual;   ///< G^-T C^-1 r
    Eigen::Vector4f sum;        ///< G^-T e so far
    Eigen::Vector4f step;       ///< G^-T p
  };
  /// What a search has found: p . A p, and of the residual's change A p for a step of 1 its products with the
  /// residual and itself, in the norm of M^-1.
  struct Found {
    double curvature = 0, alongResidual = 0, square = 0;
  };
  /// What the iteration knows of the clusters of a CoarseCorrection, three numbers each. The search direction
  /// is p + Z motion, where p is what the rows' states know.
  struct Clusters {
    Eigen::VectorXd pull;          ///< Z^T r
    Eigen::VectorXd ofRows;        ///< Z^T A p
    Eigen::VectorXd left, answer;  ///< what the new part of p leaves of their pull, and motions for that
    Eigen::VectorXd motion, image, sum;  ///< of the search direction, Z^T A of it, motions so far
    std::vector<Eigen::Vector4f> known;  ///< motions as rows read them, and a 0
  };
  struct Norms {
    double plain, slope;  ///< |r|, r . M^-1 r
  };

  Result iterate(Crew& crew, const SweptSystem& a, const IncompleteCholesky& factor,
                 const CoarseCorrection& coarse, double goal, int maxIterations, SolveWatch& watch,
                 const Vectors3& b, const Vectors3& x);
  Eigen::Vector3d moveOf(std::size_t k, const Quad& sum, const SweptSystem& a,
                         const IncompleteCholesky& factor, const CoarseCorrection& coarse) const;
  bool isStopped(Crew& crew, const SweptSystem& a, const IncompleteCholesky& factor,
                 const CoarseCorrection& coarse, double length, const SolveWatch& watch,
                 const Vectors3& x) const;
  Norms start(Crew& crew, const SweptSystem& a, const IncompleteCholesky& factor,
              const CoarseCorrection& coarse, const Vectors3& b);
  double searchBack(Crew& crew, const SweptSystem& a, const IncompleteCholesky& factor, double length,
                    double momentum);
  Found searchForth(Crew& crew, const SweptSystem& a, const IncompleteCholesky& factor,
                    const CoarseCorrection& coarse);
  void startClusters(const CoarseCorrection& coarse, const Vectors3& b);
  void listMotions(const Eigen::VectorXd& motion);
  double turnClusters(Crew& crew, const CoarseCorrection& coarse, double momentum);
  void pullClusters(Crew& crew, const CoarseCorrection& coarse);
  void advanceClusters(double length);
  Quad coupledBack(const SweptSystem& a, std::size_t k) const;
  Quad coupledWithin(const SweptSystem& a, std::size_t k) const;
  Quad coupledForth(const SweptSystem& a, std::size_t k) const;
  void advance(std::size_t k, float length);
  double total(int which) const;
  Norms look(Crew& crew, const SweptSystem& a, const IncompleteCholesky& factor, double length);

  /// Where the list of known vectors holds what rows behind a row have become.
  std::size_t behind(std::size_t k) const { return state_.size() + 1 + k; }

  std::vector<State> state_;
  /// G^-T q with q = C^-1 (A - C) p. After a look, which leaves no q to go along: the residual r.
  std::vector<Eigen::Vector4f> image_;
  /// What couplings act on, by SweptSystem::other: p, a 0, and -q.
  std::vector<Eigen::Vector4f> known_;
  std::vector<GroupSums> sums_;  ///< by group
  Clusters clusters_;
};

}  // namespace spume::foam
