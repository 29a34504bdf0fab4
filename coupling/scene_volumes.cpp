#include "coupling/scene_volumes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/domain_box.h"
#include "coupling/scene_builder.h"

namespace spume::coupling {

namespace {

/// Liquid at rest under its level.
SignedDistance poolPhi(const Scene& scene) {
  const Eigen::Vector3d& g = scene.liquid.gravity;
  const Eigen::Vector3d up = g.norm() > 0 ? Eigen::Vector3d(-g.normalized()) : Eigen::Vector3d::UnitY();
  return [up, level = scene.stillPool.level](const Eigen::Vector3d& x) { return up.dot(x) - level; };
}

}  // namespace

double initialWetShare(const Scene& scene) {
  constexpr int kPoints = 32;
  const SignedDistance phi = scene.stillPool.enabled ? poolPhi(scene) : initialPhi(scene),
                       psi = solidDistance(scene);
  const DomainBox domain(scene);
  int wet = 0;
  for (int i = 0; i < kPoints; ++i)
    for (int j = 0; j < kPoints; ++j)
      for (int k = 0; k < kPoints; ++k) {
        const Eigen::Array3d place = (Eigen::Array3d(i, j, k) + 0.5) / kPoints;
        const Eigen::Vector3d x = domain.lower + (place * domain.size().array()).matrix();
        wet += phi(x) < 0 && psi(x) > 0;
      }
  return wet / std::pow(kPoints, 3);
}

double pouredUntil(const Scene& scene, double t) {
  constexpr int kSamples = 1000;
  double volume = 0;
  for (const InflowSpec& inflow : scene.inflows) {
    const double start = inflow.start, length = std::max(0.0, std::min(inflow.stop, t) - start);
    double mean = 0;
    for (int n = 0; n < kSamples; ++n)
      mean += inflow.speed.at(start + length * (n + 0.5) / kSamples) / kSamples;
    volume += std::numbers::pi * inflow.radius * inflow.radius * mean * length;
  }
  return volume;
}

}  // namespace spume::coupling
