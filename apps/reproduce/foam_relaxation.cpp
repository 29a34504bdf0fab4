#include "apps/reproduce/foam_relaxation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/reproduce/foam_bench.h"
#include "foam/errors.h"
#include "foam/forces/inertia.h"

namespace spume::apps {
namespace {

using Eigen::Vector3d;

/// Time in sqrt(mass / stiffness) of a ball of radius 1. What an image does to a ball is known from the
/// step's start only, as in an explicit step: ten springs on a ball turn in 1/4 to 1/3, and this is half of
/// where they would grow. Damping is that of the slowest modes a few hundredths beyond jamming.
constexpr double kStep = 0.6, kDamping = 0.05;
constexpr int kMaxSteps = 20000;
/// Mass of an image over that of its ball. Within a step it moves by kStep^2 over this times a push, which is
/// to stay below what is at rest.
constexpr double kHeavy = 1e7;

/// Weightless bubbles in the air that push each other as those of a packing do; springs and a little air
/// drag are all there is.
foam::FoamParams tangentBubbles() {
  foam::FoamParams params = foam::makePreset(foam::Preset::paper);
  params.gravity.setZero();
  params.density = 1, params.gasDensity = 0;
  params.wetnessLaw = foam::WetnessLaw::constant, params.wetness = params.wetnessAloft = 1;
  params.springFromSurfaceTension = false, params.springStiffness = SoftPacking::kStiffness;
  params.attractionLaw = foam::AttractionLaw::none, params.contactDamping = 0;
  params.airDragLaw = foam::AirDragLaw::coefficient;
  params.volumeMode = foam::VolumeMode::relax, params.volumeRate = 0;
  params.bursting = false, params.solverTolerance = 1e-8;
  return params;
}

/// The balls of a packing as bubbles, and in each step images of them beside the box.
class PeriodicFoam {
 public:
  explicit PeriodicFoam(const SoftPacking& packing) : packing_(packing), balls_(packing.position().size()) {
    for (std::size_t i = 0; i < balls_; ++i) {
      largest_ = std::max(largest_, packing.radius(i));
      bubbles_.add(
          {.position = packing.position()[i], .radius = packing.radius(i), .type = foam::BubbleClass::air});
    }
  }
  void step(foam::FoamSolver& solver, double dt) {
    placeImages();
    solver.step(bubbles_, space_, dt);
    std::vector<std::uint8_t> isImage(bubbles_.size(), 1);
    std::fill_n(isImage.begin(), balls_, 0);
    bubbles_.remove(isImage);
  }
  const std::vector<Vector3d>& position() const { return bubbles_.position; }

 private:
  void placeImages() {
    const double edge = packing_.edge(), margin = 2 * largest_;
    for (Vector3d& x : bubbles_.position)
      for (int axis = 0; axis < packing_.dimensions(); ++axis) x[axis] -= edge * std::floor(x[axis] / edge);
    for (int axis = 0; axis < packing_.dimensions(); ++axis)
      for (std::size_t k = 0, soFar = bubbles_.size(); k < soFar; ++k)
        for (const double side : {-edge, edge})
          if (const double x = bubbles_.position[k][axis] + side; x > -margin && x < edge + margin)
            addImage(k, side * Vector3d::Unit(axis));
  }
  void addImage(std::size_t of, const Vector3d& shift) {
    bubbles_.add({.position = bubbles_.position[of] + shift,
                  .velocity = bubbles_.velocity[of],
                  .radius = bubbles_.radius[of],
                  .type = foam::BubbleClass::air});
    bubbles_.gas.back() = (of < balls_ ? kHeavy : 1) * bubbles_.gas[of];
  }

  const SoftPacking& packing_;
  std::size_t balls_;
  double largest_ = 0;  ///< radius
  foam::BubbleStore bubbles_;
  foam::StillPool space_ = emptySpace();
};

}  // namespace

bool relaxAsFoam(SoftPacking& packing) {
  if (packing.holdsAreas())
    throw foam::InvalidParameter("relaxAsFoam: a foam of balls holds no areas; give it a packing without");
  foam::FoamParams params = tangentBubbles();
  const double mass = foam::inertia(params, 4 * std::numbers::pi / 3, params.wetness, 0),
               time = std::sqrt(mass / SoftPacking::kStiffness);
  params.airDragCoefficient = kDamping * mass / time;
  foam::FoamSolver solver(params);
  PeriodicFoam foam(packing);
  for (int step = 0; step < kMaxSteps && !packing.isAtRest(); ++step) {
    foam.step(solver, kStep * time);
    packing.moveTo(foam.position());
  }
  return packing.isAtRest();
}

}  // namespace spume::apps
