#include "fluid/multigrid.h"

#include <algorithm>

#include "fluid/pressure_rows.h"
#include "fluid/slab_tiles.h"

namespace spume::fluid {
namespace {

// The coarsest level has no edge longer than this [cells]; it is small enough for smoothing alone.
constexpr int kCoarsestEdge = 4;
// Double sweeps on the coarsest level, on each side of the middle: the error there falls by > 10 per pair.
constexpr int kCoarsestSweeps = 6;
// Double sweeps on each side of the coarse correction. Two on the finest level need half the iterations of
// one, in three quarters of the time; more gain nothing. One is enough on coarse levels that are visited
// twice: for the dam break of performance.md at 64^3 and 128^3 that takes 6.9 and 7.3 iterations of CG to
// 1e-6, three sweeps and one visit take 7.5 and 8.0.
constexpr int kFineSweeps = 2, kCoarseSweeps = 1;
static_assert(kTileSlabs >= 4 * std::max(kFineSweeps, kCoarseSweeps),
              "a tile is too narrow for its half sweeps");
// Cells of a row handled at once: what is made of them on the way stays in the first-level cache.
constexpr int kPiece = 128;
// More rows than these are not left to one thread, even if they are a single tile.
constexpr std::size_t kFewRows = 256;
constexpr int kRed = 0, kBlack = 1;  // parities of i + j + k

/// One coarse weight or excess: half the sum of the fine values at the given offsets.
template <int count>
float halfSum(const DenseField<float>& fine, const Eigen::Vector3i& at,
              const Eigen::Vector3i (&offsets)[count]) {
  float sum = 0;
  for (const Eigen::Vector3i& offset : offsets) sum += fine(at + offset);
  return 0.5f * sum;
}

// The loops over a piece of a row stand alone so that nothing they read can alias what they write.

/// The first sweep from x = 0 over the cells of one parity; the others are set to 0.
[[gnu::noinline]] void startPiece(const float* __restrict inverse, const float* __restrict rhs, int parity,
                                  int count, float* __restrict x) {
  for (int k = 0; k < count; ++k) {
    const float relaxed = inverse[k] * rhs[k];
    x[k] = ((k ^ parity) & 1) == 0 ? relaxed : 0;
  }
}

/// Gauss-Seidel sweep over the cells of one parity of a piece of a row that begins at offset `at`. All are
/// computed and those of the other parity kept as they were, so that the loop vectorises; the new values
/// depend on these alone. They go to another place: written back at once they would be read again by the next
/// few cells before the processor has them in order.
[[gnu::noinline]] void relaxPiece(const PressureMatrix& m, std::ptrdiff_t at, int parity, int count,
                                  const float* __restrict rhs, const float* __restrict before,
                                  float* __restrict after) {
  const auto si = m.excess.stride(0), sj = m.excess.stride(1);
  const float* __restrict wx = m.weight[0].data() + at;
  const float* __restrict wy = m.weight[1].data() + at;
  const float* __restrict wz = m.weight[2].data() + at;
  const float* __restrict inverse = m.inverseDiagonal.data() + at;
  for (int k = 0; k < count; ++k) {
    const float relaxed =
        inverse[k] * (rhs[k] + wx[k] * before[k - si] + wx[k + si] * before[k + si] + wy[k] * before[k - sj] +
                      wy[k + sj] * before[k + sj] + wz[k] * before[k - 1] + wz[k + 1] * before[k + 1]);
    const float kept = before[k];
    after[k] = ((k ^ parity) & 1) == 0 ? relaxed : kept;
  }
}

/// The same for a whole row, in place.
void relaxRow(const PressureMatrix& m, std::ptrdiff_t at, int parity, int count, const float* rhs, float* x) {
  alignas(64) float relaxed[kPiece];
  static_assert(kPiece % 2 == 0, "all pieces begin with the same parity");
  for (int k = 0; k < count; k += kPiece) {
    const int length = std::min(kPiece, count - k);
    relaxPiece(m, at + k, parity, length, rhs + k, x + k, relaxed);
    std::copy_n(relaxed, length, x + k);
  }
}

/// Adds the correction of `pairs` coarse cells to their children in a row, where these are unknowns.
[[gnu::noinline]] void correctPairs(const float* __restrict correction, const float* __restrict inverse,
                                    int pairs, float* __restrict x) {
  for (int m = 0; m < pairs; ++m) {
    const float low = inverse[2 * m] > 0 ? correction[m] : 0;
    const float high = inverse[2 * m + 1] > 0 ? correction[m] : 0;
    x[2 * m] += low;
    x[2 * m + 1] += high;
  }
}

/// Residual of cells [begin, begin + count) of row (i, j), 0 where there is no unknown.
void residualPiece(const PressureMatrix& m, int i, int j, int begin, int count, const float* __restrict rhs,
                   const float* __restrict x, float* __restrict residual) {
  const auto at = m.excess.index(i, j, begin);
  const auto si = m.excess.stride(0), sj = m.excess.stride(1);
  const float* __restrict wx = m.weight[0].data() + at;
  const float* __restrict wy = m.weight[1].data() + at;
  const float* __restrict wz = m.weight[2].data() + at;
  const float* __restrict excess = m.excess.data() + at;
  const float* __restrict inverse = m.inverseDiagonal.data() + at;
  for (int k = 0; k < count; ++k) {
    const float c = x[k];
    const float value = rhs[k] - wx[k] * (c - x[k - si]) - wx[k + si] * (c - x[k + si]) -
                        wy[k] * (c - x[k - sj]) - wy[k + sj] * (c - x[k + sj]) - wz[k] * (c - x[k - 1]) -
                        wz[k + 1] * (c - x[k + 1]) - excess[k] * c;
    residual[k] = inverse[k] > 0 ? value : 0;
  }
}

}  // namespace

Multigrid::Multigrid(const Eigen::Vector3i& cells) {
  Eigen::Vector3i size = cells;
  levels_.emplace_back(size);
  while (size.maxCoeff() > kCoarsestEdge) {
    size = (size + Eigen::Vector3i::Ones()) / 2;
    levels_.emplace_back(size);
  }
}

void Multigrid::coarsen() {
  for (std::size_t n = 1; n < levels_.size(); ++n) {
    aggregate(levels_[n - 1].matrix, levels_[n].matrix);
    levels_[n].matrix.finish();
  }
}

void Multigrid::border(const PocketUnknowns& pockets) {
  levels_.front().border.assemble(pockets);
  for (std::size_t n = 1; n < levels_.size(); ++n) levels_[n].border.coarsen(levels_[n - 1].border);
}

void Multigrid::aggregate(const PressureMatrix& fine, PressureMatrix& coarse) {
  // Children beyond an odd edge lie in the ghosts, where all coefficients are 0.
  static const Eigen::Vector3i kFace[3][4] = {{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}},
                                              {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}},
                                              {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}};
  static const Eigen::Vector3i kCell[8] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                           {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  forEachCell(coarse.cells(), [&](int i, int j, int k) {
    const Eigen::Vector3i at(2 * i, 2 * j, 2 * k);
    for (int a = 0; a < 3; ++a) coarse.weight[a](i, j, k) = halfSum(fine.weight[a], at, kFace[a]);
    coarse.excess(i, j, k) = halfSum(fine.excess, at, kCell);
  });
}

