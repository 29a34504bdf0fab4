// Surface tension on films, borders and free surfaces against finite differences of its energy.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>

#include "foam/film_forces.h"
#include "foam/forces/strong_spring.h"
#include "foam/volume_newton.h"
#include "foam/wall_cells.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;

constexpr double kTension = 0.06;  // [N/m]

constexpr double kNoFloor = -1e9;

/// Bubbles with their cells, in empty space or above a floor at that height.
struct MeasuredBubbles {
  double floor = kNoFloor;
  std::vector<NearWalls> walls;
  BubbleStore bubbles;
  FoamTopology topology;
  Neighbours neighbours;
  std::vector<double> tension, wetness;

  explicit MeasuredBubbles(const Balls& balls, double lambda = 0.2, double floorHeight = kNoFloor)
      : floor(floorHeight) {
    for (std::size_t i = 0; i < balls.size(); ++i)
      bubbles.add(bubbleAt(balls.position[i], balls.radius[i])), tension.push_back(kTension);
    wetness.assign(balls.size(), lambda);
    measure();
  }
  void measure() {
    walls.clear();
    if (floor > kNoFloor)
      for (const Vector3d& x : bubbles.position) {
        walls.emplace_back();
        walls.back().wall[walls.back().count++] = {x.y() - floor, Vector3d::UnitY(), Vector3d::Zero(), -1};
      }
    WallCells().compute(bubbles, walls, topology);
    neighbours.build(bubbles.size(), topology.overlaps);
  }
  double energy() const {
    double sum = 0;
    for (const Film& film : topology.films) sum += std::min(tension[film.i], tension[film.j]) * film.area;
    for (std::size_t i = 0; i < bubbles.size(); ++i)
      sum += freeTension(tension[i], wetness[i]) * topology.freeArea[i];
    return sum;
  }
  FilmForces forces(bool radiiFollow) const {
    FilmForces films;
    films.compute(bubbles, topology, neighbours, walls, tension, wetness,
                  std::vector<char>(bubbles.size(), !radiiFollow));
    return films;
  }
  /// Central difference of the energy by coordinate c of bubble i [N], over 2 `step`; at held volumes if any
  /// are given.
  double energySlope(std::size_t i, int c, double step, const std::vector<double>* held = nullptr) const {
    const auto energyAt = [&](double way) {
      MeasuredBubbles moved = *this;
      moved.bubbles.position[i][c] += way;
      moved.measure();
      if (held) moved.holdVolumes(*held);
      return moved.energy();
    };
    return (energyAt(step) - energyAt(-step)) / (2 * step);
  }
  /// Brings the cells to these volumes by their weights.
  void holdVolumes(const std::vector<double>& volume) {
    std::vector<double> missing(volume.size()), change;
    for (int step = 0; step < 6; ++step) {
      for (std::size_t i = 0; i < volume.size(); ++i) missing[i] = volume[i] - topology.volume[i];
      solveWeightChanges(topology, neighbours, bubbles.radius, missing, std::vector<char>(volume.size(), 0),
                         1e-9, change);
      for (std::size_t i = 0; i < volume.size(); ++i)
        bubbles.radius[i] = std::sqrt(bubbles.radius[i] * bubbles.radius[i] + change[i]);
      measure();
    }
  }
};

/// A loose foam of unequal balls: films cut by borders, by the air, and by both.
Balls looseFoam() { return randomFoam(60, 0.25, 1.6, 0.75, 5); }

TEST(FilmForces, AreMinusTheGradientOfTheSurfaceEnergy) {
  constexpr double kStep = 1e-6;       // of the median radius 1
  constexpr double kTolerance = 1e-6;  // of T r: central differences, error kStep^2 and round-off / kStep
  MeasuredBubbles foam(looseFoam());
  foam.tension[3] *= 0.5, foam.tension[17] *= 0.7;  // unequal ones too
  const FilmForces films = foam.forces(false);
  for (std::size_t i = 0; i < foam.bubbles.size(); i += 3)
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(films.force()[i][c], -foam.energySlope(i, c, kStep), kTolerance * kTension);
    }
}

TEST(FilmForces, LetFilmsSlideOnASolid) {
  constexpr double kStep = 1e-6, kTolerance = 1e-6;  // as above
  constexpr double kFilmsAlone = 1e30;               // a wetness at which free surfaces weigh nothing
  const MeasuredBubbles foam(looseFoam(), kFilmsAlone, 1.2);
  const FilmForces films = foam.forces(false);
  int cut = 0;
  for (std::size_t i = 0; i < foam.bubbles.size(); ++i) {
    const double psi = foam.bubbles.position[i].y() - foam.floor, r = foam.bubbles.radius[i];
    if (psi < 0.1 * r || psi > 1.5 * r) continue;
    cut += psi < kCutByWall * r;
    for (const int c : {0, 2}) {
      EXPECT_NEAR(films.force()[i][c], -foam.energySlope(i, c, kStep), kTolerance * kTension) << i;
    }
  }
  EXPECT_GT(cut, 5);
}

TEST(FilmForces, HoldTheVolumesOfAllCells) {
  constexpr double kStep = 1e-4;  // of the median radius 1
  constexpr double kTolerance =
      1e-4;  // of T r: curvature of the energy times kStep^2, tolerance of pressures
  MeasuredBubbles foam(looseFoam());
  const FilmForces films = foam.forces(true);
  const std::vector<double> volume = foam.topology.volume;
  for (std::size_t i = 1; i < foam.bubbles.size(); i += 13)
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(films.force()[i][c], -foam.energySlope(i, c, kStep, &volume), kTolerance * kTension);
    }
}

