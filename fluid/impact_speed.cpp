#include "fluid/impact_speed.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// Points looked at along each half axis of the ball of reach.
constexpr int kPointsAcross = 2;
/// Those of the lattice within the ball.
constexpr int kPoints = 33;
/// Share of the pairs of points that may differ by more: two points of 33 that a splash has thrown off make
/// an eighth of the pairs, two streams of which one holds an eighth of the points a fifth.
constexpr double kFastPairs = 0.2;
/// Numerical layers between two streams are this thick [cells].
constexpr double kSmallestReach = 3;

/// The difference that only kFastPairs of all pairs of the first `count` velocities exceed [m/s].
double robustDifference(const std::array<Velocity3f, kPoints>& seen, int count) {
  std::array<float, kPoints*(kPoints - 1) / 2> square;
  int pairs = 0;
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < a; ++b) {
      const float u = seen[a].x - seen[b].x, v = seen[a].y - seen[b].y, w = seen[a].z - seen[b].z;
      square[pairs++] = u * u + v * v + w * w;
    }
  if (pairs == 0) return 0;
  const auto fast = square.begin() + static_cast<int>((1 - kFastPairs) * (pairs - 1));
  std::nth_element(square.begin(), fast, square.begin() + pairs);
  return std::sqrt(*fast);
}

}  // namespace

double impactSpeed(const MarkerScene& scene, const DenseField<float>& phi, const MacVelocity& velocity,
                   const Eigen::Vector3d& position) {
  const FieldView field(phi), psi(scene.solids.psi);
  const MacView stream(velocity);
  const double reach = std::max(scene.params.impactReach / scene.grid.dx, kSmallestReach);
  const Eigen::Vector3f centre = scene.grid.toCells(position).cast<float>();
  const float spacing = static_cast<float>(reach / kPointsAcross);
  std::array<Velocity3f, kPoints> seen;
  int count = 0;
  for (int i = -kPointsAcross; i <= kPointsAcross; ++i)
    for (int j = -kPointsAcross; j <= kPointsAcross; ++j)
      for (int k = -kPointsAcross; k <= kPointsAcross; ++k) {
        if (i * i + j * j + k * k > kPointsAcross * kPointsAcross) continue;
        const Eigen::Vector3f x = centre + spacing * Eigen::Vector3f(i, j, k);
        if ((x.array() < 0).any() || (x.array() > scene.grid.cells.array().cast<float>()).any()) continue;
        if (sampleCentred(field, x.x(), x.y(), x.z()) >= 0 || sampleCentred(psi, x.x(), x.y(), x.z()) < 0)
          continue;
        seen[count++] = sampleVelocity(stream, x.x(), x.y(), x.z());
      }
  return robustDifference(seen, count);
}

}  // namespace spume::fluid
