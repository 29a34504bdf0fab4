#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/entrainment.h"

namespace spume::coupling {
namespace {

/// Round-off of a sum of a few thousand payments, relative to the sum.
constexpr double kRoundOff = 1e-12;

double ball(double r) { return 4.0 / 3.0 * std::numbers::pi * r * r * r; }

std::vector<fluid::EscapedMarker> leavers(int n, double gas, double speed) {
  std::vector<fluid::EscapedMarker> markers;
  for (int i = 0; i < n; ++i)
    markers.push_back({{0.001 * (i % 40), 0.01, 0.0005 * (i % 17)}, {0, -1, 0}, gas, speed});
  return markers;
}

double gasOf(const std::vector<Birth>& births) {
  double sum = 0;
  for (const Birth& b : births) sum += ball(b.bubble.radius);
  return sum;
}

TEST(Entrainment, GasOfLeaversEqualsBubblesPlusReservoirs) {
  const EntrainmentSpec spec = EntrainmentSpec{};
  const double dx = 2.5e-3;
  const Entrainment entrainment(spec, dx, 7);
  Reservoirs reservoirs;
  GasLedger ledger;
  double born = 0;
  for (int step = 0; step < 20; ++step)
    born += gasOf(entrainment.step(leavers(300, 1e-9, 1.01 * spec.onset), {}, reservoirs, ledger));
  const double paid = 20 * 300 * 1e-9 * spec.length / dx;
  EXPECT_NEAR(ledger.bornMarkers, paid, kRoundOff * paid);
  EXPECT_NEAR(born + ledger.inReservoirs, paid, kRoundOff * paid);
}

TEST(Entrainment, SlowLeaversAreBookedAndGiveNoBubble) {
  const Entrainment entrainment(EntrainmentSpec{}, 2.5e-3, 7);
  Reservoirs reservoirs;
  GasLedger ledger;
  EXPECT_TRUE(
      entrainment.step(leavers(1000, 1e-8, 0.99 * EntrainmentSpec{}.onset), {}, reservoirs, ledger).empty());
  EXPECT_EQ(ledger.bornMarkers, 0);
  const double lost = 1000 * 1e-8 * 3.6e-3 / 2.5e-3;
  EXPECT_NEAR(ledger.notEntrained, lost, kRoundOff * lost);
}

TEST(Entrainment, CountDoesNotDependOnHowTheGasIsSplit) {
  // The same gas at the same place through few heavy and many light markers pays the very same radii.
  const Entrainment entrainment(EntrainmentSpec{}, 2.5e-3, 7);
  Reservoirs heavyBlocks, lightBlocks;
  GasLedger heavyLedger, lightLedger;
  const std::vector<fluid::EscapedMarker> heavy(64, {{0.01, 0.01, 0.01}, {0, 0, 0}, 0x1p-28, 2.0});
  const std::vector<fluid::EscapedMarker> light(1024, {{0.01, 0.01, 0.01}, {0, 0, 0}, 0x1p-32, 2.0});
  const auto few = entrainment.step(heavy, {}, heavyBlocks, heavyLedger);
  const auto many = entrainment.step(light, {}, lightBlocks, lightLedger);
  ASSERT_EQ(few.size(), many.size());
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i].bubble.radius, many[i].bubble.radius);
}

TEST(Entrainment, RadiiFollowTheCutLognormal) {
  EntrainmentSpec spec;
  const Entrainment entrainment(spec, 2.5e-3, 3);
  const int n = 20000;
  std::vector<double> radii(n);
  for (int i = 0; i < n; ++i) radii[i] = entrainment.drawRadius({1, 2, 3}, i);
  std::sort(radii.begin(), radii.end());
  EXPECT_GE(radii.front(), spec.minRadius);
  EXPECT_LE(radii.back(), spec.maxRadius);
  // Kolmogorov-Smirnov against the cut lognormal; 1.95 / sqrt(n) is its 0.1 % critical value.
  const auto phi = [&](double r) {
    return 0.5 * std::erfc(-std::log(r / spec.medianRadius) / (spec.sigma * std::numbers::sqrt2));
  };
  const double low = phi(spec.minRadius), span = phi(spec.maxRadius) - low;
  double distance = 0;
  for (int i = 0; i < n; ++i)
    distance = std::max(distance, std::abs((phi(radii[i]) - low) / span - (i + 0.5) / n));
  EXPECT_LT(distance, 1.95 / std::sqrt(n));
}

TEST(Entrainment, PocketsPayTheirGasUnderTheirOwnCause) {
  const Entrainment entrainment(EntrainmentSpec{}, 3.6e-3, 3);  // L_e = dx: no scaling
  Reservoirs reservoirs;
  GasLedger ledger;
  const double gas = 5e-8;
  const auto births =
      entrainment.step({}, {{{0.02, 0.03, 0.01}, {0, 0, 0}, gas, 3, 1.2}}, reservoirs, ledger);
  EXPECT_NEAR(gasOf(births) + ledger.inReservoirs, gas, kRoundOff * gas);
  EXPECT_NEAR(ledger.bornPockets, gas, kRoundOff * gas);
  ASSERT_FALSE(births.empty());
  EXPECT_EQ(births.front().cause, BirthCause::pocket);
}

}  // namespace
}  // namespace spume::coupling
