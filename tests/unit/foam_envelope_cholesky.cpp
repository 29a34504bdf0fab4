// The factor of a sparse matrix of blocks against the matrix itself.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "foam/envelope_cholesky.h"

namespace spume::foam {
namespace {

/// Springs between neighbours of a ring and some chords, each row held a little; two rows know nobody.
SparseBlocks ring(int n) {
  std::vector<std::map<std::int32_t, Eigen::Matrix3d>> row(n + 2);
  for (int i = 0; i < n + 2; ++i) row[i][i] = (0.1 + i % 3) * Eigen::Matrix3d::Identity();
  const auto couple = [&](int i, int j) {
    const Eigen::Vector3d along(std::sin(1.0 + i), std::cos(2.0 * j), std::sin(3.0 * i + j));
    const Eigen::Matrix3d block = along * along.transpose() + 0.01 * Eigen::Matrix3d::Identity();
    const auto add = [&](int p, int q, double share) {
      row[p].try_emplace(q, Eigen::Matrix3d::Zero()).first->second += share * block;
    };
    add(i, i, 1), add(j, j, 1), add(i, j, -1), add(j, i, -1);
  };
  for (int i = 0; i < n; ++i) couple(i, (i + 1) % n);
  for (int i = 0; i < n; i += 5) couple(i, (7 * i + 11) % n);
  SparseBlocks a;
  a.start = {0};
  for (const auto& blocks : row) {
    for (const auto& [j, block] : blocks) a.other.push_back(j), a.block.push_back(block);
    a.start.push_back(static_cast<std::int32_t>(a.other.size()));
  }
  return a;
}

TEST(EnvelopeCholesky, SolvesWhatTheMatrixMultiplies) {
  for (const int n : {1, 2, 17, 100}) {
    const SparseBlocks a = ring(n);
    Eigen::VectorXd x(3 * a.size()), b, found;
    for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = std::sin(1.0 + 5 * k);
    a.times(x, b);
    EnvelopeCholesky factor;
    factor.order(a);
    ASSERT_TRUE(factor.factor(a));
    factor.solve(b, found);
    EXPECT_LE((found - x).norm(), 1e-10 * x.norm()) << n;
  }
}

TEST(EnvelopeCholesky, AnswersNothingWhereTheMatrixIsNotPositive) {
  SparseBlocks a = ring(17);
  EnvelopeCholesky factor;
  factor.order(a);
  for (std::int32_t e = a.start[9]; e < a.start[10]; ++e)
    if (a.other[e] == 9) a.block[e] = -Eigen::Matrix3d::Identity();
  EXPECT_FALSE(factor.factor(a));
  Eigen::VectorXd found;
  factor.solve(Eigen::VectorXd::Ones(57), found);
  EXPECT_TRUE(found.isZero(0));
}

}  // namespace
}  // namespace spume::foam
