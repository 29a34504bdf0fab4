#include "apps/reproduce/soft_packing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "foam/counter_random.h"
#include "foam/errors.h"
#include "foam/forces/strong_spring.h"

namespace spume::apps {
namespace {

using Eigen::Vector3d;

/// How far balls may go before their images are placed anew.
constexpr double kRoam = 0.3;

/// FIRE [Bitzek 2006, Table 1]; time in sqrt(mass / stiffness). A ball is held by about ten springs, so the
/// fastest mode turns in 1/4: the longest step is half of where it would grow.
constexpr double kFirstStep = 0.05, kLongestStep = 0.3, kGrow = 1.1, kShrink = 0.5, kMix = 0.1,
                 kMixShrink = 0.99;
constexpr int kPatience = 5, kMaxSteps = 100000;
/// Mean push below which balls do not touch: a fraction of 1e-6 from where they begin to.
constexpr double kNothing = 1e-6;

constexpr int kMaxRounds = 50;  ///< of Newton's method, which takes two or three from a step to the next

}  // namespace

SoftPacking::SoftPacking(const SoftPackingParams& params) : params_(params) {
  for (int i = 0; i < params.count; ++i) {
    foam::CounterRandom random(params.seed, static_cast<std::uint64_t>(i), 6);
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    position_.emplace_back(x, y, params.dimensions == 3 ? z : 0);
    radius_.push_back(i % 2 ? params.ratio : 1);
    ballVolume_ += params.dimensions == 3 ? 4 * std::numbers::pi / 3 * std::pow(radius_[i], 3)
                                          : std::numbers::pi * std::pow(radius_[i], 2);
  }
  setFraction(params.fraction);
}

double SoftPacking::fraction() const { return ballVolume_ / std::pow(edge_, params_.dimensions); }

void SoftPacking::setFraction(double fraction) {
  const double edge = std::pow(ballVolume_ / fraction, 1.0 / params_.dimensions);
  for (Vector3d& x : position_) x *= edge / edge_;
  edge_ = edge;
  imaged_.clear();
  findForces();
}

double SoftPacking::largestRadius() const {
  return *std::max_element(radius_.begin(), radius_.begin() + static_cast<std::ptrdiff_t>(position_.size()));
}

void SoftPacking::addImagesAlong(int axis) {
  const double swell = cells_ ? kRoam : 0;  // of radii, before images are placed anew
  const double margin = 2 * (imagedRadius_ + swell) + 2 * kRoam;
  const std::size_t soFar = placed_.size();
  for (std::size_t k = 0; k < soFar; ++k)
    for (const double side : {-edge_, edge_}) {
      const double x = placed_[k][axis] + side;
      if (x < -margin || x > edge_ + margin) continue;
      placed_.push_back(placed_[k] + side * Vector3d::Unit(axis));
      shift_.push_back(shift_[k] + side * Vector3d::Unit(axis));
      radius_.push_back(radius_[k]), ball_.push_back(ball_[k]);
    }
}

void SoftPacking::placeImages() {
  const std::size_t balls = position_.size();
  for (Vector3d& x : position_)
    for (int axis = 0; axis < params_.dimensions; ++axis) x[axis] -= edge_ * std::floor(x[axis] / edge_);
  imaged_ = placed_ = position_;
  imagedRadius_ = largestRadius();
  shift_.assign(balls, Vector3d::Zero());
  radius_.resize(balls), ball_.resize(balls);
  for (std::size_t i = 0; i < balls; ++i) ball_[i] = static_cast<std::int32_t>(i);
  for (int axis = 0; axis < params_.dimensions; ++axis) addImagesAlong(axis);
}

bool SoftPacking::imagesSuffice() const {
  if (imaged_.size() != position_.size()) return false;
  for (std::size_t i = 0; i < imaged_.size(); ++i)
    if ((position_[i] - imaged_[i]).squaredNorm() > kRoam * kRoam) return false;
  return !cells_ || largestRadius() < imagedRadius_ + kRoam;
}

void SoftPacking::findOverlaps() {
  if (imagesSuffice())
    for (std::size_t k = 0; k < placed_.size(); ++k) placed_[k] = position_[ball_[k]] + shift_[k];
  else
    placeImages();
  near_.update(placed_, radius_);
  overlaps_.clear();
  const auto balls = static_cast<std::int32_t>(position_.size());
  for (std::int32_t i = 0; i < balls; ++i) {
    const std::int32_t rank = near_.rank()[i];
    for (std::int32_t slot = near_.rowStart()[rank]; slot < near_.rowStart()[rank + 1]; ++slot) {
      const std::int32_t j = near_.order()[near_.candidate()[slot]];
      const Vector3d apart = placed_[i] - placed_[j];
      const double distance = apart.norm();
      if (distance == 0 || distance >= radius_[i] + radius_[j]) continue;
      overlaps_.push_back({i, ball_[j], apart, distance});
    }
  }
}

void SoftPacking::fillCells() {
  cells_->measure(overlaps_, radius_);
  for (int round = 0; round < kMaxRounds && cells_->worst() > kAreaOff; ++round) {
    cells_->improve(radius_);
    for (std::size_t k = 0; k < radius_.size(); ++k) radius_[k] = radius_[ball_[k]];
    findOverlaps();
    cells_->measure(overlaps_, radius_);
  }
}

void SoftPacking::findForces() {
  findOverlaps();
  if (cells_) fillCells();
  contacts_.clear();
  force_.assign(position_.size(), Vector3d::Zero());
  for (std::size_t k = 0; k < overlaps_.size(); ++k) {
    const auto& [i, j, apart, distance] = overlaps_[k];
    const foam::PairSpring spring = foam::strongSpring(kStiffness, radius_[i], radius_[j], 1, distance, 0);
    force_[i] -= spring.tension / distance * apart;
    const bool film = !cells_ || cells_->edge(k) > 0;
    if (i < j) contacts_.push_back({i, j, -spring.tension, distance, -apart / distance, film});
  }
}

void SoftPacking::holdAreas() {
  if (params_.dimensions != 2)
    throw foam::InvalidParameter("SoftPackingParams.dimensions = " + std::to_string(params_.dimensions) +
                                 ": only discs hold areas, take 2");
  if (cells_) return;
  std::vector<double> area;
  for (std::size_t i = 0; i < position_.size(); ++i)
    area.push_back(std::numbers::pi * radius_[i] * radius_[i]);
  cells_.emplace(area);
  imaged_.clear();
  findForces();
}

double SoftPacking::meanPush() const {
  double mean = 0;
  for (const Contact& c : contacts_) mean += c.push / static_cast<double>(contacts_.size());
  return mean;
}

double SoftPacking::largestForce() const {
  double largest = 0;
  for (const Vector3d& f : force_) largest = std::max(largest, f.norm());
  return largest;
}

double SoftPacking::unrest() const {
  const double mean = meanPush();
  return mean > 0 ? largestForce() / mean : 0;
}

bool SoftPacking::isAtRest() const {
  const double mean = meanPush();
  return worstArea() <= kAreaOff && (mean < kNothing || largestForce() < kAtRest * mean);
}

void SoftPacking::moveTo(const std::vector<Vector3d>& position) {
  position_ = position;
  findForces();
}

bool SoftPacking::relax() {
  velocity_.assign(position_.size(), Vector3d::Zero());
  double dt = kFirstStep, mix = kMix;
  int downhill = 0;
  for (int step = 0; step < kMaxSteps; ++step) {
    if (isAtRest()) return true;
    double power = 0, speed = 0, force = 0;
    for (std::size_t i = 0; i < position_.size(); ++i) {
      power += force_[i].dot(velocity_[i]);
      speed += velocity_[i].squaredNorm(), force += force_[i].squaredNorm();
    }
    const double along = mix * std::sqrt(speed / force);
    if (power > 0 && ++downhill > kPatience) dt = std::min(kGrow * dt, kLongestStep), mix *= kMixShrink;
    if (power < 0) downhill = 0, dt *= kShrink, mix = kMix;
    for (std::size_t i = 0; i < position_.size(); ++i) {
      velocity_[i] = power < 0 ? Vector3d::Zero() : Vector3d((1 - mix) * velocity_[i] + along * force_[i]);
      velocity_[i] += dt * force_[i];
      position_[i] += dt * velocity_[i];
    }
    findForces();
  }
  return false;
}

/// Flags balls with fewer contacts than dimensions + 1, those with such balls left out.
std::vector<std::uint8_t> SoftPacking::rattlers() const {
  std::vector<std::uint8_t> rattles(position_.size(), 0);
  std::vector<int> touched(position_.size());
  for (bool more = true; more;) {
    more = false;
    std::fill(touched.begin(), touched.end(), 0);
    for (const Contact& c : contacts_)
      if (c.film && !rattles[c.i] && !rattles[c.j]) ++touched[c.i], ++touched[c.j];
    for (std::size_t i = 0; i < position_.size(); ++i) {
      const bool loose = touched[i] <= params_.dimensions;
      more = more || (loose && !rattles[i]);
      rattles[i] = loose;
    }
  }
  return rattles;
}

std::vector<SoftPacking::Contact> SoftPacking::heldContacts() const {
  const std::vector<std::uint8_t> rattles = rattlers();
  std::vector<Contact> held;
  for (const Contact& c : contacts_)
    if (c.film && !rattles[c.i] && !rattles[c.j]) held.push_back(c);
  return held;
}

SoftPacking::Census SoftPacking::census() const {
  Census census;
  for (const Contact& c : contacts_)
    census.pressure += c.push * c.distance / (params_.dimensions * std::pow(edge_, params_.dimensions));
  const std::vector<std::uint8_t> rattles = rattlers();
  const auto held = static_cast<double>(std::count(rattles.begin(), rattles.end(), 0));
  census.held = held / static_cast<double>(position_.size());
  census.contacts = held > 0 ? 2 * static_cast<double>(heldContacts().size()) / held : 0;
  return census;
}

}  // namespace spume::apps
