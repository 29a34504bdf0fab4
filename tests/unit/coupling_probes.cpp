#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "coupling/atomic_file.h"
#include "coupling/probes.h"
#include "coupling/scene_builder.h"
#include "coupling/simulation.h"
#include "tests/support/temporary_path.h"

namespace spume::coupling {
namespace {

constexpr double kEdge = 0.16, kDepth = 0.0613;  // [m]: the surface lies between cell centres
const Eigen::Vector3d kNowhere{0, 0, 0};

ProbeSpec probe(const std::string& name, ProbeKind kind, const Eigen::Vector3d& position) {
  ProbeSpec spec;
  spec.name = name;
  spec.kind = kind;
  spec.position = position;
  return spec;
}

/// A tank of 16^3 cells with still water of kDepth against gravity along `down`.
Scene stillTank(const Eigen::Vector3d& down) {
  Scene scene;
  scene.domain.size = {kEdge, kEdge, kEdge};
  scene.domain.resolution = 16;
  scene.domain.closed = {true, true, true, true, true, true};
  scene.liquid.gravity = scene.foam.gravity = 9.8 * down;
  LiquidBodySpec pool;
  pool.shape.kind = ShapeKind::halfSpace;
  pool.shape.axis = -down;
  const Eigen::Vector3d centre = Eigen::Vector3d::Constant(0.5 * kEdge);
  pool.shape.centre = centre + (0.5 * kEdge - kDepth) * down;
  scene.liquidBodies = {pool};
  return scene;
}

/// Height [m] over the floor along -down, in the middle of the tank.
Eigen::Vector3d at(const Eigen::Vector3d& down, double height) {
  return Eigen::Vector3d::Constant(0.5 * kEdge) + (0.5 * kEdge - height) * down;
}

std::vector<double> readAfterSteps(const Scene& scene, int steps = 2) {
  Simulation simulation(scene);
  StepReport report;
  for (int n = 0; n < steps; ++n) report = simulation.step(0.01);
  return report.probes;
}

/// Answers of hydrostatics, whatever the direction of gravity.
TEST(Probes, ReadAStillTankAlongEveryAxis) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      const Eigen::Vector3d down = side * Eigen::Vector3d::Unit(axis);
      Scene scene = stillTank(down);
      scene.probes = {probe("level", ProbeKind::height, at(down, 0)),
                      probe("deep", ProbeKind::pressure, at(down, 0.0123)),
                      probe("shallow", ProbeKind::pressure, at(down, kDepth - 0.002)),
                      probe("aloft", ProbeKind::pressure, at(down, kDepth + 0.002)),
                      probe("u", ProbeKind::velocity, at(down, 0.03))};
      ProbeSpec lower = probe("half", ProbeKind::volume, kNowhere);
      lower.shape.kind = ShapeKind::box;
      lower.shape.lower = {-1, -1, -1};
      lower.shape.upper = {0.5 * kEdge, 1, 1};
      scene.probes.push_back(lower);
      const std::vector<double> values = readAfterSteps(scene);
      ASSERT_EQ(values.size(), 9u);
      constexpr double kFloats = 2e-6;  // phi and pressure are floats, relative to the depth
      EXPECT_NEAR(values[0], kDepth, kFloats * kDepth);
      EXPECT_NEAR(values[1], kDepth, kFloats * kDepth);
      const double weight = 9.8 * scene.liquid.density;
      EXPECT_NEAR(values[2], weight * (kDepth - 0.0123), kFloats * weight * kDepth);
      EXPECT_NEAR(values[3], weight * 0.002, kFloats * weight * kDepth);
      EXPECT_EQ(values[4], 0);
      EXPECT_LE(std::hypot(values[5], values[6], values[7]), 1e-8);
      const double across = axis == 0 ? kDepth : 0.5 * kEdge;  // of the lower half of x: all of it or half
      const double half = axis == 0 && side > 0 ? 0 : across * (axis == 0 ? kEdge : kDepth) * kEdge;
      EXPECT_NEAR(values[8], half, kFloats * std::pow(kEdge, 3));
    }
}

TEST(Probes, ColumnsAreNamedAfterTheProbes) {
  Scene scene;
  scene.probes = {probe("a", ProbeKind::height, kNowhere), probe("", ProbeKind::velocity, kNowhere)};
  std::vector<std::string> names;
  for (const ColumnInfo& column : probeColumns(scene)) names.push_back(column.name);
  EXPECT_EQ(names, (std::vector<std::string>{"a_surface", "a_wet", "probe1_x", "probe1_y", "probe1_z"}));
}

TEST(Probes, RowsOfAResumedRunFollowTheKeptOnes) {
  const std::string folder = temporaryPath("probes");
  createFolder(folder);
  const std::vector<ColumnInfo> columns{{"p1", "Pa", ""}};
  StepReport report;
  for (const bool resumed : {false, true}) {
    StatisticsWriter writer(folder, resumed ? 2 : 0, 0, columns);
    for (int step = resumed ? 3 : 1; step <= 4; ++step) {
      report.step = step;
      report.time = 0.5 * step;
      report.probes = {resumed ? 2.5 : 1.5};
      writer.add(report);
    }
    writer.add(FrameReport{});
  }
  EXPECT_EQ(readFile(folder + "/probes.csv"), "step,time,p1\n1,0.5,1.5\n2,1,1.5\n3,1.5,2.5\n4,2,2.5\n");
}

}  // namespace
}  // namespace spume::coupling
