// Films as a mesh, and as soap films: against the cells they come from, Plateau's law and Kelvin's foam.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "foam/soap_films.h"
#include "tests/foam_fixtures.h"

namespace spume::foam::test {
namespace {

using Eigen::Vector3d;

constexpr double kRightAngle = 90, kDegree = std::numbers::pi / 180;

BubbleStore bubblesOf(const Balls& balls) {
  BubbleStore bubbles;
  for (std::size_t i = 0; i < balls.size(); ++i)
    bubbles.add(bubbleAt(balls.position[i], balls.radius[i], Vector3d::Zero(), BubbleClass::air));
  return bubbles;
}

/// The films of the power cells as they are.
FilmNetwork planeFilms(const Balls& balls, int segments) {
  const FoamTopology topology = powerCellsOf(balls);
  Neighbours neighbours;
  neighbours.build(balls.size(), topology.overlaps);
  return meshFilms(bubblesOf(balls), topology, neighbours, {}, segments);
}

/// A froth packed as by its own forces: every cell of the inner half is whole.
Balls froth() {
  constexpr int kEdge = 6;
  Balls balls;
  for (int i = 0; i < kEdge; ++i)
    for (int j = 0; j < kEdge; ++j)
      for (int k = 0; k < kEdge; ++k)
        for (const double shift : {0.0, 0.5}) {
          CounterRandom random(11, balls.size(), 1);
          const double x = random.uniform(), y = random.uniform(), z = random.uniform();
          balls.add(Vector3d(i + shift, j + shift, k + shift) + 0.1 * Vector3d(x, y, z),
                    0.75 + 0.03 * random.uniform());
        }
  return balls;
}
bool isInside(const Vector3d& x) { return (x.array() > 1.4).all() && (x.array() < 4.4).all(); }

/// Unit vector into the film from stretch s of its rim, square to it.
Vector3d fromRim(const FilmNetwork& network, const NetworkFilm& film, std::int32_t s) {
  const Vector3d& from = network.at(film, s);
  const Vector3d along = (network.at(film, (s + 1) % film.rim) - from).normalized();
  const Vector3d in = network.at(film, network.triangles[film.firstTriangle + s][2]) - from;
  return (in - along * along.dot(in)).normalized();
}

/// Volume and area of each bubble as far as films close it.
struct Closed {
  std::vector<double> volume, area;
};
Closed closedBy(const FilmNetwork& network, std::size_t bubbles) {
  Closed closed{std::vector<double>(bubbles, 0), std::vector<double>(bubbles, 0)};
  for (const NetworkFilm& film : network.films) {
    double volume = 0;
    for (std::int32_t t = film.firstTriangle; t < film.endTriangle; ++t) {
      const auto& [a, b, c] = network.triangles[t];
      volume += network.at(film, a).dot(network.at(film, b).cross(network.at(film, c))) / 6;
    }
    closed.volume[film.i] += volume, closed.volume[film.j] -= volume;
    for (const std::int32_t bubble : {film.i, film.j}) closed.area[bubble] += network.areaOf(film);
  }
  return closed;
}

/// Rms, along the borders of inner bubbles, of what the angles between films differ from 120 degrees by.
double filmSpread(const FilmNetwork& network, const Balls& balls) {
  std::vector<std::vector<std::vector<Vector3d>>> away(network.borders.size());
  for (std::size_t b = 0; b < away.size(); ++b) away[b].resize(network.borders[b].nodes.size() - 1);
  for (const NetworkFilm& film : network.films)
    for (std::int32_t s = 0; s < film.rim; ++s)
      if (const auto [border, stretch] = network.borderOfSlot[film.firstSlot + s]; border >= 0)
        away[border][stretch].push_back(fromRim(network, film, s));
  double sum = 0, length = 0;
  for (std::size_t b = 0; b < away.size(); ++b) {
    const FilmBorder& border = network.borders[b];
    if (!std::all_of(border.bubbles.begin(), border.bubbles.end(),
                     [&](std::int32_t i) { return isInside(balls.position[i]); }))
      continue;
    for (std::size_t s = 0; s < away[b].size(); ++s) {
      const double stretch =
          (network.nodes[border.nodes[s + 1]].position - network.nodes[border.nodes[s]].position).norm();
      for (std::size_t f = 0; f < 3; ++f) {
        const double cosine = away[b][s][f].dot(away[b][s][(f + 1) % 3]);
        sum += stretch * std::pow(std::acos(std::clamp(cosine, -1.0, 1.0)) / kDegree - 120, 2);
      }
      length += 3 * stretch;
    }
  }
  return std::sqrt(sum / length);
}

TEST(FilmNetwork, HasTheFilmsOfTheCellsItIsMadeFrom) {
  constexpr double kArc =
      0.02;  // of a film: 12 sides for a circle, halved once: area of a 24-gon is 1.1 % small
  const Balls balls = randomFoam(400, 0.3, 2, 0.9, 3);
  const FoamTopology topology = powerCellsOf(balls);
  const FilmNetwork network = planeFilms(balls, 2);
  EXPECT_EQ(network.torn, 0u);
  ASSERT_LE(network.films.size(), topology.films.size());
  double meshed = 0, exact = 0;
  for (const NetworkFilm& film : network.films) {
    const auto known = std::find_if(topology.films.begin(), topology.films.end(),
                                    [&](const Film& f) { return f.i == film.i && f.j == film.j; });
    ASSERT_NE(known, topology.films.end());
    const double area = network.areaOf(film);
    const double disc = std::numbers::pi * (std::pow(balls.radius[film.i], 2) - std::pow(known->height, 2));
    EXPECT_NEAR(area, known->area, kArc * disc);
    meshed += area;
  }
  for (const Film& film : topology.films) exact += film.area;
  EXPECT_NEAR(meshed, exact, kArc * exact);
}

TEST(FilmNetwork, OfWholeCellsIsClosed) {
  constexpr double kRoundOff = 1e-9;
  const Balls balls = froth();
  const FoamTopology topology = powerCellsOf(balls);
  for (const int segments : {1, 3}) {
    const Closed closed = closedBy(planeFilms(balls, segments), balls.size());
    int whole = 0;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      if (topology.freeArea[i] > 0) continue;
      ++whole;
      EXPECT_NEAR(closed.volume[i], topology.volume[i], kRoundOff * topology.volume[i]);
      EXPECT_NEAR(closed.area[i], topology.filmArea[i], kRoundOff * topology.filmArea[i]);
    }
    EXPECT_GT(whole, 100);
  }
}

TEST(SoapFilms, MeetAtPlateausAngleTheFinerTheNearer) {
  // Chords of films of curvature H turn by H h / 2 from their tangents: half the stretches, half the spread.
  constexpr double kHalved = 0.7;
  const Balls balls = froth();
  const BubbleStore bubbles = bubblesOf(balls);
  const double plane = filmSpread(planeFilms(balls, 1), balls);
  const double coarse = filmSpread(soapFilms(bubbles, 1).network, balls);
  const double middle = filmSpread(soapFilms(bubbles, 2).network, balls);
  const double fine = filmSpread(soapFilms(bubbles, 4).network, balls);
  EXPECT_GT(plane, 7);
  EXPECT_LT(middle, kHalved * coarse) << coarse;
  EXPECT_LT(fine, kHalved * middle);
  EXPECT_LT(fine, 3);
}

TEST(SoapFilms, HoldTheVolumesOfTheCells) {
  const FilmRelaxationSettings settings;
  const Balls balls = froth();
  const FoamTopology topology = powerCellsOf(balls);
  const SoapFilms films = soapFilms(bubblesOf(balls), 2, settings);
  EXPECT_LT(films.report.areaAfter, films.report.areaBefore);
  EXPECT_LT(films.report.worstVolume, settings.volumeTolerance);
  const Closed closed = closedBy(films.network, balls.size());
  int moved = 0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    if (topology.freeArea[i] > 0) continue;
    EXPECT_NEAR(closed.volume[i], topology.volume[i], settings.volumeTolerance * topology.volume[i]);
    moved += std::abs(closed.area[i] / topology.filmArea[i] - 1) > 1e-4;
  }
  EXPECT_GT(moved, 100);
}