void Multigrid::cycle() {
  levels_.front().border.start(pocketRhs_);
  partCycle(0, HalfSweep::start);
}

/// Solves for the residual of the finer level, from 0, in two V cycles.
void Multigrid::visit(std::size_t depth) {
  Level& level = levels_[depth];
  level.border.start({});  // the finer level's pockets were relaxed last: no residual is left there
  partCycle(depth, HalfSweep::start);
  if (depth + 1 == levels_.size()) return;
  level.border.relax(level.x, level.rhs);
  partCycle(depth, HalfSweep::red);
}

/// Smooths, corrects from the coarser levels, smooths.
void Multigrid::partCycle(std::size_t depth, HalfSweep first) {
  Level& level = levels_[depth];
  const int sweeps = depth + 1 == levels_.size() ? kCoarsestSweeps : depth == 0 ? kFineSweeps : kCoarseSweeps;
  smoothDown(level, first, sweeps);
  if (depth + 1 < levels_.size()) {
    restrictResidual(level, levels_[depth + 1]);
    visit(depth + 1);
    addCorrection(levels_[depth + 1], level);
  }
  smoothUp(level, sweeps);
}

/// Red before black, then the pockets.
void Multigrid::smoothDown(Level& level, HalfSweep first, int sweeps) {
  const int together = level.border.empty() ? sweeps : 1;
  for (int done = 0; done < sweeps; done += together) {
    sweep(level, 2 * together, done == 0 ? first : HalfSweep::red, HalfSweep::black);
    level.border.relax(level.x, level.rhs);
  }
}

