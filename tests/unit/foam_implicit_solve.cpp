// The linear solve against a system whose solution is known.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "foam/counter_random.h"
#include "foam/implicit_solve.h"
#include "foam/neighbours.h"

namespace spume::foam {
namespace {

Eigen::Vector3d drawn(CounterRandom& random) {
  return {2 * random.uniform() - 1, 2 * random.uniform() - 1, 2 * random.uniform() - 1};
}

/// A seeded system of n bodies in a chain, each linked to the next `links`, stiff against their masses.
BlockSystem randomSystem(int n, double stiffness, int links = 3) {
  std::vector<OverlapPair> pairs;
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < std::min(n, i + 1 + links); ++j) pairs.push_back({i, j, 1.0, -1});
  Neighbours neighbours;
  neighbours.build(static_cast<std::size_t>(n), pairs);
  BlockSystem a;
  a.start = neighbours.start, a.other = neighbours.other;
  a.block.resize(a.other.size());
  for (std::size_t e = 0; e < a.block.size(); ++e) {
    CounterRandom random(11, static_cast<std::uint64_t>(neighbours.pair[e]), 0);
    a.block[e] = {std::sqrt(stiffness) * drawn(random).normalized(), 0.1 * stiffness * random.uniform()};
  }
  for (int i = 0; i < n; ++i) {
    CounterRandom random(12, static_cast<std::uint64_t>(i), 0);
    const Eigen::Vector3d u = drawn(random);
    a.own.push_back(Eigen::Matrix3d::Identity() * (0.5 + random.uniform()) + u * u.transpose());
  }
  return a;
}

Eigen::MatrixXd dense(const BlockSystem& a) {
  const auto n = static_cast<Eigen::Index>(a.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    matrix.block<3, 3>(3 * i, 3 * i) = a.diagonal(static_cast<std::size_t>(i));
    for (auto e = a.start[i]; e < a.start[i + 1]; ++e)
      matrix.block<3, 3>(3 * i, 3 * a.other[e]) = -(a.block[e].along() * a.block[e].along().transpose() +
                                                    a.block[e].across() * Eigen::Matrix3d::Identity());
  }
  return matrix;
}

Vectors3 randomVectors(std::size_t n) {
  Vectors3 b;
  for (std::size_t i = 0; i < n; ++i) {
    CounterRandom random(13, i, 0);
    b.push_back(drawn(random));
  }
  return b;
}

Vectors3 product(const BlockSystem& a, const Vectors3& x) {
  Vectors3 b(a.size());
  for (std::size_t i = 0; i < b.size(); ++i) b[i] = a.row(i, x);
  return b;
}

constexpr LinearSolver kSolvers[] = {LinearSolver::pcgJacobi, LinearSolver::pcgIncompleteCholesky,
                                     LinearSolver::cholmod};

TEST(ImplicitSolve, EverySolverFindsTheVectorADenseMatrixWasAppliedTo) {
  const BlockSystem a = randomSystem(60, 1e4);
  const Vectors3 exact = randomVectors(60);
  const Eigen::MatrixXd matrix = dense(a);
  Vectors3 b(60, Eigen::Vector3d::Zero());
  for (Eigen::Index i = 0; i < 180; ++i)
    for (Eigen::Index j = 0; j < 180; ++j) b[i / 3][i % 3] += matrix(i, j) * exact[j / 3][j % 3];
  for (const LinearSolver kind : kSolvers) {
    Vectors3 x(60, Eigen::Vector3d::Zero());
    ImplicitSolve solver(kind);
    const SolveReport report = solver.solve(a, b, 1e-12 * solver.begin(a, b, x), 2000, x);
    EXPECT_TRUE(report.converged && !report.fellBack);
    // Error <= residual x conditioning: 1e-12 x (about 1e5 / 0.5).
    for (std::size_t i = 0; i < 60; ++i) EXPECT_LE((x[i] - exact[i]).norm(), 1e-6);
  }
}

/// Without triangles the incomplete factor is the complete one.
TEST(ImplicitSolve, IncompleteCholeskyIsExactOnAChain) {
  constexpr double kSinglePrecision = 1e-6;  // of the couplings, with room for 1e3 links
  BlockSystem a = randomSystem(1000, 1e4, 1);
  const Vectors3 exact = randomVectors(a.size()), b = product(a, exact);
  Vectors3 x(a.size(), Eigen::Vector3d::Zero());
  ImplicitSolve solver(LinearSolver::pcgIncompleteCholesky);
  const SolveReport report = solver.solve(a, b, kSinglePrecision * solver.begin(a, b, x), 100, x);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, 2);
}