TEST(SoapFilms, OfEqualCellsOnACentredCubicLatticeAreKelvinsFoam) {
  // Area over volume^(2/3): 5.306 [Weaire and Phelan 1994]; of the plane cell 5.3147. Chords of films have an
  // error of second order: 3.0e-3 was measured with 2 stretches an edge, and 1.0e-3 with 4.
  constexpr double kKelvin = 5.306, kDigits = 5e-4, kChords = 1.5e-3, kPlane = 5.31474;
  constexpr int kEdge = 5;
  Balls balls;
  for (int i = 0; i < kEdge; ++i)
    for (int j = 0; j < kEdge; ++j)
      for (int k = 0; k < kEdge; ++k)
        for (const double shift : {0.0, 0.5}) balls.add(Vector3d(i + shift, j + shift, k + shift), 0.7);
  const std::size_t centre = 2 * (2 * kEdge * kEdge + 2 * kEdge + 2);
  const auto share = [&](const FilmNetwork& network) {
    const Closed closed = closedBy(network, balls.size());
    return closed.area[centre] / std::pow(closed.volume[centre], 2.0 / 3);
  };
  EXPECT_NEAR(share(planeFilms(balls, 4)), kPlane, 1e-5);
  const double relaxed = share(soapFilms(bubblesOf(balls), 4, {.areaTolerance = 3e-6}).network);
  EXPECT_GT(relaxed, kKelvin - kDigits);
  EXPECT_LT(relaxed, kKelvin + kChords);
}

