// The polyhedron that bounds a power cell, against the corners found by trying all triples of planes.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <map>

#include "foam/convex_cell.h"
#include "foam/counter_random.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.9;

struct Plane {
  Vector3d normal;
  double offset;
};

std::vector<Plane> cube() {
  std::vector<Plane> planes;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) planes.push_back({sign * Vector3d::Unit(axis), 1});
  return planes;
}

Vector3d randomDirection(CounterRandom& random) {
  const Vector3d v(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
  return v.normalized();
}

/// Bounds and faces of the points on the inner side of all planes.
struct Reference {
  static constexpr double kOnPlane = 1e-12;
  Vector3d low = Vector3d::Constant(1e9), high = Vector3d::Constant(-1e9);
  std::map<std::int32_t, bool> faces;  ///< whether a corner of each lies within kRadius

  explicit Reference(const std::vector<Plane>& planes) {
    const auto n = static_cast<std::int32_t>(planes.size());
    for (std::int32_t a = 0; a < n; ++a)
      for (std::int32_t b = 0; b < a; ++b)
        for (std::int32_t c = 0; c < b; ++c) addCorner(planes, a, b, c);
  }

  void addCorner(const std::vector<Plane>& planes, std::int32_t a, std::int32_t b, std::int32_t c) {
    Eigen::Matrix3d rows;
    rows << planes[a].normal.transpose(), planes[b].normal.transpose(), planes[c].normal.transpose();
    if (std::abs(rows.determinant()) < kOnPlane) return;
    const Vector3d p = rows.inverse() * Vector3d(planes[a].offset, planes[b].offset, planes[c].offset);
    for (const Plane& plane : planes)
      if (plane.normal.dot(p) > plane.offset + kOnPlane) return;
    low = low.cwiseMin(p), high = high.cwiseMax(p);
    for (const std::int32_t face : {a, b, c})
      if (face >= ConvexCell::kCubeFaces) faces[face] |= p.norm() < kRadius;
  }
};

TEST(ConvexCell, HasTheCornersThatPlanesLeave) {
  constexpr double kRoundOff = 1e-12;
  ConvexCell cell;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CounterRandom random(seed, 0, 0);
    std::vector<Plane> planes = cube();
    cell.reset(1);
    for (std::int32_t face = ConvexCell::kCubeFaces; face < 30; ++face) {
      planes.push_back({randomDirection(random), 0.3 + random.uniform()});
      const double length = 0.1 + random.uniform();  // of the normal: any will do
      cell.cut(length * planes.back().normal, length * planes.back().offset, face);
    }
    const Reference reference(planes);
    EXPECT_LE((cell.box().low - reference.low).cwiseAbs().maxCoeff(), kRoundOff) << seed;
    EXPECT_LE((cell.box().high - reference.high).cwiseAbs().maxCoeff(), kRoundOff) << seed;
    std::vector<ConvexCell::Face> faces;
    cell.listFaces(kRadius * kRadius, faces);
    std::map<std::int32_t, bool> found;
    for (const auto& [face, within] : faces) found[face] = within;
    EXPECT_EQ(found, reference.faces) << seed;
  }
}

TEST(ConvexCell, SaysWhatAPlaneDoes) {
  using Cut = ConvexCell::Cut;
  ConvexCell cell;
  cell.reset(2);
  EXPECT_EQ(cell.cut({1, 0, 0}, 3, 6), Cut::missed);
  EXPECT_EQ(cell.cut({1, 0, 0}, 2, 6), Cut::unsure);
  EXPECT_EQ(cell.cut({1, 0, 0}, 1, 6), Cut::done);
  EXPECT_EQ(cell.box().high, Vector3d(1, 2, 2));
  EXPECT_EQ(cell.cut({-1, 0, 0}, -1.5, 7), Cut::gone);
}

}  // namespace
}  // namespace spume::foam::test
