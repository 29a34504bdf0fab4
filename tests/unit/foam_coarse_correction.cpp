// Clusters of rows that move as one, against the matrix itself.
#include <gtest/gtest.h>

#include <cmath>

#include "foam/coarse_correction.h"

namespace spume::foam {
namespace {

constexpr int kWidth = 92;  ///< rows along each side of a sheet: 8464 rows, 16 clusters

/// Springs of random stiffness between neighbours of a sheet; one row is held from outside.
BlockSystem sheet() {
  BlockSystem a;
  a.start = {0};
  for (int i = 0; i < kWidth * kWidth; ++i) {
    const int x = i % kWidth, y = i / kWidth;
    a.own.push_back((i == 700 ? 1e6 : 0.01) * Eigen::Matrix3d::Identity());
    const auto couple = [&](bool is, int other, const Eigen::Vector3d& along) {
      if (!is) return;
      const double stiffness = 1 + (7 * (i + other)) % 5;
      a.other.push_back(other), a.block.push_back({stiffness * along, 0.1 * stiffness});
    };
    couple(y > 0, i - kWidth, {0.2, 1, 0.1}), couple(x > 0, i - 1, {1, 0, 0.5});
    couple(x + 1 < kWidth, i + 1, {1, 0, 0.5}), couple(y + 1 < kWidth, i + kWidth, {0.2, 1, 0.1});
    a.start.push_back(static_cast<std::int32_t>(a.other.size()));
  }
  return a;
}

struct Clusters {
  SweptSystem swept;
  CoarseCorrection coarse;
  explicit Clusters(const BlockSystem& a) { swept.copy(a, true), coarse.build(a, swept, true); }

  Vectors3 spread(const Eigen::VectorXd& motion) const {
    Vectors3 v(swept.size(), Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < v.size(); ++i)
      if (coarse.clusterOf(i) < coarse.clusters()) v[i] = motion.segment<3>(3 * coarse.clusterOf(i));
    return v;
  }
};

/// What the clusters know of A Z and Z^T A is what A does.
void expectFollows(const BlockSystem& a, const Clusters& of) {
  const std::size_t count = of.coarse.clusters();
  ASSERT_EQ(count, 16u);
  Eigen::VectorXd motion(3 * count), expected, found(3 * count);
  for (Eigen::Index c = 0; c < motion.size(); ++c) motion[c] = std::sin(1.0 + 3 * c);
  std::vector<Eigen::Vector4f> known(count + 1, Eigen::Vector4f::Zero()), sums(count, known.back());
  for (std::size_t c = 0; c < count; ++c) known[c].head<3>() = motion.segment<3>(3 * c).cast<float>();
  Vectors3 all = of.spread(motion), image(a.size()), right(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) image[i] = a.row(i, all);
  for (std::size_t k = 0; k < a.size(); ++k) {
    const std::int32_t i = of.swept.source[k];
    const Eigen::Vector4f v(std::cos(2.0f * i), std::sin(5.0f * i), std::cos(9.0f * i), 0);
    const Eigen::Vector4f did = toVector(of.coarse.exchange(k, loadQuad(v), known.data(), sums.data()));
    EXPECT_LE((did.head<3>().cast<double>() - image[i]).norm(), 1e-5) << i;
    all[i] += v.head<3>().cast<double>();
  }
  for (std::size_t i = 0; i < a.size(); ++i) right[i] = a.row(i, all);
  of.coarse.sumUp(right, expected);
  for (std::size_t c = 0; c < count; ++c) found.segment<3>(3 * c) = sums[c].head<3>().cast<double>();
  EXPECT_LE((found - expected).norm(), 1e-4 * expected.norm());
}

TEST(CoarseCorrection, KnowsWhatTranslationsDoAndFollowsPins) {
  BlockSystem a = sheet();
  Clusters clusters(a);
  EXPECT_EQ(clusters.coarse.clusterOf(700), 16u) << "held from outside";
  EXPECT_EQ(clusters.coarse.clusterOf(701), 1u);
  expectFollows(a, clusters);
  std::swap(a.own[700], a.own[533]);  // at a border of clusters
  clusters.coarse.refresh(a, clusters.swept, {533, 700});
  EXPECT_EQ(clusters.coarse.clusterOf(533), 16u);
  EXPECT_EQ(clusters.coarse.clusterOf(700), 1u);
  expectFollows(a, clusters);
}

TEST(CoarseCorrection, IsPositiveAndSymmetric) {
  const Clusters clusters(sheet());
  const auto solve = [&](int at) {
    Eigen::VectorXd motion;
    clusters.coarse.solve(Eigen::VectorXd::Unit(48, at), motion);
    return motion;
  };
  for (int i = 0; i < 48; ++i) {
    EXPECT_GT(solve(i)[i], 0);
    for (int j = 0; j < i; ++j) EXPECT_NEAR(solve(i)[j], solve(j)[i], 1e-9 * solve(i)[i]);
  }
}

TEST(CoarseCorrection, FewRowsHaveNone) {
  const BlockSystem one{{Eigen::Matrix3d::Identity()}, {0, 0}, {}, {}};
  EXPECT_EQ(Clusters(one).coarse.clusters(), 0u);
}

}  // namespace
}  // namespace spume::foam
