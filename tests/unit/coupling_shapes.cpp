#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "coupling/object_label.h"
#include "coupling/shapes.h"

namespace spume::coupling {
namespace {

constexpr double kRoundOff = 1e-14;  // a few operations on numbers of order 1
constexpr double kDifferenceStep = 1e-6;
constexpr double kDifferenceError = 1e-8;  // eps/step for central differences of order-1 values

const Eigen::Vector3d kZero{0, 0, 0};

ShapeSpec box() { return {ShapeKind::box, {-1, -2, -3}, {1, 2, 3}, kZero, {0, 1, 0}, 0, 0}; }
ShapeSpec sphere() { return {ShapeKind::sphere, kZero, kZero, {1, 2, 3}, {0, 1, 0}, 2, 0}; }
ShapeSpec cylinder() { return {ShapeKind::cylinder, kZero, kZero, {1, 0, 0}, {0, 0, 2}, 1, 4}; }
ShapeSpec halfSpace() { return {ShapeKind::halfSpace, kZero, kZero, {0, 1, 0}, {0, 3, 0}, 0, 0}; }

/// A mug of inner radius 1 and height 3 about the z axis, walls 0.5 thick, bottom 0.25.
ShapeSpec mug() {
  ShapeSpec shape;
  shape.kind = ShapeKind::vessel;
  shape.centre = {1, 0, 0};
  shape.axis = {0, 0, 2};
  shape.innerDiameter = 2;
  shape.innerHeight = 3;
  shape.wallThickness = 0.5;
  shape.bottomThickness = 0.25;
  return shape;
}

TEST(Shapes, BoxDistanceAtFaceEdgeCornerAndInside) {
  EXPECT_NEAR(signedDistance(box(), {2, 0, 0}), 1, kRoundOff);
  EXPECT_NEAR(signedDistance(box(), {4, 6, 0}), 5, kRoundOff);
  EXPECT_NEAR(signedDistance(box(), {2, 4, 5}), 3, kRoundOff);
  EXPECT_NEAR(signedDistance(box(), {0.25, 0, 0}), -0.75, kRoundOff);
}

TEST(Shapes, SphereAndPlaneDistance) {
  EXPECT_NEAR(signedDistance(sphere(), {1, 2, 8}), 3, kRoundOff);
  EXPECT_NEAR(signedDistance(sphere(), {1, 2, 3}), -2, kRoundOff);
  EXPECT_NEAR(signedDistance(halfSpace(), {7, 3, -4}), 2, kRoundOff);
  EXPECT_NEAR(signedDistance(halfSpace(), {7, 0, -4}), -1, kRoundOff);
}

TEST(Shapes, CylinderDistanceAtSideCapRimAndInside) {
  EXPECT_NEAR(signedDistance(cylinder(), {3, 0, 0}), 1, kRoundOff);
  EXPECT_NEAR(signedDistance(cylinder(), {1, 0, 5}), 3, kRoundOff);
  EXPECT_NEAR(signedDistance(cylinder(), {1, 4, 6}), 5, kRoundOff);
  EXPECT_NEAR(signedDistance(cylinder(), {1.5, 0, 0}), -0.5, kRoundOff);
}

TEST(Shapes, VesselDistanceInsideOutsideInTheWallAndOverTheRim) {
  EXPECT_NEAR(signedDistance(mug(), {1.5, 0, 2}), 0.5, kRoundOff);           // inside, from the wall
  EXPECT_NEAR(signedDistance(mug(), {1, 0, 0.5}), 0.5, kRoundOff);           // inside, from the bottom
  EXPECT_NEAR(signedDistance(mug(), {1, 0, 5}), std::sqrt(5.0), kRoundOff);  // over the mouth, from the rim
  EXPECT_NEAR(signedDistance(mug(), {4, 0, 1}), 1.5, kRoundOff);             // beside it
  EXPECT_NEAR(signedDistance(mug(), {2.1, 0, 1}), -0.1, kRoundOff);          // in the wall
  EXPECT_NEAR(signedDistance(mug(), {1, 0, -0.2}), -0.05, kRoundOff);        // in the bottom
  const double corner = std::hypot(0.25, 0.1);  // where they join, from the edge of the room
  EXPECT_NEAR(signedDistance(mug(), {2.25, 0, -0.1}), -0.15, kRoundOff);
  EXPECT_LT(0.15, corner);
}

TEST(Shapes, RoomOfAVesselReachesHalfIntoItsWalls) {
  EXPECT_NEAR(roomInVessel(mug(), {2.25, 0, 1}), 0, kRoundOff);
  EXPECT_NEAR(roomInVessel(mug(), {1, 0, -0.125}), 0, kRoundOff);
  EXPECT_LT(roomInVessel(mug(), {1, 0, 40}), 0);
}

TEST(Shapes, DistanceHasUnitGradientAwayFromCreases) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-6, 6);
  for (const ShapeSpec& shape : {box(), sphere(), cylinder(), halfSpace(), mug()}) {
    int unit = 0;
    constexpr int kPoints = 200;
    for (int i = 0; i < kPoints; ++i) {
      const Eigen::Vector3d x(place(random), place(random), place(random));
      Eigen::Vector3d gradient;
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d step = kDifferenceStep * Eigen::Vector3d::Unit(axis);
        gradient[axis] =
            (signedDistance(shape, x + step) - signedDistance(shape, x - step)) / (2 * kDifferenceStep);
      }
      unit += std::abs(gradient.norm() - 1) < kDifferenceError;
    }
    EXPECT_GE(unit, kPoints - 1) << nameOf(shape.kind);  // a random point is on a crease with chance 1e-6
  }
}

