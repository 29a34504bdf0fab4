#include <algorithm>
#include <cmath>

#include "coupling/domain_box.h"
#include "coupling/scene_builder.h"
#include "coupling/scene_lint.h"
#include "coupling/scene_volumes.h"
#include "foam/volume_correction.h"

namespace spume::coupling {
namespace {

// Figures of the cost estimate, two cores.
constexpr double kSecondsPerCell = 4e-7;                  // of a liquid sub-step, per cell: 0.1 s at 64^3
constexpr double kSecondsPerBubble = 4e-6;                // of a foam step
constexpr double kPouredBubbles = 4000;                   // alive in a steady pour of the size of a glass
constexpr double kBytesPerCell = 400;                     // fields, their copies, pressure levels
constexpr double kBytesPerMarker = 25;                    // a column of MarkerSet each
constexpr double kSurfaceCellsFactor = 4;                 // area of a pouring surface over the floor's
constexpr double kCachedBytesPerWetCell = 11;             // vel, compressed, plus the band of `surface`
constexpr double kPictureBytesPerPixel = 1.5;             // of a PNG
constexpr double kPlyBytes = 52, kVdbPointBytes = 60;     // a bubble
constexpr double kFilmBytes = 4600, kFilmSeconds = 5e-4;  // a bubble's films, of a froth

/// Bubbles that sources and sites will have made by time t, none of them gone [-].
double suppliedBubbles(const Scene& scene, double t) {
  double sum = 0;
  for (const BubbleSourceSpec& source : scene.bubbleSources) {
    const double end = std::max(source.start, std::min(source.stop, t));
    const double middle = 0.5 * (source.radius.least + source.radius.most);
    sum += source.measure == SourceMeasure::number
               ? source.rate.integral(source.start, end)
               : source.gasRate.integral(source.start, end) / foam::ballVolume(middle);
  }
  return sum;
}

/// Fastest the scene can get [m/s]: a jet, or a fall through the domain.
double fastest(const Scene& scene) {
  double jet = 0;
  for (const InflowSpec& inflow : scene.inflows) jet = std::max(jet, inflow.speed.largest());
  const double fall = scene.liquid.gravity.norm() * scene.domain.size.maxCoeff();  // 2 g h, half the height
  return scene.inflows.empty() ? std::sqrt(fall) : std::sqrt(jet * jet + fall);
}

}  // namespace

CostEstimate estimateCost(const Scene& scene) {
  CostEstimate cost;
  const fluid::GridSpec grid = gridOf(scene);
  const double end = scene.time.frames / scene.time.fps, frame = 1 / scene.time.fps;
  cost.cells = grid.cells.cast<long>().prod();
  const double room = DomainBox(scene).volume();
  cost.liquidVolume = std::min(initialWetShare(scene) * room + pouredUntil(scene, end), room);
  const double subStep = scene.liquid.cfl * scene.dx() / fastest(scene);
  const double step = std::clamp(subStep * scene.time.maxSubSteps, scene.time.minDt, scene.time.maxDt);
  cost.stepsPerFrame = static_cast<int>(std::ceil(frame / step));
  const double subSteps = std::max<double>(cost.stepsPerFrame, std::ceil(frame / subStep));
  const double bubbles = static_cast<double>(scene.bubbles.size()) + suppliedBubbles(scene, end) +
                         (scene.coupling.entrainment.enabled && !scene.inflows.empty() ? kPouredBubbles : 0);
  const double liquidSteps = scene.solvesLiquid() ? subSteps : 0;
  cost.secondsPerFrame = liquidSteps * kSecondsPerCell * static_cast<double>(cost.cells) +
                         cost.stepsPerFrame * kSecondsPerBubble * bubbles;
  const double surfaceCells = kSurfaceCellsFactor * grid.cells.x() * grid.cells.z();
  const double markers = 2 * scene.liquid.markerBand * scene.liquid.markersPerCell * surfaceCells;
  cost.memoryBytes = kBytesPerCell * static_cast<double>(cost.cells) + kBytesPerMarker * markers;
  const double cached = std::ceil(static_cast<double>(scene.time.frames) / scene.output.every);
  const double wetCells = cost.liquidVolume / grid.cellVolume() + surfaceCells;
  cost.diskBytes = cached * ((scene.output.liquid ? kCachedBytesPerWetCell * wetCells : 0) +
                             bubbles * ((scene.output.bubblesPly ? kPlyBytes : 0) +
                                        (scene.output.bubblesVdb ? kVdbPointBytes : 0) +
                                        (scene.output.films ? kFilmBytes : 0)));
  if (scene.output.films) cost.secondsPerFrame += kFilmSeconds * bubbles / scene.output.every;
  if (scene.output.preview)
    cost.diskBytes +=
        scene.time.frames * kPictureBytesPerPixel * scene.output.previewSize.cast<double>().prod();
  return cost;
}

}  // namespace spume::coupling
