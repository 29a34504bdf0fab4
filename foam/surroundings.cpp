#include "foam/surroundings.h"

#include "foam/errors.h"
#include "foam/failure_text.h"

namespace spume::foam {
namespace {

/// `field` has a row or column a point.
template <typename Field>
void requireFinite(const Field& field, const char* name, Points x) {
  if (field.allFinite()) return;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const auto value = field.reshaped(field.size() / x.cols(), x.cols()).col(i);
    if (!value.allFinite())
      throw NumericalFailure(joined("foam: the liquid sampler returned ", name, " = ", value.transpose(),
                                    ", not finite, at ", textOf(x.col(i)), " m"));
  }
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
  requireFinite(phi, "phi", x), requireFinite(liquidVelocity, "velocity", x);
}

void Surroundings::sampleSolids(const LiquidSampler& liquid, Points x) {
  const Eigen::Index n = x.cols();
  psi.resize(n), gradPsi.resize(3, n), solidVelocity.resize(3, n), solid.resize(n);
  if (n == 0) return;
  liquid.psi(x, psi);
  liquid.gradPsi(x, gradPsi);
  liquid.solidVelocity(x, solidVelocity);
  liquid.solidIndex(x, solid);
  requireFinite(psi, "psi", x), requireFinite(gradPsi, "gradPsi", x);
  requireFinite(solidVelocity, "solidVelocity", x);
}

}  // namespace spume::foam
