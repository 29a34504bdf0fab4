#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "fluid/conjugate_gradient.h"
#include "fluid/multigrid.h"
#include "fluid/pocket_unknowns.h"
#include "fluid/slab_tiles.h"

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

template <typename Body>
void forEachOf(const Eigen::Vector3i& cells, const Body& body) {
  for (int i = 0; i < cells.x(); ++i)
    for (int j = 0; j < cells.y(); ++j)
      for (int k = 0; k < cells.z(); ++k) body(Eigen::Vector3i(i, j, k));
}

/// Makes balls of cells (centre, radius) pockets, with couplings of up to 20 times those between cells.
PocketUnknowns pocketsIn(PressureMatrix& matrix, const std::vector<Eigen::Vector4d>& balls) {
  PocketUnknowns pockets;
  pockets.clear(balls.size());
  const auto pocketOf = [&](const Eigen::Vector3i& c) {
    for (std::size_t p = 0; p < balls.size(); ++p)
      if ((c.cast<double>() - balls[p].head<3>()).norm() < balls[p].w()) return static_cast<int>(p);
    return -1;
  };
  forEachOf(matrix.cells(), [&](const Eigen::Vector3i& c) {
    if (pocketOf(c) >= 0) matrix.excess(c) = 0;
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3i low = c - Eigen::Vector3i::Unit(a);
      if (low[a] < 0 || (pocketOf(c) < 0 && pocketOf(low) < 0)) continue;
      const float theta = 0.05f + 0.06f * static_cast<float>((c.x() + 3 * c.y() + 5 * c.z()) % 16);
      const float coefficient = std::exchange(matrix.weight[a](c), 0.0f) / theta;
      if (coefficient == 0 || (pocketOf(c) >= 0 && pocketOf(low) >= 0)) continue;
      const bool above = pocketOf(low) >= 0;
      const Eigen::Vector3i& wet = above ? c : low;
      matrix.excess(wet) += coefficient;
      pockets.surfaces.push_back({wet, a, above ? -1 : 1, pocketOf(above ? low : c), coefficient, 0});
    }
  });
  matrix.finish();
  pockets.finish();
  return pockets;
}

/// A plane of numbers on which pass n changes the points of parity n by what lies beside them.
struct Chequers {
  int slabs, rows;
  std::vector<std::uint32_t> value;
  Chequers(int s, int r) : slabs(s), rows(r), value(static_cast<std::size_t>(s) * r) {
    for (std::size_t n = 0; n < value.size(); ++n) value[n] = static_cast<std::uint32_t>(n * n);
  }
  std::uint32_t at(int i, int j) const {
    return i < 0 || j < 0 || i >= slabs || j >= rows ? 7 : value[static_cast<std::size_t>(i) * rows + j];
  }
  void pass(int n, int slab, int begin, int end) {
    for (int j = begin; j < end; ++j)
      if ((slab + j + n) % 2 == 0)
        value[static_cast<std::size_t>(slab) * rows + j] = 3 * at(slab, j) + 5 * at(slab - 1, j) +
                                                           7 * at(slab + 1, j) + 11 * at(slab, j - 1) +
                                                           13 * at(slab, j + 1);
  }
};