/// Own blocks that change between solves, as contacts of walls do: the kept factor follows them.
TEST(ImplicitSolve, SolvingAgainFollowsOwnBlocksThatChanged) {
  for (const LinearSolver kind : kSolvers) {
    BlockSystem a = randomSystem(300, 1e4);
    const Vectors3 exact = randomVectors(a.size());
    Vectors3 x(a.size(), Eigen::Vector3d::Zero());
    ImplicitSolve solver(kind);
    Vectors3 b = product(a, exact);
    const double first = solver.begin(a, b, x);
    solver.solve(a, b, 1e-2, 2000, x);
    std::vector<std::int32_t> changed;
    for (std::int32_t i = 0; i < 300; i += 3) changed.push_back(i);
    for (const double stiffness : {1e5, -1e5}) {  // closes and opens again
      for (const std::int32_t i : changed) a.own[i](1, 1) += stiffness, x[i].y() += 1;
      b = product(a, exact);
      const double followed = solver.follow(a, b, x, changed);
      EXPECT_NEAR(followed, ImplicitSolve(kind).begin(a, b, x), 1e-9 * followed);
      const SolveReport report = solver.solve(a, b, 1e-12 * first, 2000, x);
      EXPECT_TRUE(report.converged && !report.fellBack);
      for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LE((x[i] - exact[i]).norm(), 1e-6);
    }
  }
}

/// A foam of which bubbles burst: from clusters to none, from several blocks to one, from two bubbles to one.
TEST(ImplicitSolve, SolvesSystemsThatShrinkAndGrow) {
  ImplicitSolve solve(LinearSolver::pcgIncompleteCholesky);
  for (const int n : {7000, 6143, 6144, 40000, 1100, 1000, 2, 1, 7000}) {
    const BlockSystem a = randomSystem(n, 100);
    const Vectors3 exact = randomVectors(static_cast<std::size_t>(n)), b = product(a, exact);
    Vectors3 x(exact.size(), Eigen::Vector3d::Zero());
    const double first = solve.begin(a, b, x);
    EXPECT_TRUE(solve.solve(a, b, 1e-9 * first, 1000, x).converged) << n;
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) worst = std::max(worst, (x[i] - exact[i]).norm());
    EXPECT_LE(worst, 1e-6) << n;
  }
}

TEST(ImplicitSolve, BeginsWithWhatIsLeftWhereFewOfXAreNotZero) {
  const BlockSystem a = randomSystem(3000, 1e4);
  const Vectors3 b = randomVectors(a.size());
  Vectors3 x(a.size(), Eigen::Vector3d::Zero());
  ImplicitSolve whole, few;
  EXPECT_DOUBLE_EQ(few.begin(a, b, x, {}), whole.begin(a, b, x));
  EXPECT_EQ(few.left(), whole.left());
  x[7] = {1, 2, 3}, x[8] = {0, 1, 0}, x[2999] = {-1, 0, 5};
  EXPECT_DOUBLE_EQ(few.begin(a, b, x, {8, 7, 2999}), whole.begin(a, b, x));
  EXPECT_EQ(few.left(), whole.left());
}

