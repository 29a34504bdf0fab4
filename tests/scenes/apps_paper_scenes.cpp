// The paper's scenes, coarse: fewer and larger bubbles, larger cells, a second or two. Pouring has files of
// its own.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "apps/reproduce/foam_metrics.h"
#include "coupling/liquid_part.h"
#include "coupling/scene_toml.h"
#include "coupling/simulation.h"
#include "foam/power_cells.h"

namespace spume::apps {
namespace {

using coupling::Overrides;
using coupling::Simulation;
using coupling::StepReport;

/// Books are kept in double: a few thousand sums of equal sign.
constexpr double kLedger = 1e-12;

coupling::Scene paperScene(const std::string& name, const Overrides& coarser) {
  return coupling::readScene(std::string(SPUME_SOURCE_DIR) + "/data/scenes/" + name + ".toml", coarser);
}

/// A scene run for some frames, watched after every step.
class Watched {
 public:
  Watched(const coupling::Scene& scene, int frames) : simulation(scene) {
    for (int frame = 0; frame < frames; ++frame)
      simulation.advanceFrame([this](const StepReport& report) { note(report); });
    const foam::BubbleStore& bubbles = simulation.bubbles();
    foam::PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, topology);
    const auto liquid = coupling::makeLiquid(scene, simulation.state().liquid);
    toSolids.resize(static_cast<Eigen::Index>(bubbles.size()));
    liquid->sampler()->psi(bubbles.positions(), toSolids);
  }

  /// Every bubble is accounted for, none is in a solid or has left, and the gas adds up.
  void expectSound() const {
    EXPECT_EQ(born - ended, simulation.bubbles().size());
    EXPECT_EQ(left, 0u);
    EXPECT_EQ(insideSolids(simulation.bubbles(), toSolids), 0u);
    EXPECT_LT(std::abs(last.gas.imbalance()), kLedger * last.gas.entered());
  }

  Simulation simulation;
  StepReport last;
  foam::FoamTopology topology;
  Eigen::VectorXd toSolids;
  std::size_t born = 0, ended = 0, left = 0;

 private:
  void note(const StepReport& report) {
    for (const coupling::Event& event : report.events) {
      using Kind = coupling::Event::Kind;
      born += event.kind == Kind::birth;
      ended += event.kind == Kind::burst || event.kind == Kind::merge || event.kind == Kind::kill ||
               event.kind == Kind::leave;
      left += event.kind == Kind::leave;
    }
    last = report;
  }
};

constexpr int kClusterFrames = 75, kClusterBubbles = 40;

Watched coarseCluster(const std::string& volumeRate) {
  return {paperScene("cluster", {{"bubble_source.0.rate", std::to_string(kClusterBubbles)},
                                 {"bubble_source.0.stop", "1"},
                                 {"foam.volume_rate", volumeRate}}),
          kClusterFrames};
}

TEST(CoarseCluster, IsOneBubbleThickAndHoldsItsVolumesOnlyWithCorrection) {
  constexpr double kHeld = 0.01, kLost = 0.25;  // issue aim; what the paper has with correction
  const Watched held = coarseCluster("60"), loose = coarseCluster("0");
  held.expectSound();
  EXPECT_NEAR(held.born, kClusterBubbles, 1);  // the first and the last fall on the ends of the second
  EXPECT_LT(held.last.foam.volumeErrorMax, kHeld);
  EXPECT_GT(loose.last.foam.volumeErrorMax, kLost);
  constexpr double kMiddle = 3e-3, kOff = 1e-6;  // plates 6 mm apart press from both sides alike [m]
  for (const Eigen::Vector3d& x : held.simulation.bubbles().position) EXPECT_NEAR(x.z(), kMiddle, kOff);
}

/// Share of a bubble's skin that is film, averaged over bubbles in contact between two heights [m].
double filmShare(const Watched& run, double lower, double upper) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < run.simulation.bubbles().size(); ++i) {
    const double y = run.simulation.bubbles().position[i].y(), films = run.topology.filmArea[i];
    if (films > 0 && y >= lower && y < upper) sum += films / (films + run.topology.freeArea[i]), ++count;
  }
  return sum / count;
}

