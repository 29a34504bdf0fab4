// Clusters of rows that move as one, against the matrix itself.
#include <gtest/gtest.h>

#include <cmath>

#include "foam/coarse_correction.h"

namespace spume::foam {
namespace {

constexpr int kWidth = 92;  ///< rows along each side of a sheet: 8464 rows, 22 clusters

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
  explicit Clusters(const BlockSystem& a) {
    swept.copy(a, true), coarse.build(a, swept, true), coarse.factor();
  }

  Vectors3 spread(const Eigen::VectorXd& motion) const {
    Vectors3 v(swept.size(), Eigen::Vector3d::Zero());
    for (std::size_t i = 0; i < v.size(); ++i)
      if (coarse.clusterOf(i) < coarse.clusters()) v[i] = motion.segment<3>(3 * coarse.clusterOf(i));
    return v;
  }
};

/// What the clusters know of A Z, Z^T A and Z^T A Z is what A does.
void expectFollows(const BlockSystem& a, const Clusters& of) {
  const std::size_t count = of.coarse.clusters();
  ASSERT_EQ(count, 22u);
  Eigen::VectorXd motion(3 * count), expected, found(3 * count);
  for (Eigen::Index c = 0; c < motion.size(); ++c) motion[c] = std::sin(1.0 + 3 * c);
  std::vector<Eigen::Vector4f> known(count + 1, Eigen::Vector4f::Zero());
  for (std::size_t c = 0; c < count; ++c) known[c].head<3>() = motion.segment<3>(3 * c).cast<float>();
  Vectors3 all = of.spread(motion), image(a.size()), right(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) image[i] = a.row(i, all);
  std::vector<Eigen::Vector4f> rows(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    const std::int32_t i = of.swept.source[k];
    const Eigen::Vector4f did = toVector(of.coarse.image(k, known.data()));
    EXPECT_LE((did.head<3>().cast<double>() - image[i]).norm(), 1e-5) << i;
    rows[k] = {std::cos(2.0f * i), std::sin(5.0f * i), std::cos(9.0f * i), 0};
    all[i] = rows[k].head<3>().cast<double>();
  }
  of.coarse.sumUp(image, expected);
  of.coarse.stiffen(motion, found);
  EXPECT_LE((found - expected).norm(), 1e-6 * expected.norm());
  for (std::size_t i = 0; i < a.size(); ++i) right[i] = a.row(i, all);
  of.coarse.sumUp(right, expected);
  for (std::size_t c = 0; c < count; ++c) found.segment<3>(3 * c) = of.coarse.pullOf(c, rows.data());
  EXPECT_LE((found - expected).norm(), 1e-4 * expected.norm());
}

TEST(CoarseCorrection, KnowsWhatTranslationsDoAndFollowsPins) {
  BlockSystem a = sheet();
  Clusters clusters(a);
  EXPECT_EQ(clusters.coarse.clusterOf(700), 22u) << "held from outside";
  EXPECT_EQ(clusters.coarse.clusterOf(701), 1u);
  expectFollows(a, clusters);
  std::swap(a.own[700], a.own[533]);  // at a border of clusters
  clusters.coarse.refresh(a, clusters.swept, {533, 700});
  EXPECT_EQ(clusters.coarse.clusterOf(533), 22u);
  EXPECT_EQ(clusters.coarse.clusterOf(700), 1u);
  expectFollows(a, clusters);
}

TEST(CoarseCorrection, AnswersWithTheMotionsThatTakeThePull) {
  BlockSystem a = sheet();
  Clusters clusters(a);
  const auto expectTaken = [&](const Eigen::VectorXd& pull) {
    Eigen::VectorXd motion, taken;
    clusters.coarse.solve(pull, motion);
    clusters.coarse.stiffen(motion, taken);
    EXPECT_LE((taken - pull).norm(), 1e-6 * pull.norm());  // blocks are of single precision
  };
  Eigen::VectorXd pull = Eigen::VectorXd::LinSpaced(66, -1, 2);
  expectTaken(pull);
  std::vector<std::int32_t>
      rows;  // so many that they are taken on: the first cluster and some are held whole
  for (std::int32_t i = 0; i < 400; ++i) a.own[i] = 1e6 * Eigen::Matrix3d::Identity(), rows.push_back(i);
  clusters.swept.refresh(a, rows);
  clusters.coarse.refresh(a, clusters.swept, rows);
  pull.head<3>().setZero();  // of which nothing moves
  expectTaken(pull);
}

TEST(CoarseCorrection, FewRowsHaveNone) {
  const BlockSystem one{{Eigen::Matrix3d::Identity()}, {0, 0}, {}, {}};
  EXPECT_EQ(Clusters(one).coarse.clusters(), 0u);
}

TEST(CoarseCorrection, ForgetsTheClustersOfALargerSystem) {
  const BlockSystem one{{Eigen::Matrix3d::Identity()}, {0, 0}, {}, {}};
  Clusters clusters(sheet());
  clusters.swept.copy(one, true), clusters.coarse.build(one, clusters.swept, true), clusters.coarse.factor();
  EXPECT_EQ(clusters.coarse.clusterOf(0), 0u) << "in none";
  Eigen::VectorXd none, motion, pull;
  clusters.coarse.sumUp({Eigen::Vector3d::UnitX()}, none);
  clusters.coarse.solve(none, motion), clusters.coarse.stiffen(motion, pull);
  EXPECT_EQ(none.size() + motion.size() + pull.size(), 0);
}

}  // namespace
}  // namespace spume::foam