TEST(SlabTiles, GivesWhatPassesOneAfterTheOtherGive) {
  for (const int slabs : {1, 8, 17, 24, 39, 64})
    for (const int rows : {1, 31, 32, 33, 100})
      for (const int passes : {1, 2, 4}) {
        Chequers plain(slabs, rows), tiled(slabs, rows);
        for (int n = 0; n < passes; ++n)
          for (int slab = 0; slab < slabs; ++slab) plain.pass(n, slab, 0, rows);
        SlabTiles(slabs, rows, passes).sweep([&](int n, int slab, int begin, int end) {
          tiled.pass(n, slab, begin, end);
        });
        EXPECT_EQ(plain.value, tiled.value)
            << slabs << " slabs, " << rows << " rows, " << passes << " passes";
      }
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

TEST(Multigrid, CycleWithPocketsIsSymmetricAndPositive) {
  const Eigen::Vector3i cells(19, 24, 30);
  Multigrid multigrid(cells);
  fillRandom(multigrid.finest(), 1);
  const PocketUnknowns pockets =
      pocketsIn(multigrid.finest(), {{5, 8, 9, 3.6}, {12, 10, 20, 2.2}, {9, 15, 9, 2.7}});
  multigrid.coarsen();
  multigrid.border(pockets);
  struct Pair {
    DenseField<float> cells;
    std::vector<float> pockets;
  };
  const auto apply = [&](const Pair& r) {
    multigrid.rightHandSide() = r.cells;
    multigrid.pocketRightHandSide() = r.pockets;
    multigrid.cycle();
    return Pair{multigrid.solution(), multigrid.pocketSolution()};
  };
  const auto product = [](const Pair& a, const Pair& b) {
    double sum = dot(a.cells, b.cells);
    for (std::size_t p = 0; p < a.pockets.size(); ++p)
      sum += static_cast<double>(a.pockets[p]) * b.pockets[p];
    return sum;
  };
  const auto onUnknowns = [&](DenseField<float> field) {
    forEachOf(cells, [&](const Eigen::Vector3i& c) {
      if (!(multigrid.finest().inverseDiagonal(c) > 0)) field(c) = 0;
    });
    return field;
  };
  const Pair x{onUnknowns(randomField(cells, 2)), {30, -20, 10}},
      y{onUnknowns(randomField(cells, 3)), {-5, 25, 40}};
  const Pair mx = apply(x), my = apply(y);
  const double scale = std::sqrt(product(x, mx) * product(y, my));
  EXPECT_GT(product(x, mx), 0);
  EXPECT_GT(product(y, my), 0);
  EXPECT_NEAR(product(x, my) / scale, product(y, mx) / scale, 1e-6);  // as above
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

/// A dense symmetric positive definite matrix, solved by elimination.
class DenseSystem {
 public:
  explicit DenseSystem(int count) : rows_(count, std::vector<double>(count, 0.0)) {}
  void add(int i, int j, double value) { rows_[i][j] += value; }
  /// A coupling of two unknowns that vanishes where they are equal.
  void couple(int i, int j, double weight) {
    add(i, i, weight), add(j, j, weight), add(i, j, -weight), add(j, i, -weight);
  }
  std::vector<double> solve(std::vector<double> b) {
    const int count = static_cast<int>(b.size());
    for (int n = 0; n < count; ++n)
      for (int i = n + 1; i < count; ++i) {
        const double factor = rows_[i][n] / rows_[n][n];
        for (int j = n; j < count; ++j) rows_[i][j] -= factor * rows_[n][j];
        b[i] -= factor * b[n];
      }
    for (int n = count - 1; n >= 0; --n) {
      for (int j = n + 1; j < count; ++j) b[n] -= rows_[n][j] * b[j];
      b[n] /= rows_[n][n];
    }
    return b;
  }

 private:
  std::vector<std::vector<double>> rows_;
};

TEST(ConjugateGradient, SolvesForCellsAndPocketsAsEliminationDoes) {
  const Eigen::Vector3i cells(9, 7, 8);
  const int count = cells.prod();
  Multigrid multigrid(cells);
  PressureMatrix& matrix = multigrid.finest();
  fillRandom(matrix, 11);
  PocketUnknowns pockets = pocketsIn(matrix, {{2, 2, 3, 1.6}, {6, 3, 4, 1.2}});
  multigrid.coarsen();
  pockets.residual = {0.7, -1.3};

  const auto number = [&](const Eigen::Vector3i& c) {
    return (c.x() * cells.y() + c.y()) * cells.z() + c.z();
  };
  DenseSystem dense(count + 2);
  std::vector<double> right(count + 2, 0.0);
  DenseField<double> b(cells), x(cells);
  const DenseField<float> noise = randomField(cells, 12);
  forEachOf(cells, [&](const Eigen::Vector3i& c) {
    const bool unknown = matrix.inverseDiagonal(c) > 0;
    dense.add(number(c), number(c), unknown ? matrix.excess(c) : 1);
    if (unknown) right[number(c)] = b(c) = noise(c);
    for (int a = 0; a < 3; ++a)
      if (c[a] > 0) dense.couple(number(c), number(c - Eigen::Vector3i::Unit(a)), matrix.weight[a](c));
  });
  for (const PocketSurface& s : pockets.surfaces) {
    dense.couple(number(s.cell), count + s.pocket, s.coefficient);
    dense.add(number(s.cell), number(s.cell), -s.coefficient);  // it is part of the excess already
  }
  std::copy(pockets.residual.begin(), pockets.residual.end(), right.begin() + count);
  const std::vector<double> exact = dense.solve(right);

  ConjugateGradient solver(cells);
  ASSERT_TRUE(solver.solve(multigrid, b, x, 1e-11, 100, pockets).converged);
  const double allowed = 1e-9;  // the tolerance times the inverse's norm, below 100
  forEachOf(cells, [&](const Eigen::Vector3i& c) { EXPECT_NEAR(x(c), exact[number(c)], allowed); });
  for (int p = 0; p < 2; ++p) EXPECT_NEAR(pockets.solution[p], exact[count + p], allowed);
}

/// Water full of closed pockets of air, as where a jet strikes. Relaxed on the finest level alone they would
/// take 50 iterations.
TEST(ConjugateGradient, PocketsCostHardlyAnyIterations) {
  const Eigen::Vector3i cells = Eigen::Vector3i::Constant(48);
  Multigrid multigrid(cells);
  PressureMatrix& matrix = multigrid.finest();
  forEachOf(cells, [&](const Eigen::Vector3i& c) {
    for (int a = 0; a < 3; ++a) matrix.weight[a](c) = c[a] > 0;
    matrix.excess(c) = c.y() + 1 == cells.y() ? 1 : 0;
  });
  std::vector<Eigen::Vector4d> balls;
  for (int n = 0; n < 12; ++n)
    balls.emplace_back(8 + 10 * (n % 4), 10 + 4 * (n % 5), 8 + 14 * (n / 4), 2.5 + 0.3 * n);
  PocketUnknowns pockets = pocketsIn(matrix, balls);
  multigrid.coarsen();
  for (std::size_t p = 0; p < balls.size(); ++p) pockets.residual[p] = p % 2 ? 10 : -20;
  DenseField<double> b(cells), x(cells);
  const DenseField<float> noise = randomField(cells, 5);
  forEachOf(cells, [&](const Eigen::Vector3i& c) {
    if (matrix.inverseDiagonal(c) > 0) b(c) = noise(c);
  });
  ConjugateGradient solver(cells);
  const SolveReport report = solver.solve(multigrid, b, x, 1e-6, 100, pockets);
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, 12);
}

}  // namespace
}  // namespace spume::fluid