TEST(CoarseSoap, PilesUpInLayersRounderAtTheWater) {
  constexpr int kFrames = 200;
  constexpr double kRate = 60, kSeconds = 5;
  // Bubbles twice as large as the scene's: an eighth of their number fills the same room.
  const Watched soap(paperScene("soap", {{"bubble_source.0.rate", std::to_string(kRate)},
                                         {"bubble_source.0.stop", std::to_string(kSeconds)},
                                         {"bubble_source.0.median_radius", "8e-3"},
                                         {"bubble_source.0.min_radius", "5e-3"},
                                         {"bubble_source.0.max_radius", "14e-3"},
                                         {"foam.bursting", "false"}}),
                     kFrames);
  soap.expectSound();
  EXPECT_NEAR(soap.born, kRate * kSeconds, 1);
  std::vector<double> layers;
  for (double x = 0.03; x < 0.14; x += 0.02)
    for (double z = 0.03; z < 0.14; z += 0.02)
      layers.push_back(layersAlong(soap.simulation.bubbles(), soap.topology, x, z));
  // 300 bubbles of 15 mm over 16 x 16 cm: 10 to 11 across, 113 a layer, packed 3 to 5 high.
  EXPECT_GE(medianOf(layers), 3);
  EXPECT_LE(medianOf(layers), 6);
  constexpr double kWater = 0.05, kBubble = 0.015;  // [m]
  EXPECT_GT(filmShare(soap, kWater + kBubble, kWater + 3 * kBubble), filmShare(soap, 0, kWater));
}

constexpr int kCokeFrames = 24;

/// Cells of 4.2 mm, a wall of nearly three of them, a tenth of the bubbles. The jet has a radius of two
/// cells: a thinner one splashes as the grid likes.
Watched coarseCoke(const std::string& name) {
  return {paperScene(name, {{"domain.resolution", "36"},
                            {"liquid.markers_per_cell", "16"},
                            {"solid.0.wall_thickness", "0.012"},
                            {"inflow.0.stop", "0.5"},
                            {"liquid_body.0.depth", "0.05"},
                            {"nucleation.0.density", "1e4"},
                            {"bubble_source.0.rate", "400"}}),
          kCokeFrames};
}

void expectPoured(const Watched& coke) {
  coke.expectSound();
  constexpr double kFlux = 0.4 * std::numbers::pi * 0.009 * 0.009, kOpen = 0.5;  // [m^3/s], [s]
  // The nozzle's own cells are filled once, and volume control follows the splash with a delay.
  constexpr double kNozzle = 0.15, kVolume = 0.02;
  EXPECT_NEAR(coke.last.poured, kFlux * kOpen, kNozzle * kFlux * kOpen);
  EXPECT_NEAR(coke.last.liquid.liquidVolume, coke.last.liquid.targetVolume,
              kVolume * coke.last.liquid.targetVolume);
  // Of the mug, the radius in the middle of its wall: centres of bubbles that cling lie on the inner one [m].
  constexpr double kRadius = 0.046, kRim = 0.1085, kAxis = 0.06;
  constexpr double kThrown = 0.01;  // share that the splash throws over the rim
  std::size_t outside = 0;
  for (const Eigen::Vector3d& x : coke.simulation.bubbles().position)
    outside += x.y() < kRim && std::hypot(x.x() - kAxis, x.z() - kAxis) > kRadius;
  EXPECT_LE(outside, kThrown * static_cast<double>(coke.born));
}

TEST(CoarseCoke, IsPouredIntoTheMugAndClingsToTheGlassUnlikePlastic) {
  const Watched coke = coarseCoke("coke"), plastic = coarseCoke("coke_plastic");
  expectPoured(coke);
  expectPoured(plastic);
  constexpr double kFizz = 400 * kCokeFrames / 30.0;  // of the source alone; the jet and the glass add to it
  EXPECT_GT(coke.born, kFizz);
  EXPECT_GT(plastic.born, kFizz);
  const auto clinging = [](const Watched& run) {
    return surfaceCensus(run.simulation.bubbles(), run.toSolids).clinging;
  };
  EXPECT_GT(clinging(coke), clinging(plastic));
}

}  // namespace
}  // namespace spume::apps