/// Bodies lighter and lighter beside what links them, down to what single precision would lose in plain
/// coordinates: one of a pair on its own hangs by one link and is free to move across it.
TEST(ImplicitSolve, FindsWhatLightBodiesDoAcrossStiffLinks) {
  constexpr double kAgreement = 1e-2, kLeastOwn = 0.5;  // no own block is softer than that times the mass
  for (const double mass : {1.0, 1e-4, 1e-8}) {
    BlockSystem a = randomSystem(3000, 1.0);
    for (std::size_t e = 0; e < a.block.size(); ++e) a.block[e].number[3] = 0;
    for (std::size_t i = 0; i < a.size(); i += 2) a.own[i] *= mass;
    const Vectors3 exact = randomVectors(a.size()), b = product(a, exact);
    for (const LinearSolver kind : {LinearSolver::pcgJacobi, LinearSolver::pcgIncompleteCholesky}) {
      Vectors3 x(a.size(), Eigen::Vector3d::Zero());
      ImplicitSolve solver(kind);
      solver.begin(a, b, x);
      const SolveReport report = solver.solve(a, b, kAgreement * kLeastOwn * mass, 20000, x);
      EXPECT_TRUE(report.converged && !report.fellBack) << mass;
      for (std::size_t i = 0; i < x.size(); ++i)
        EXPECT_LE((x[i] - exact[i]).norm(), kAgreement) << mass << ' ' << i;
    }
  }
}

TEST(ImplicitSolve, ThreadsDoNotChangeABit) {
  const BlockSystem a = randomSystem(7000, 1e4);  // several blocks of rows, some clusters
  const Vectors3 b = randomVectors(a.size());
  for (const LinearSolver kind : kSolvers) {
    const auto withThreads = [&](std::size_t threads) {
      tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      Vectors3 x(a.size(), Eigen::Vector3d::Zero());
      ImplicitSolve solver(kind);
      solver.solve(a, b, 1e-6 * solver.begin(a, b, x), 2000, x);
      return x;
    };
    const Vectors3 alone = withThreads(1);
    for (std::size_t threads : {2, 4}) EXPECT_EQ(alone, withThreads(threads));
  }
}

TEST(ImplicitSolve, BalancesTheResidualsByARigidShift) {
  const BlockSystem a = randomSystem(40, 1e3);
  const Vectors3 b = randomVectors(40);
  Vectors3 x(40, Eigen::Vector3d::Zero());
  ImplicitSolve solver;
  solver.solve(a, b, 1e-2 * solver.begin(a, b, x), 100, x);  // stopped early on purpose
  solver.balance(a, x);
  Eigen::Vector3d left = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < b.size(); ++i) left += b[i] - a.row(i, x);
  EXPECT_LE(left.norm(), 1e-12);  // round-off of sums of order 1e3
}

TEST(ImplicitSolve, KnowsWhatIsLeftToWithinWhatItsWatchAllowsAndEndsWithATrueResidual) {
  const std::size_t n = 300;
  const BlockSystem a = randomSystem(static_cast<int>(n), 1e3);
  const Vectors3 b = randomVectors(n);
  Vectors3 x(n, Eigen::Vector3d::Zero());
  ImplicitSolve solver(LinearSolver::pcgIncompleteCholesky);
  const double first = solver.begin(a, b, x), allowed = 1e-4 * first;
  const auto distance = [&](const Vectors3& left) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += (left[i] - (b[i] - a.row(i, x))).squaredNorm();
    return std::sqrt(sum);
  };
  const double goal = 1e-9 * first;
  SolveWatch watch = {1e-2 * first, 0.1, allowed, {0}, [](std::int32_t, const auto&) { return true; }};
  EXPECT_TRUE(solver.solve(a, b, goal, 100, x, watch).stopped);
  EXPECT_GT(distance(solver.left()), 0);  // what the iteration knows
  EXPECT_LE(distance(solver.left()), allowed);
  watch.allowed *= 1e-2;
  EXPECT_TRUE(solver.solve(a, b, goal, 100, x, watch).stopped);
  EXPECT_EQ(distance(solver.left()), 0);  // rounding alone is more than that
  EXPECT_TRUE(solver.solve(a, b, goal, 1000, x).converged);
  EXPECT_LE(distance(Vectors3(n, Eigen::Vector3d::Zero())), goal);
  EXPECT_EQ(distance(solver.left()), 0);
}

