#include <gtest/gtest.h>

#include <cmath>

#include "apps/reproduce/plateau_angles.h"
#include "foam/counter_random.h"
#include "foam/neighbours.h"
#include "foam/power_cells.h"

namespace spume::apps {
namespace {

/// A foam of balls so large that every cell is whole, and flags of those far from its border.
struct Froth {
  std::vector<Eigen::Vector3d> position;
  std::vector<double> radius;
  std::vector<std::uint8_t> inner;

  void add(const Eigen::Vector3d& x, double r, bool inside) {
    position.push_back(x);
    radius.push_back(r);
    inner.push_back(inside);
  }
  PlateauAngles angles() const {
    std::vector<std::uint64_t> id(position.size());
    for (std::size_t n = 0; n < id.size(); ++n) id[n] = n;
    foam::FoamTopology topology;
    foam::PowerCells().compute(position, radius, id, topology);
    return plateauAngles(position, radius, topology, inner);
  }
};

TEST(PlateauAngles, OfEqualCellsOnACentredCubicLatticeAreThoseOfTheTruncatedOctahedron) {
  constexpr int kEdge = 6;
  Froth froth;
  for (int i = 0; i < kEdge; ++i)
    for (int j = 0; j < kEdge; ++j)
      for (int k = 0; k < kEdge; ++k)
        for (const double shift : {0.0, 0.5}) {
          const Eigen::Vector3d x(i + shift, j + shift, k + shift);
          froth.add(x, 0.7, (x.array() > 1.4).all() && (x.array() < kEdge - 1.9).all());
        }
  const PlateauAngles angles = froth.angles();
  ASSERT_GT(angles.borders.size(), 100u);
  // Two hexagons and a square: 109.47 and twice 125.26 degrees. Borders: twice 90, four times 120 degrees.
  const double square = std::acos(-1.0 / 3) * 180 / M_PI, hexagon = 180 - square / 2;
  const double films = std::sqrt((std::pow(square - 120, 2) + 2 * std::pow(hexagon - 120, 2)) / 3);
  const double borders = std::sqrt((2 * std::pow(90 - square, 2) + 4 * std::pow(120 - square, 2)) / 6);
  constexpr double kTieBreak = 1e-4;  // radii are told apart by 1e-9, which tilts nothing; round-off of acos
  EXPECT_NEAR(angles.filmSpread(), films, kTieBreak);
  EXPECT_NEAR(angles.borderSpread(), borders, kTieBreak);
}

TEST(PlateauAngles, AtRestAreThoseOfTheTetrahedronForEqualBubblesAndOfPlateausTriangleForUnequal) {
  PlateauAngles measured;
  measured.bordersCells = {{0, 1, 2}, {0, 1, 4}};
  measured.pointsCells = {{0, 1, 2, 3}};
  const PlateauAngles rest = anglesAtRest({2, 2, 2, 2, 3}, measured);
  constexpr double kRoundOff = 1e-10;
  // Sides of 2, 2 and sqrt(7): the larger bubble's corner is the sharper one.
  const double sharp = 2 * std::asin(1 / std::sqrt(7.0)) * 180 / M_PI;
  const std::vector<double> films = {120,        120, 120, 180 - (90 - sharp / 2), 180 - (90 - sharp / 2),
                                     180 - sharp};
  ASSERT_EQ(rest.films.size(), films.size());
  for (std::size_t n = 0; n < films.size(); ++n) EXPECT_NEAR(rest.films[n], films[n], kRoundOff) << n;
  ASSERT_EQ(rest.borders.size(), 6u);
  EXPECT_NEAR(rest.borderSpread(), 0, kRoundOff);
}

TEST(PlateauAngles, OfRandomPointsSpreadAsARandomDiagramDoes) {
  constexpr int kPoints = 1500;
  constexpr double kFilms = 24, kBorders = 36;  // published spreads of a random power diagram [degrees]
  constexpr double kSample = 0.08;              // of them: some thousand angles, and a border to the sample
  Froth froth;
  for (int n = 0; n < kPoints; ++n) {
    foam::CounterRandom random(7, static_cast<std::uint64_t>(n), 1);
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Eigen::Vector3d p(x, y, z);
    froth.add(p, 0.2, (p.array() > 0.2).all() && (p.array() < 0.8).all());
  }
  const PlateauAngles angles = froth.angles();
  ASSERT_GT(angles.films.size(), 1000u);
  EXPECT_NEAR(angles.filmSpread(), kFilms, kSample * kFilms);
  EXPECT_NEAR(angles.borderSpread(), kBorders, kSample * kBorders);
}

TEST(PlateauAngles, OfThreeBubblesInARingAreOneBorder) {
  Froth froth;
  for (int n = 0; n < 3; ++n)
    froth.add({std::cos(n * 2 * M_PI / 3), std::sin(n * 2 * M_PI / 3), 0}, 1.2, true);
  const PlateauAngles angles = froth.angles();
  ASSERT_EQ(angles.films.size(), 3u);
  EXPECT_NEAR(angles.filmSpread(), 0, 1e-6);  // an equilateral triangle, up to the tie-break of the radii
  EXPECT_TRUE(angles.borders.empty());
}

TEST(PlateauAngles, EveryWholeCellHasTheEdgesOfEulersLaw) {
  // Three edges meet in every corner of a cell with F faces, so it has 3 F - 6 edges, each of two faces.
  Froth froth;
  for (int n = 0; n < 400; ++n) {
    foam::CounterRandom random(9, static_cast<std::uint64_t>(n), 1);
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    froth.add({x, y, z}, 0.3, true);
  }
  std::vector<std::uint64_t> id(froth.position.size());
  for (std::size_t n = 0; n < id.size(); ++n) id[n] = n;
  foam::FoamTopology cells;
  foam::PowerCells().compute(froth.position, froth.radius, id, cells);
  const std::vector<int> borders = bordersOfFilms(froth.position, froth.radius, cells);
  std::vector<int> faces(id.size(), 0), edges(id.size(), 0);
  for (std::size_t f = 0; f < borders.size(); ++f)
    for (const std::int32_t i : {cells.films[f].i, cells.films[f].j}) ++faces[i], edges[i] += borders[f];
  int whole = 0;
  for (std::size_t i = 0; i < id.size(); ++i) {
    if (cells.freeArea[i] > 0) continue;
    ++whole;
    EXPECT_EQ(edges[i], 6 * faces[i] - 12) << i;
  }
  EXPECT_GT(whole, 50);
}

TEST(PlateauAngles, OfANetworkOfPlaneFilmsAreThoseOfItsCells) {
  constexpr double kRoundOff = 1e-6;
  Froth froth;
  foam::BubbleStore bubbles;
  for (int n = 0; n < 400; ++n) {
    foam::CounterRandom random(5, static_cast<std::uint64_t>(n), 1);
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    const Eigen::Vector3d p(x, y, z);
    froth.add(p, 0.25, (p.array() > 0.2).all() && (p.array() < 0.8).all());
    bubbles.add({.position = p, .radius = 0.25});
  }
  foam::FoamTopology cells;
  foam::PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, cells);
  foam::Neighbours neighbours;
  neighbours.build(bubbles.size(), cells.overlaps);
  const PlateauAngles network = plateauAngles(meshFilms(bubbles, cells, neighbours, {}, 1), froth.inner);
  const PlateauAngles exact = plateauAngles(bubbles.position, bubbles.radius, cells, froth.inner);
  ASSERT_GT(exact.films.size(), 300u);
  EXPECT_EQ(network.films.size(), exact.films.size());
  EXPECT_EQ(network.borders.size(), exact.borders.size());
  EXPECT_NEAR(network.filmSpread(), exact.filmSpread(), kRoundOff);
  EXPECT_NEAR(network.borderSpread(), exact.borderSpread(), kRoundOff);
}

}  // namespace
}  // namespace spume::apps