TEST(SoapFilms, StandSquareOnWalls) {
  constexpr double kChord = 4;  // degrees: the outermost triangle of a bent film
  StillPoolParams dry;
  dry.surfaceHeight = -1e3;
  dry.lower.fill(-0.3), dry.upper.fill(5.9);
  dry.closed.fill(true);
  const Balls balls = froth();
  const SoapFilms films = soapFilms(bubblesOf(balls), StillPool(dry), 3);
  double sum = 0;
  int count = 0;
  for (const NetworkFilm& film : films.network.films)
    for (std::int32_t s = 0; s < film.rim; ++s) {
      const FilmNetwork& network = films.network;
      const FilmNode& node = network.nodes[network.slots[film.firstSlot + s]];
      const FilmNode& next = network.nodes[network.slots[film.firstSlot + (s + 1) % film.rim]];
      if (node.hold != NodeHold::plane || next.hold != NodeHold::plane || node.axis.dot(next.axis) < 0.9)
        continue;
      EXPECT_NEAR(node.axis.dot(next.position - node.position), 0, 1e-9);
      const Vector3d away = fromRim(network, film, s);
      sum += std::pow(std::asin(std::clamp(away.dot(-node.axis), -1.0, 1.0)) / kDegree - kRightAngle, 2);
      ++count;
    }
  ASSERT_GT(count, 200);
  EXPECT_LT(std::sqrt(sum / count), kChord);
}

TEST(SoapFilms, AreTheSameForAnyNumberOfThreads) {
  const BubbleStore bubbles = bubblesOf(randomFoam(400, 0.3, 2, 0.9, 3));
  const auto nodes = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return soapFilms(bubbles).network.nodes;
  };
  const std::vector<FilmNode> one = nodes(1), two = nodes(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t n = 0; n < one.size(); ++n) ASSERT_EQ(one[n].position, two[n].position);
}

TEST(SoapFilms, OfFewOrNoBubblesAreWhatThereIs) {
  EXPECT_TRUE(soapFilms(BubbleStore()).network.films.empty());
  Balls pair;
  pair.add({0, 0, 0}, 1);
  EXPECT_TRUE(soapFilms(bubblesOf(pair)).network.films.empty());
  pair.add({1, 0, 0}, 1);
  const SoapFilms films = soapFilms(bubblesOf(pair));
  ASSERT_EQ(films.network.films.size(), 1u);
  for (const FilmNode& node : films.network.nodes) EXPECT_NEAR(node.position.x(), 0.5, 1e-9);
}

}  // namespace
}  // namespace spume::foam::test
