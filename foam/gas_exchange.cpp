#include "foam/gas_exchange.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foam/forces/buoyancy.h"
#include "foam/parallel.h"
#include "foam/volume_correction.h"

namespace spume::foam {
namespace {

constexpr double kGasConstant = 8.314462618;  // [J/(mol K)]

/// dr/dt of a bubble against sqrt(t), and what it depends on.
class BubbleGrowth {
 public:
  BubbleGrowth(const DissolvedGasParams& params, double concentration, double slip)
      : params_(params), concentration_(concentration), slip_(slip) {}

  /// d(r^2)/d(sqrt t): 2 r dr/dt 2 sqrt(t), smooth down to t = 0.
  double slope(double r2, double rootTime) const {
    const double r = std::sqrt(std::max(r2, kSmallestBubble * kSmallestBubble));
    const double still = rootTime + r / std::sqrt(std::numbers::pi * params_.diffusivity);
    const double rising = 0.5 * sherwood(r) * rootTime;
    return 4 * params_.diffusivity * excess(r) / params_.molesPerVolume() * std::max(still, rising);
  }

 private:
  /// Concentration above what the bubble's own pressure keeps in solution [mol/m^3].
  double excess(double r) const {
    return concentration_ - params_.henry * (params_.pressure + 2 * params_.surfaceTension / r);
  }
  double sherwood(double r) const { return 1 + std::cbrt(1 + 2 * r * slip_ / params_.diffusivity); }

  const DissolvedGasParams& params_;
  double concentration_, slip_;
};

}  // namespace

double DissolvedGasParams::molesPerVolume() const { return pressure / (kGasConstant * temperature); }

double exchangedRadius(const DissolvedGasParams& params, double concentration, double radius, double age,
                       double slip, double dt) {
  const BubbleGrowth growth(params, concentration, slip);
  const double from = std::sqrt(std::max(age, 0.0)), step = std::sqrt(std::max(age, 0.0) + dt) - from;
  const double r2 = radius * radius;
  const double k1 = growth.slope(r2, from), k2 = growth.slope(r2 + 0.5 * step * k1, from + 0.5 * step);
  const double k3 = growth.slope(r2 + 0.5 * step * k2, from + 0.5 * step);
  const double k4 = growth.slope(r2 + step * k3, from + step);
  const double end = r2 + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  return end > kSmallestBubble * kSmallestBubble ? std::sqrt(end) : 0;
}

double exchangeGas(const DissolvedGasParams& params, double concentration, const Surroundings& around,
                   double dt, Radius radius, BubbleStore& bubbles, std::vector<std::uint8_t>& dissolved) {
  const std::size_t n = bubbles.size();
  dissolved.assign(n, 0);
  std::vector<double> taken(n, 0.0);
  forEachIndex(n, [&](std::size_t i) {
    const double immersed = immersedFraction(around.phi[i], bubbles.radius[i]);
    if (immersed <= 0) return;
    const double before = gasRadius(bubbles.gas[i]);
    const double slip = (bubbles.velocity[i] - around.liquidVelocity.col(i)).norm();
    const double after = exchangedRadius(params, concentration, before, bubbles.age[i], slip, dt);
    const double share = 1 + immersed * (std::pow(after / before, 3) - 1);
    if (share * std::pow(before, 3) <= std::pow(kSmallestBubble, 3)) {
      dissolved[i] = 1;
      return;
    }
    taken[i] = (share - 1) * bubbles.gas[i];
    bubbles.gas[i] *= share;
    if (radius == Radius::follows) bubbles.radius[i] *= std::cbrt(share);
  });
  double sum = 0;
  for (const double gas : taken) sum += gas;
  return sum;
}

}  // namespace spume::foam