TEST(ImplicitSolve, AWatchSeesWhatXWouldBeAndEndsTheSolveThere) {
  constexpr double kSinglePrecision = 1e-5;
  const std::size_t n = 7000;  // some clusters
  const BlockSystem a = randomSystem(static_cast<int>(n), 1e2);
  const Vectors3 b = randomVectors(n);
  for (const LinearSolver kind : {LinearSolver::pcgJacobi, LinearSolver::pcgIncompleteCholesky}) {
    Vectors3 x(n, Eigen::Vector3d::Ones()), seen;
    ImplicitSolve solver(kind);
    const double first = solver.begin(a, b, x);
    SolveWatch watch = {1e-1 * first, 0.1, 1e-2 * first, {4000}, nullptr};
    watch.stops = [&](std::int32_t row, const Eigen::Vector3d& sought) {
      EXPECT_EQ(row, 4000);
      seen.push_back(sought);
      return seen.size() == 3;
    };
    const SolveReport stopped = solver.solve(a, b, 1e-9 * first, 1000, x, watch);
    EXPECT_TRUE(stopped.stopped && !stopped.converged && !stopped.fellBack);
    EXPECT_NEAR(watch.mark, 1e-4 * first, 1e-12 * first);
    EXPECT_LE(stopped.residual, 3e-3);  // marks are met by a guess of the norm
    EXPECT_GT(stopped.residual, 1e-5);
    ASSERT_EQ(seen.size(), 3u);
    EXPECT_LE((seen[2] - x[4000]).norm(), kSinglePrecision * x[4000].norm());
    EXPECT_GT((seen[1] - x[4000]).norm(), kSinglePrecision * x[4000].norm());
    watch.stops = [](std::int32_t, const auto&) { return false; };
    const SolveReport whole = solver.solve(a, b, 1e-9 * first, 1000, x, watch);
    EXPECT_TRUE(whole.converged && !whole.stopped);
  }
}

TEST(ImplicitSolve, TheDirectSolverFinishesWhatStalls) {
  constexpr double kGoal = 1e-7;  // round-off of stiffness x solution, 1e6 x 1 x 1e-16, over 400 links
  const BlockSystem a = randomSystem(60, 1e6);
  const Vectors3 b = randomVectors(60);
  Vectors3 x(60, Eigen::Vector3d::Zero());
  ImplicitSolve solver(LinearSolver::pcgJacobi);
  solver.begin(a, b, x);
  const SolveReport report = solver.solve(a, b, kGoal, 3, x);
  EXPECT_TRUE(report.converged && report.fellBack);
  EXPECT_LE(solver.begin(a, b, x), kGoal);
}

TEST(ImplicitSolve, SaysSoWhenItDoesNotConverge) {
  BlockSystem a = randomSystem(60, 1e2);
  for (auto& own : a.own) own.setZero();  // nothing holds it: singular, no solution for most impulses
  for (const LinearSolver kind : kSolvers) {
    const Vectors3 b = randomVectors(60);
    Vectors3 x(60, Eigen::Vector3d::Zero());
    ImplicitSolve solver(kind);
    solver.begin(a, b, x);
    EXPECT_FALSE(solver.solve(a, b, 1e-12, 3, x).converged);
  }
}

TEST(Neighbours, ListEveryPairFromBothSidesInOrder) {
  Neighbours neighbours;
  neighbours.build(4, {{0, 2, 1, -1}, {0, 3, 1, -1}, {1, 2, 1, -1}, {2, 3, 1, -1}});
  EXPECT_EQ(neighbours.start, (std::vector<std::int32_t>{0, 2, 3, 6, 8}));
  EXPECT_EQ(neighbours.other, (std::vector<std::int32_t>{2, 3, 2, 0, 1, 3, 0, 2}));
  EXPECT_EQ(neighbours.pair, (std::vector<std::int32_t>{0, 1, 2, 0, 2, 3, 1, 3}));
}

}  // namespace
}  // namespace spume::foam
