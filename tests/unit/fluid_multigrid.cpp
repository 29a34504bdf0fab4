#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <random>

#include "fluid/conjugate_gradient.h"
#include "fluid/multigrid.h"

namespace spume::fluid {
namespace {

/// A box with random couplings, holes and pressure known on one side.
void fillRandom(PressureMatrix& matrix, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  const Eigen::Vector3i n = matrix.cells();
  for (int i = 0; i < n.x(); ++i)
    for (int j = 0; j < n.y(); ++j)
      for (int k = 0; k < n.z(); ++k) {
        const Eigen::Vector3i c(i, j, k);
        for (int a = 0; a < 3; ++a)
          matrix.weight[a](c) = c[a] > 0 && uniform(random) > 0.1f ? 0.05f + 0.95f * uniform(random) : 0;
        matrix.excess(c) = j + 1 == n.y() ? 1 / (0.01f + uniform(random)) : 0;
      }
  matrix.finish();
}

DenseField<float> randomField(const Eigen::Vector3i& n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  DenseField<float> field(n);
  for (int i = 0; i < n.x(); ++i)
    for (int j = 0; j < n.y(); ++j)
      for (int k = 0; k < n.z(); ++k) field(i, j, k) = normal(random);
  return field;
}

double dot(const DenseField<float>& a, const DenseField<float>& b) {
  double sum = 0;
  for (int i = 0; i < a.size().x(); ++i)
    for (int j = 0; j < a.size().y(); ++j)
      for (int k = 0; k < a.size().z(); ++k) sum += static_cast<double>(a(i, j, k)) * b(i, j, k);
  return sum;
}

TEST(Multigrid, CycleIsSymmetricAndPositive) {
  const Eigen::Vector3i cells(19, 24, 30);  // odd edges too
  Multigrid multigrid(cells);
  fillRandom(multigrid.finest(), 1);
  multigrid.coarsen();
  const auto apply = [&](const DenseField<float>& r) {
    multigrid.rightHandSide() = r;
    multigrid.cycle();
    return multigrid.solution();
  };
  const DenseField<float> x = randomField(cells, 2), y = randomField(cells, 3);
  const DenseField<float> mx = apply(x), my = apply(y);
  const double scale = std::sqrt(dot(x, mx) * dot(y, my));
  EXPECT_GT(dot(x, mx), 0);
  EXPECT_NEAR(dot(x, my) / scale, dot(y, mx) / scale, 1e-6);  // float round-off over 13,680 terms
}

TEST(Multigrid, CycleIsTheSameToTheBitForAnyNumberOfThreads) {
  const Eigen::Vector3i cells(61, 24, 30);
  Multigrid multigrid(cells);
  fillRandom(multigrid.finest(), 6);
  multigrid.coarsen();
  multigrid.rightHandSide() = randomField(cells, 7);
  tbb::task_arena(1).execute([&] { multigrid.cycle(); });
  const DenseField<float> alone = multigrid.solution();
  tbb::task_arena(5).execute([&] { multigrid.cycle(); });
  for (int i = 0; i < cells.x(); ++i)
    for (int j = 0; j < cells.y(); ++j)
      for (int k = 0; k < cells.z(); ++k) ASSERT_EQ(alone(i, j, k), multigrid.solution()(i, j, k));
}

TEST(Multigrid, MatrixOfConstantsIsTheExcess) {
  const Eigen::Vector3i cells(12, 9, 7);
  PressureMatrix matrix(cells);
  fillRandom(matrix, 4);
  DenseField<double> x(cells, 1.0), y(cells);
  for (int a = 0; a < 3; ++a) EXPECT_EQ(matrix.weight[a](0, 0, 0), 0);
  matrix.multiply(x, y);
  for (const ActiveRow& row : matrix.rows)
    for (int k = row.begin; k < row.end; ++k) EXPECT_EQ(y(row.i, row.j, k), matrix.excess(row.i, row.j, k));
}

/// A cube of air-topped water, the solve of performance.md.
TEST(ConjugateGradient, NeedsAtMost20IterationsAt32And64) {
  for (int n : {32, 64}) {
    const Eigen::Vector3i cells = Eigen::Vector3i::Constant(n);
    Multigrid multigrid(cells);
    PressureMatrix& matrix = multigrid.finest();
    DenseField<double> b(cells), x(cells);
    const DenseField<float> noise = randomField(cells, 5);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n / 2; ++j)
        for (int k = 0; k < n; ++k) {
          const Eigen::Vector3i c(i, j, k);
          for (int a = 0; a < 3; ++a) matrix.weight[a](c) = c[a] > 0;
          matrix.excess(c) = j + 1 == n / 2 ? 1 / (0.01f + 0.9f * static_cast<float>(i) / n) : 0;
          b(c) = noise(c);
        }
    matrix.finish();
    multigrid.coarsen();
    ConjugateGradient solver(cells);
    PocketUnknowns none;
    const SolveReport report = solver.solve(multigrid, b, x, 1e-6, 100, none);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.iterations, 20) << n;
  }
}

}  // namespace
}  // namespace spume::fluid
