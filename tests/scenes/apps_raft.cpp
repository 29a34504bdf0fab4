// Rafts and piles in a still pool come to rest (accuracy, S22), as `spume reproduce foam` lets them.
#include <gtest/gtest.h>

#include "apps/reproduce/settling.h"

namespace spume::apps {
namespace {

using foam::Preset;

constexpr double kSteps[] = {0.005, 0.02};  // [s]
constexpr double kInWall = 0.1;             // deepest in a wall, of the radius: where `wall_limit` stops

/// What rafts without attraction and with that of the preset have in common.
void expectRest(const foam::FoamParams& params) {
  for (const double dt : kSteps) {
    const Settling raft(params, kRaft, dt);
    EXPECT_LE(rmsSpeed(raft.bubbles), kSmallRest) << dt;
    EXPECT_EQ(raft.report.bubbles, 300u);
    EXPECT_LE(raft.deepestInWall, kInWall);
    EXPECT_LE(raft.report.volumeErrorMax, 0.01);
  }
}

TEST(FoamRaft, SmallBubblesComeToRest) {
  for (const Preset preset : {Preset::paper, Preset::physical}) expectRest(withoutAttraction(preset));
}

TEST(FoamRaft, SmallBubblesDrawnByThePapersLawComeToRest) { expectRest(foam::makePreset(Preset::paper)); }

TEST(FoamRaft, SmallBubblesDrawnByCapillaryForcesComeToRest) {
  expectRest(foam::makePreset(Preset::physical));
}

TEST(FoamRaft, NewtonsVolumesComeToRestExactly) {
  constexpr double kExact = 1e-6;  // a projection at full strength leaves round-off and the last step
  for (const double dt : kSteps) {
    foam::FoamParams params = foam::makePreset(Preset::physical);
    params.volumeMode = foam::VolumeMode::newton;
    params.volumeTolerance = 1e-8;
    const Settling raft(params, kRaft, dt);
    EXPECT_LE(rmsSpeed(raft.bubbles), kSmallRest) << dt;
    EXPECT_LE(raft.report.volumeErrorMax, kExact) << dt;
  }
}

TEST(FoamRaft, APileOfLargeBubblesComesToRestAtAHeightThatDoesNotDependOnTheStep) {
  constexpr double kSameHeight = 0.05;  // accuracy, S22
  double heights[2] = {0, 0};
  for (const int which : {0, 1}) {
    const Settling pile(foam::makePreset(Preset::physical), kPile, kSteps[which]);
    EXPECT_LE(rmsSpeed(pile.bubbles), kLargeRest);
    EXPECT_LE(pile.deepestInWall, kInWall);
    EXPECT_GT(pile.report.air, 100u);
    heights[which] = gasHeight(pile.bubbles);
  }
  EXPECT_NEAR(heights[0], heights[1], kSameHeight * heights[0]);
}

}  // namespace
}  // namespace spume::apps
