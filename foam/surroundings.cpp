#include "foam/surroundings.h"

#include <string>

#include "foam/errors.h"

namespace spume::foam {
namespace {

template <typename Field>
void requireFinite(const Field& field, const char* name) {
  if (!field.allFinite())
    throw NumericalFailure(std::string("the liquid sampler returned a ") + name + " that is not finite");
}

}  // namespace

void Surroundings::sample(const LiquidSampler& liquid, Points x) {
  const Eigen::Index n = x.cols();
  phi.resize(n), psi.resize(n), solid.resize(n);
  for (auto* field : {&gradPhi, &liquidVelocity, &gradPressure, &gradPsi, &solidVelocity})
    field->resize(3, n);
  if (n == 0) return;
  liquid.phi(x, phi);
  liquid.gradPhi(x, gradPhi);
  liquid.velocity(x, liquidVelocity);
  liquid.gradPressure(x, gradPressure);
  liquid.psi(x, psi);
  liquid.gradPsi(x, gradPsi);
  liquid.solidVelocity(x, solidVelocity);
  liquid.solidIndex(x, solid);
  requireFinite(phi, "phi"), requireFinite(gradPhi, "gradPhi"), requireFinite(psi, "psi");
  requireFinite(liquidVelocity, "velocity"), requireFinite(gradPressure, "gradPressure");
  requireFinite(gradPsi, "gradPsi"), requireFinite(solidVelocity, "solidVelocity");
}

}  // namespace spume::foam
