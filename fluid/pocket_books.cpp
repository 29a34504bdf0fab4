#include "fluid/pocket_books.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "fluid/disjoint_sets.h"
#include "fluid/errors.h"

namespace spume::fluid {
namespace {

// Relative error below which a pocket is left alone, as for bodies of liquid: what float phi cannot resolve.
constexpr double kGasDeadband = 4e-9;
// Largest error that can be drift. In one sub-step the surface errs by far less; more means that a pocket
// opened in between, and its gas is what it holds now.
constexpr double kLargestDrift = 0.1;

}  // namespace

void PocketBooks::resume(const AirPockets& pockets, std::vector<double> gas) {
  if (gas.size() != pockets.pockets().size())
    throw InvalidParameter("books of " + std::to_string(gas.size()) + " air pockets for " +
                           std::to_string(pockets.pockets().size()) + ": they belong to another state");
  gas_ = std::move(gas);
  remember(pockets);
}

void PocketBooks::remember(const AirPockets& pockets) {
  const bool any = !pockets.pockets().empty();
  if (any || labelled_) lastLabel_ = pockets.label();
  labelled_ = any;
}

/// Which old pockets the cells of each new one came from; none for a pocket most of whose cells were liquid
/// or open air.
PocketBooks::Links PocketBooks::trace(const AirPockets& pockets, const MacVelocity& velocity,
                                      double dt) const {
  const double steps = 0.5 * dt / grid_.dx;
  const Eigen::Vector3i last = grid_.cells - Eigen::Vector3i::Ones();
  Links links;
  for (std::size_t n = 0; n < pockets.pockets().size(); ++n) {
    const std::size_t first = links.size();
    const std::vector<Eigen::Vector3i>& cells = pockets.pockets()[n].cells;
    for (const Eigen::Vector3i& c : cells) {
      Eigen::Vector3d move;
      for (int a = 0; a < 3; ++a)
        move[a] = steps * (velocity[a](c) + velocity[a](c + Eigen::Vector3i::Unit(a)));
      const Eigen::Vector3i from = c - move.array().round().matrix().cast<int>();
      const std::int32_t old = lastLabel_(from.cwiseMax(0).cwiseMin(last));
      if (old >= 0) links.emplace_back(static_cast<std::int32_t>(n), old);
    }
    if (2 * (links.size() - first) < cells.size()) links.resize(first);
  }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

std::vector<double> PocketBooks::deal(const AirPockets& pockets, const Links& links) const {
  const std::size_t now = pockets.pockets().size();
  DisjointSets groups(now + gas_.size());
  std::vector<char> linked(now + gas_.size(), 0);
  for (const auto& [to, from] : links) {
    groups.unite(to, now + from);
    linked[to] = linked[now + from] = 1;
  }
  std::vector<double> booked(now + gas_.size(), 0), held(now + gas_.size(), 0);
  for (std::size_t n = 0; n < now; ++n) held[groups.of(n)] += pockets.pockets()[n].gas;
  for (std::size_t n = 0; n < gas_.size(); ++n)
    if (linked[now + n]) booked[groups.of(now + n)] += gas_[n];
  std::vector<double> gas(now);
  for (std::size_t n = 0; n < now; ++n) {
    const double mine = pockets.pockets()[n].gas, all = held[groups.of(n)];
    const double error = all > 0 ? booked[groups.of(n)] / all - 1 : 0;
    gas[n] = linked[n] && std::abs(error) <= kLargestDrift ? mine * (1 + error) : mine;
  }
  return gas;
}

void PocketBooks::update(const AirPockets& pockets, const MacVelocity& velocity, double dt) {
  gas_ = deal(pockets, labelled_ ? trace(pockets, velocity, dt) : Links{});
  remember(pockets);
}

std::vector<double> PocketBooks::growth(const AirPockets& pockets, double dt) const {
  std::vector<double> rate(gas_.size(), 0);
  const double relax = -std::expm1(-dt / relaxationTime_) / dt;
  for (std::size_t n = 0; n < rate.size(); ++n) {
    const double error = gas_[n] - pockets.pockets()[n].gas;
    if (std::abs(error) > kGasDeadband * gas_[n]) rate[n] = relax * error;
  }
  return rate;
}

}  // namespace spume::fluid