TEST(FilmForces, AddUpToNothing) {
  constexpr double kRound = 1e-13;  // of the sum of sizes: round-off of some thousand terms
  const MeasuredBubbles foam(randomFoam(300, 0.3, 2, 0.95, 8));
  for (const bool radiiFollow : {false, true}) {
    Vector3d sum = Vector3d::Zero(), turn = Vector3d::Zero();
    double scale = 0, armScale = 0;
    const FilmForces films = foam.forces(radiiFollow);
    for (std::size_t i = 0; i < foam.bubbles.size(); ++i) {
      const Vector3d &f = films.force()[i], &x = foam.bubbles.position[i];
      sum += f, scale += f.norm(), turn += x.cross(f), armScale += x.norm() * f.norm();
    }
    EXPECT_LE(sum.norm(), kRound * scale);
    EXPECT_LE(turn.norm(), kRound * armScale);
  }
}

TEST(FilmForces, APairRestsAtItsRestLengthHoweverWet) {
  constexpr double kRound = 1e-12;  // of T r
  for (const double wetness : {0.0, 0.2, 0.6, 1.0})
    for (const double share : {0.97, 1.0, 1.03}) {
      if (wetness == 1 && share >= 1) continue;  // they touch in a point, or not at all
      Balls pair;
      pair.add({0, 0, 0}, 1), pair.add({share * restLength(1, 1, wetness), 0, 0}, 1);
      const double pull = MeasuredBubbles(pair, wetness).forces(true).force()[0].x();
      if (share == 1)
        EXPECT_NEAR(pull, 0, kRound * kTension);
      else
        EXPECT_GT(pull * (share - 1), 1e-3 * kTension * std::abs(share - 1)) << wetness << " " << share;
    }
}

TEST(FilmForces, DoNotDependOnTheThreads) {
  const MeasuredBubbles foam(randomFoam(3000, 0.3, 2, 0.95, 9));
  const auto withThreads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return foam.forces(true).force();
  };
  const Vectors3 alone = withThreads(1);
  for (const std::size_t threads : {2, 5}) EXPECT_EQ(alone, withThreads(threads));
}

/// Three equal balls around a straight border, the first moved out by `off`.
struct Border {
  Balls balls;
  FoamTopology topology;
  std::vector<TensionPull> pulls;

  explicit Border(double off, double tensionOfFirst = kTension) {
    for (const int k : {0, 1, 2}) {
      const double angle = 2 * std::numbers::pi * k / 3, out = k == 0 ? 0.65 + off : 0.65;
      balls.add({out * std::cos(angle), out * std::sin(angle), 0}, 1);
    }
    const MeasuredBubbles foam(balls);
    topology = foam.topology;
    const std::vector<NearWalls> noWalls;
    FilmOutlines outlines(foam.bubbles, topology, foam.neighbours, noWalls);
    FilmOutline outline;
    for (const Film& film : topology.films) {
      outlines.trace(film, outline);
      addEdgeTension(film, outline, film.j == 1 ? tensionOfFirst : kTension, balls.position, pulls);
    }
  }
  Vector3d forceOn(std::int32_t bubble) const {
    Vector3d sum = Vector3d::Zero();
    for (const TensionPull& pull : pulls)
      if (pull.bubble == bubble) sum += pull.force;
    return sum;
  }
};

TEST(FilmForces, FilmsThatMeetAt120DegreesLeaveTheirBorderAlone) {
  constexpr double kRound = 1e-14;
  for (const int bubble : {0, 1, 2}) EXPECT_LE(Border(0).forceOn(bubble).norm(), kRound * kTension);
  EXPECT_GT(Border(0, 1.1 * kTension).forceOn(0).norm(), 0.01 * kTension);
  EXPECT_GT(Border(0.1).forceOn(0).norm(), 0.01 * kTension);
}

TEST(FilmOutline, IsThatOfADiscCutByABorder) {
  constexpr double kRound = 1e-13;
  // The border runs through the origin along z; a film reaches from it to the rim of its disc.
  const MeasuredBubbles foam(Border(0).balls);
  const std::vector<NearWalls> noWalls;
  FilmOutlines outlines(foam.bubbles, foam.topology, foam.neighbours, noWalls);
  FilmOutline outline;
  const double half = std::sqrt(1 - 0.65 * 0.65), away = 0.65 / 2;
  const double disc = std::sqrt(1 - std::pow(0.65 * std::sqrt(3.0) / 2, 2));
  for (const Film& film : foam.topology.films) {
    outlines.trace(film, outline);
    ASSERT_EQ(outline.edges.size(), 1u);
    EXPECT_NEAR(outline.edges[0].length, 2 * half, kRound);
    EXPECT_NEAR(outline.edges[0].middle.norm(), 0, kRound);
    EXPECT_EQ(outline.edges[0].third, 3 - film.i - film.j);
    EXPECT_NEAR(outline.discRadius, disc, kRound);
    EXPECT_NEAR(outline.arc, 2 * (std::numbers::pi - std::acos(away / disc)), kRound);
    EXPECT_NEAR(outline.arcPull.norm(), 2 * half, kRound);
    // Of what lies beyond the line, 2/3 half^3, the other side's, as the whole disc has none.
    EXPECT_NEAR(outline.moment.norm(), 2.0 / 3 * std::pow(half, 3), kRound);
    EXPECT_GT(outline.moment.dot(outline.centre), 0);
  }
}

}  // namespace
}  // namespace spume::foam::test
