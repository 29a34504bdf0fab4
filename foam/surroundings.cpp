#include "foam/surroundings.h"

#include <functional>
#include <string>

#include "foam/errors.h"
#include "foam/parallel.h"

namespace spume::foam {
namespace {

template <typename Field>
void requireFinite(const Field& field, const char* name) {
  const auto isFinite = [&](std::size_t i) { return field.col(static_cast<Eigen::Index>(i)).allFinite(); };
  if (!reduceIndices(static_cast<std::size_t>(field.cols()), true, isFinite, std::logical_and<>()))
    throw NumericalFailure(std::string("the liquid sampler returned a ") + name + " that is not finite");
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
  requireFinite(gradPhi, "gradPhi"), requireFinite(gradPressure, "gradPressure");
}

void Surroundings::sampleFlow(const LiquidSampler& liquid, Points x) {
  const Eigen::Index n = x.cols();
  phi.resize(n), liquidVelocity.resize(3, n);
  if (n == 0) return;
  liquid.phi(x, phi);
  liquid.velocity(x, liquidVelocity);
  requireFinite(phi.transpose(), "phi"), requireFinite(liquidVelocity, "velocity");
}

void Surroundings::sampleSolids(const LiquidSampler& liquid, Points x) {
  const Eigen::Index n = x.cols();
  psi.resize(n), gradPsi.resize(3, n), solidVelocity.resize(3, n), solid.resize(n);
  if (n == 0) return;
  liquid.psi(x, psi);
  liquid.gradPsi(x, gradPsi);
  liquid.solidVelocity(x, solidVelocity);
  liquid.solidIndex(x, solid);
  requireFinite(psi.transpose(), "psi"), requireFinite(gradPsi, "gradPsi"),
      requireFinite(solidVelocity, "solidVelocity");
}

}  // namespace spume::foam
