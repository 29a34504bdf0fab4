// The incomplete factor of a packing in several blocks, against its definition.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "foam/incomplete_cholesky.h"

namespace spume::foam {
namespace {

constexpr int kSide = 14;      ///< 2744 rows of a lattice: four blocks and their borders
constexpr double kOwn = 0.02;  ///< of each row [kg]

BlockSystem lattice() {
  BlockSystem a;
  a.start = {0};
  const auto couple = [&](bool is, int i, int other, const Eigen::Vector3d& along) {
    if (!is) return;
    const double stiffness = 1 + (7 * (i + other)) % 5;
    a.other.push_back(other), a.block.push_back({stiffness * along, 0.1 * stiffness});
  };
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const int x = i % kSide, y = i / kSide % kSide, z = i / kSide / kSide;
    a.own.push_back(kOwn * Eigen::Matrix3d::Identity());
    couple(z > 0, i, i - kSide * kSide, {0.2, 0, 1}), couple(y > 0, i, i - kSide, {0.2, 1, 0.1});
    couple(x > 0, i, i - 1, {1, 0, 0.5}), couple(x + 1 < kSide, i, i + 1, {1, 0, 0.5});
    couple(y + 1 < kSide, i, i + kSide, {0.2, 1, 0.1});
    couple(z + 1 < kSide, i, i + kSide * kSide, {0.2, 0, 1});
    a.start.push_back(static_cast<std::int32_t>(a.other.size()));
  }
  return a;
}

Eigen::Matrix3d matrixOf(const SweptSystem::Coupling& coupling) {
  const Eigen::Vector3d along = coupling.head<3>().cast<double>();
  return along * along.transpose() + static_cast<double>(coupling.w()) * Eigen::Matrix3d::Identity();
}

struct Factor {
  SweptSystem swept;
  IncompleteCholesky cholesky;

  Factor() {
    swept.copy(lattice(), true);
    Crew::lead(swept.tasks(), [&](Crew& crew) { cholesky.factor(crew, swept); });
  }
  /// D^-1 of row k.
  Eigen::Matrix3d inverse(std::size_t k) const {
    const Eigen::Matrix3d g = cholesky.scale[k].matrix();
    return g.transpose() * g;
  }
  /// D of row k by its definition from the D of earlier rows.
  Eigen::Matrix3d pivot(std::size_t k) const {
    const auto behind = static_cast<std::int32_t>(swept.size()) + 1;
    Eigen::Matrix3d d = swept.diagonal[k];
    for (std::int32_t e = swept.row[k].behind; e < swept.row[k].beyond; ++e) {
      const Eigen::Matrix3d b = matrixOf(swept.known.block[e]);
      d -= b * inverse(static_cast<std::size_t>(swept.known.other[e] - behind)) * b;
    }
    return d;
  }
};

TEST(IncompleteCholesky, PivotsAreWhatEarlierRowsLeave) {
  const Factor factor;
  ASSERT_EQ(factor.swept.groups(), 2 * factor.swept.tasks()) << "no borders";
  constexpr double kSingle = 1e-4;  // G is kept in single precision, D spans two decades
  for (std::size_t k = 0; k < factor.swept.size(); ++k)
    EXPECT_LE((factor.inverse(k) * factor.pivot(k) - Eigen::Matrix3d::Identity()).norm(), kSingle) << k;
}

TEST(IncompleteCholesky, PivotsKeepAtLeastTheirOwnBlock) {
  const Factor factor;
  std::size_t lessened = 0;
  for (std::size_t k = 0; k < factor.swept.size(); ++k) {
    const Eigen::Matrix3d d = factor.pivot(k);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of(d, Eigen::EigenvaluesOnly);
    EXPECT_GE(of.eigenvalues()[0], 0.99 * kOwn) << k;
    lessened += d.trace() < 0.99 * factor.swept.diagonal[k].trace();
  }
  EXPECT_GT(lessened, factor.swept.size() * 9 / 10);
}

}  // namespace
}  // namespace spume::foam