TEST(Shapes, BoundsTouchTheShape) {
  ShapeSpec tilted = cylinder();
  tilted.axis = {1, 2, 2};
  for (const ShapeSpec& shape : {box(), sphere(), cylinder(), tilted, mug()}) {
    const auto [lower, upper] = bounds(shape);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0, 1);
    Eigen::Vector3d least = upper, most = lower;
    for (int i = 0; i < 200000; ++i) {
      const Eigen::Array3d t(unit(random), unit(random), unit(random));
      const Eigen::Vector3d x =
          (lower.array() - 0.5 + t * (upper - lower + Eigen::Vector3d::Ones()).array()).matrix();
      if (signedDistance(shape, x) > 0) continue;
      least = least.cwiseMin(x);
      most = most.cwiseMax(x);
    }
    constexpr double kSampling = 0.25;  // random points miss the extreme ones of a curved shape by about this
    EXPECT_TRUE((least.array() >= lower.array() - kRoundOff).all() &&
                (most.array() <= upper.array() + kRoundOff).all())
        << nameOf(shape.kind);
    EXPECT_LT((least - lower).maxCoeff(), kSampling) << nameOf(shape.kind);
    EXPECT_LT((upper - most).maxCoeff(), kSampling) << nameOf(shape.kind);
  }
}

/// The key that a shape is refused for; empty if it is not.
std::string refusedKey(const ShapeSpec& shape) {
  try {
    requireUsable(shape);
  } catch (const KeyFault& fault) {
    return fault.key();
  }
  return "";
}

TEST(Shapes, AreRefusedForTheKeyThatIsWrong) {
  EXPECT_EQ(refusedKey(box()), "");
  ShapeSpec flat = box();
  flat.upper.y() = flat.lower.y();
  EXPECT_EQ(refusedKey(flat), "upper");
  ShapeSpec point = sphere();
  point.radius = 0;
  EXPECT_EQ(refusedKey(point), "radius");
  ShapeSpec noAxis = cylinder();
  noAxis.axis.setZero();
  EXPECT_EQ(refusedKey(noAxis), "axis");
  const std::pair<double ShapeSpec::*, std::string> kOfAMug[] = {
      {&ShapeSpec::innerDiameter, "inner_diameter"},
      {&ShapeSpec::innerHeight, "inner_height"},
      {&ShapeSpec::wallThickness, "wall_thickness"},
      {&ShapeSpec::bottomThickness, "bottom_thickness"}};
  for (const auto& [length, key] : kOfAMug) {
    ShapeSpec flatMug = mug();
    flatMug.*length = 0;
    EXPECT_EQ(refusedKey(flatMug), key);
  }
}

}  // namespace
}  // namespace spume::coupling
