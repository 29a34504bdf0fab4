#include "foam/surroundings.h"

#include <functional>

#include "foam/errors.h"
#include "foam/failure_text.h"
#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// `field` has a column a point.
template <typename Field>
void requireFinite(const Field& field, const char* name, Points x) {
  const auto value = [&](std::size_t i) { return field.col(static_cast<Eigen::Index>(i)); };
  const auto isFinite = [&](std::size_t i) { return value(i).allFinite(); };
  const auto points = static_cast<std::size_t>(x.cols());
  if (reduceIndices(points, true, isFinite, std::logical_and<>())) return;
  for (std::size_t i = 0; i < points; ++i)
    if (!isFinite(i))
      throw NumericalFailure(joined("foam: the liquid sampler returned ", name, " = ", value(i).transpose(),
                                    ", not finite, at ", textOf(x.col(static_cast<Eigen::Index>(i))), " m"));
}

}  // namespace

void Surroundings::sample(const LiquidSampler& liquid, Points x) {
  sampleSolids(liquid, x);
  sampleFlow(liquid, x);
  const Eigen::Index n = x.cols();
  gradPhi.resize(3, n), gradPressure.resize(3, n);
  if (n == 0) return;
  liquid.gradPhi(x, gradPhi);
  liquid.gradPressure(x, gradPressure);
  requireFinite(gradPhi, "gradPhi", x), requireFinite(gradPressure, "gradPressure", x);
}

void Surroundings::sampleFlow(const LiquidSampler& liquid, Points x) {
  const Eigen::Index n = x.cols();
  phi.resize(n), liquidVelocity.resize(3, n);
  if (n == 0) return;
  liquid.phi(x, phi);
  liquid.velocity(x, liquidVelocity);
  requireFinite(phi.transpose(), "phi", x), requireFinite(liquidVelocity, "velocity", x);
}

void Surroundings::sampleSolids(const LiquidSampler& liquid, Points x) {
  const Eigen::Index n = x.cols();
  psi.resize(n), gradPsi.resize(3, n), solidVelocity.resize(3, n), solid.resize(n);
  if (n == 0) return;
  liquid.psi(x, psi);
  liquid.gradPsi(x, gradPsi);
  liquid.solidVelocity(x, solidVelocity);
  liquid.solidIndex(x, solid);
  requireFinite(psi.transpose(), "psi", x), requireFinite(gradPsi, "gradPsi", x);
  requireFinite(solidVelocity, "solidVelocity", x);
}

}  // namespace spume::foam
