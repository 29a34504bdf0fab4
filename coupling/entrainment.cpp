#include "coupling/entrainment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foam/counter_random.h"
#include "foam/volume_correction.h"

namespace spume::coupling {
namespace {

/// Purposes of the random numbers drawn here, so that no two share a stream.
constexpr std::uint64_t kRadiusPurpose = 0x7261646975730001;
constexpr std::uint64_t kPlacePurpose = 0x706c616365000001;

/// A cut that leaves nothing of the distribution is refused by the scene; this only bounds the redraws.
constexpr int kMaxRedraws = 1000;

std::uint64_t blockKey(const BlockIndex& block) {
  const auto word = [](int v) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(v)); };
  return (word(block[0]) << 42) ^ (word(block[1]) << 21) ^ word(block[2]);
}

/// Standard normal by Box and Muller.
double normal(foam::CounterRandom& random) {
  const double radial = std::sqrt(-2 * std::log(1 - random.uniform()));
  return radial * std::cos(2 * std::numbers::pi * random.uniform());
}

}  // namespace

/// What a marker and a pocket have in common when they leave the set.
struct Entrainment::Leaver {
  Eigen::Vector3d position, velocity;
  double gas, speed, spread;
  BirthCause cause;
};

Entrainment::Entrainment(const EntrainmentSpec& spec, double dx, std::uint64_t seed)
    : spec_(spec), dx_(dx), seed_(seed) {}

double Entrainment::drawRadius(const BlockIndex& block, std::uint64_t draw) const {
  foam::CounterRandom random(seed_ ^ blockKey(block), draw, kRadiusPurpose);
  for (int i = 0; i < kMaxRedraws; ++i) {
    const double radius = spec_.medianRadius * std::exp(spec_.sigma * normal(random));
    if (radius >= spec_.minRadius && radius <= spec_.maxRadius) return radius;
  }
  return std::clamp(spec_.medianRadius, spec_.minRadius, spec_.maxRadius);
}

void Entrainment::payBubbles(const Leaver& leaver, const BlockIndex& block, Reservoir& reservoir,
                             std::vector<Birth>& births) const {
  for (;;) {
    const double radius = drawRadius(block, reservoir.draws);
    if (reservoir.gas < foam::ballVolume(radius)) return;
    // Several bubbles paid by one leaver must not start at one point.
    foam::CounterRandom random(seed_ ^ blockKey(block), reservoir.draws, kPlacePurpose);
    const Eigen::Vector3d offset(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    births.push_back(
        {{leaver.position + leaver.spread * offset, leaver.velocity, radius, foam::BubbleClass::liquid},
         leaver.cause});
    reservoir.gas -= foam::ballVolume(radius);
    ++reservoir.draws;
  }
}

std::vector<Birth> Entrainment::step(const std::vector<fluid::EscapedMarker>& escaped,
                                     const std::vector<fluid::CollapsedPocket>& pockets,
                                     Reservoirs& reservoirs, GasLedger& ledger) const {
  // The captured film is as thick as a cell; L_e/dx makes it as thick as L_e at every resolution (rule 2).
  const double filmScale = spec_.length / dx_;
  std::vector<Birth> births;
  const auto pay = [&](const Leaver& leaver, double& born) {
    if (leaver.speed < spec_.onset) {
      ledger.notEntrained += leaver.gas;
      return;
    }
    const Eigen::Array3d cell = (leaver.position / spec_.blockSize).array().floor();
    const BlockIndex block{static_cast<int>(cell.x()), static_cast<int>(cell.y()),
                           static_cast<int>(cell.z())};
    Reservoir& reservoir = reservoirs[block];
    reservoir.gas += leaver.gas;
    born += leaver.gas;
    payBubbles(leaver, block, reservoir, births);
  };
  for (const auto& marker : escaped)
    pay({marker.position, marker.velocity, marker.gas * filmScale, marker.speed, 0.5 * dx_,
         BirthCause::marker},
        ledger.bornMarkers);
  for (const auto& pocket : pockets)
    pay({pocket.position, pocket.velocity, pocket.gas * filmScale, pocket.speed, dx_, BirthCause::pocket},
        ledger.bornPockets);
  ledger.inReservoirs = 0;
  for (const auto& [block, reservoir] : reservoirs) ledger.inReservoirs += reservoir.gas;
  return births;
}

}  // namespace spume::coupling