/// The same backwards.
void Multigrid::smoothUp(Level& level, int sweeps) {
  const int together = level.border.empty() ? sweeps : 1;
  for (int done = 0; done < sweeps; done += together) {
    level.border.relax(level.x, level.rhs);
    sweep(level, 2 * together, HalfSweep::black, HalfSweep::red);
  }
}

/// `halves` half sweeps in turns, the first one of them `first`.
void Multigrid::sweep(Level& level, int halves, HalfSweep first, HalfSweep second) {
  const PressureMatrix& m = level.matrix;
  const auto halfAt = [&](int n) {
    const HalfSweep again = first == HalfSweep::start ? HalfSweep::red : first;
    return n == 0 ? first : n % 2 == 0 ? again : second;
  };
  const int rows = m.cells().y();
  const SlabTiles tiles(m.cells().x(), rows, halves);
  if (tiles.single() && m.rows.size() > kFewRows) {
    for (int n = 0; n < halves; ++n)
      forEachActiveRow(m.rows, [&](const ActiveRow& row) { relax(level, halfAt(n), row); });
    return;
  }
  tiles.sweep([&](int n, int slab, int begin, int end) {
    const HalfSweep half = halfAt(n);
    for (int row = m.rowStart[slab * rows + begin]; row < m.rowStart[slab * rows + end]; ++row)
      relax(level, half, m.rows[row]);
  });
}

void Multigrid::relax(Level& level, HalfSweep half, const ActiveRow& row) {
  const auto at = level.matrix.excess.index(row.i, row.j, row.begin);
  const int colour = half == HalfSweep::black ? kBlack : kRed;
  const int parity = (row.i + row.j + row.begin + colour) & 1, count = row.end - row.begin;
  const float* rhs = level.rhs.data() + at;
  float* x = level.x.data() + at;
  if (half == HalfSweep::start)
    startPiece(level.matrix.inverseDiagonal.data() + at, rhs, parity, count, x);
  else
    relaxRow(level.matrix, at, parity, count, rhs, x);
}

void Multigrid::restrictResidual(const Level& fine, Level& coarse) {
  forEachActiveRow(coarse.matrix.rows, [&](const ActiveRow& row) {
    for (int begin = row.begin; begin < row.end; begin += kPiece)
      restrictPiece(fine, coarse, {row.i, row.j, begin, std::min(row.end, begin + kPiece)});
  });
}

void Multigrid::restrictPiece(const Level& fine, Level& coarse, const ActiveRow& piece) {
  const int count = piece.end - piece.begin;
  float* sum = &coarse.rhs(piece.i, piece.j, piece.begin);
  std::fill_n(sum, count, 0.0f);
  alignas(64) float residual[2 * kPiece];
  for (int n = 0; n < 4; ++n) {  // a child row beyond an odd edge lies in the ghosts and gives 0
    const int i = 2 * piece.i + (n & 1), j = 2 * piece.j + (n >> 1), k = 2 * piece.begin;
    residualPiece(fine.matrix, i, j, k, 2 * count, &fine.rhs(i, j, k), &fine.x(i, j, k), residual);
    for (int m = 0; m < count; ++m) sum[m] += residual[2 * m] + residual[2 * m + 1];
  }
}

void Multigrid::addCorrection(const Level& coarse, Level& fine) {
  forEachActiveRow(fine.matrix.rows, [&](const ActiveRow& row) {
    const int begin = row.begin / 2, pairs = (row.end + 1) / 2 - begin;  // past an odd end lies a ghost
    correctPairs(&coarse.x(row.i / 2, row.j / 2, begin),
                 &fine.matrix.inverseDiagonal(row.i, row.j, 2 * begin), pairs,
                 &fine.x(row.i, row.j, 2 * begin));
  });
}

}  // namespace spume::fluid
