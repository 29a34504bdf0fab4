#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "apps/reproduce/dry_cluster.h"
#include "apps/reproduce/foam_bench.h"
#include "apps/reproduce/foam_studies.h"
#include "apps/reproduce/plateau_angles.h"
#include "foam/power_cells.h"
#include "foam/soap_films.h"
#include "foam/volume_newton.h"

namespace spume::apps {
namespace {

using Eigen::Vector3d;

/// Worst angle between films that meet, against 120 degrees, and between borders, against acos(-1/3).
struct AngleErrors {
  double films = 0, borders = 0;  ///< [degrees]

  explicit AngleErrors(const foam::BubbleStore& bubbles) {
    foam::FoamTopology cells;
    foam::PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, cells);
    const std::vector<std::uint8_t> all(bubbles.size(), 1);
    const PlateauAngles angles = plateauAngles(bubbles.position, bubbles.radius, cells, all);
    for (const double a : angles.films) films = std::max(films, std::abs(a - 120));
    for (const double a : angles.borders)
      borders = std::max(borders, std::abs(a - std::acos(-1.0 / 3) * 180 / std::numbers::pi));
    if (angles.borders.empty()) borders = std::numeric_limits<double>::quiet_NaN();
    if (angles.films.empty()) films = std::numeric_limits<double>::quiet_NaN();
  }
};

/// G1: two, three and four equal bubbles. r/r0 follows from the volume that each cell has at distances r.
std::vector<ResultRow> equalClusters(const StudyContext&) {
  constexpr double kCellVolume[] = {9 * std::numbers::pi / 8, 3.103736710859, 2.791585698220};  // [r^3]
  std::vector<ResultRow> rows;
  for (std::size_t n = 2; n <= 4; ++n) {
    const foam::BubbleStore b = relaxedCluster(std::vector<double>(n, 1e-3));
    const double growth = std::cbrt(4 * std::numbers::pi / 3 / kCellVolume[n - 2]);
    double size = 0, length = 0, volume = 0;
    for (std::size_t i = 0; i < n; ++i) {
      size = std::max(size, std::abs(b.radius[i] / 1e-3 - growth));
      volume = std::max(volume, std::abs(b.volume[i] / b.gas[i] - 1));
      for (std::size_t j = 0; j < i; ++j)
        length = std::max(length, std::abs((b.position[i] - b.position[j]).norm() / b.radius[i] - 1));
    }
    const auto row = [&](const char* quantity, const char* reference) {
      return ResultRow{.resolution = std::to_string(n) + " bubbles",
                       .quantity = quantity,
                       .reference = reference,
                       .source = "exact, minimal clusters"};
    };
    ResultRow radius = row("r/r0 off", n == 2 ? "1.058267" : n == 3 ? "1.105099" : "1.144843");
    ResultRow distance = row("l/r off", "1"), kept = row("volume error", "0");
    rows.push_back(aimAtMost(radius, size, 1e-6, "-"));
    rows.push_back(aimAtMost(distance, length, 1e-6, "-"));
    rows.push_back(aimAtMost(kept, volume, 1e-8, "-"));
    if (n == 2) continue;
    const AngleErrors errors(b);
    ResultRow films = row("angle between films off", "120 degrees"),
              borders = row("angle between borders off", "109.4712 degrees");
    rows.push_back(aimAtMost(films, errors.films, 0.01, "degrees"));
    if (n == 4) rows.push_back(aimAtMost(borders, errors.borders, 0.01, "degrees"));
  }
  return rows;
}

/// G2: an unequal pair beside the fixed point of the model and the true double bubble. The fixed point: balls
/// of radii a and b whose centres are l apart, l^2 = a^2 + b^2 - a b (Eq. 1, dry), and whose cells, cut by
/// the plane at (l^2 + a^2 - b^2) / (2 l) from the centre of a, have the volumes of balls of radius 1 and
/// 1/2.
std::vector<ResultRow> unequalPair(const StudyContext&) {
  constexpr double kLarge = 1.008870188279, kSmall = 0.599324341370, kApart = 0.878844845145;
  const foam::BubbleStore b = relaxedCluster({1e-3, 0.5e-3});
  const double large = b.radius[0] / 1e-3, small = b.radius[1] / 1e-3,
               length = (b.position[0] - b.position[1]).norm() / 1e-3;
  const double worst =
      std::max({std::abs(large - kLarge), std::abs(small - kSmall), std::abs(length - kApart)});
  ResultRow model{.quantity = "radii and distance off the model's fixed point",
                  .reference = "1.008870, 0.599324, 0.878845",
                  .source = "exact, flat films"};
  ResultRow truth{.quantity = "small radius off the true double bubble",
                  .reference = "0.578424",
                  .source = "exact, curved films",
                  .note = "flat films undersize the small bubble of a pair: the model's floor"};
  ResultRow apart{.quantity = "distance of the centres off the true double bubble",
                  .reference = "0.880244",
                  .source = "exact, curved films",
                  .note = truth.note};
  return {aimAtMost(model, worst, 1e-6, "-"), reportOnly(truth, 100 * (small / 0.578424 - 1), "%"),
          reportOnly(apart, 100 * (length / 0.880244 - 1), "%")};
}

/// Largest film [r^2] between bubbles that faced each other across a corner where more than four cells met:
/// the corners of an octahedron or, without the last, of a square pyramid, off by a millionth of a radius,
/// after a time.
double openedFilm(int corners) {
  constexpr double kRadius = 1e-3, kOff = 1e-6, kTime = 20, kStep = 0.005;  // [m], [r], [s], [s]
  const double half = 1.15 * kRadius / std::numbers::sqrt2;  // edges of about their rest length
  const Vector3d place[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  foam::BubbleStore bubbles;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(corners); ++i) {
    foam::CounterRandom random(5, i, 9);
    const Vector3d off = kOff * kRadius * (2 * randomVector(random).array() - 1);
    bubbles.add({.position = half * place[i] + off, .radius = kRadius, .type = foam::BubbleClass::air});
  }
  foam::FoamSolver solver(dryFoam());
  const foam::StillPool space = emptySpace();
  for (int step = 0; step * kStep < kTime; ++step) solver.step(bubbles, space, kStep);
  foam::FoamTopology cells;
  foam::PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, cells);
  double opened = 0;
  for (const foam::Film& film : cells.films)
    if (film.j == film.i + 1 && film.i % 2 == 0) opened = std::max(opened, film.area / (kRadius * kRadius));
  return opened;
}

/// G4: corners where more than four cells meet are not stable.
std::vector<ResultRow> corners(const StudyContext&) {
  constexpr double kOpen = 0.1;  // of r^2; the films about it have areas of 1 to 2
  const auto row = [](const char* of) {
    return ResultRow{.resolution = of,
                     .quantity = "film that opens within 20 s where more than four cells met",
                     .reference = "a corner of four cells at each end",
                     .source = "Plateau"};
  };
  ResultRow pyramid = row("square pyramid, 5 bubbles"), octahedron = row("octahedron, 6 bubbles");
  octahedron.note =
      "stays whole, also when started 0.3 r off: a stretched contact pulls with the share of its film, and "
      "here it has none; nor does border_rate open it, as its films meet at 120 degrees and plane ones have "
      "least area so";
  return {aimAtLeast(pyramid, openedFilm(5), kOpen, "r^2"),
          aimAtLeast(octahedron, openedFilm(6), kOpen, "r^2")};
}

/// Sites repeated to all sides of the box [0, period)^3, those of the box itself first.
struct PeriodicFoam {
  std::vector<Vector3d> position;
  std::vector<double> radius;
  std::vector<std::uint64_t> id;
  std::size_t inside;

  PeriodicFoam(const std::vector<Vector3d>& sites, const std::vector<double>& radii, double period)
      : inside(sites.size()) {
    for (const bool images : {false, true})
      for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
          for (int z = -1; z <= 1; ++z)
            if (images == (x != 0 || y != 0 || z != 0))
              for (std::size_t s = 0; s < sites.size(); ++s) {
                id.push_back(position.size());
                position.push_back(sites[s] + period * Vector3d(x, y, z)), radius.push_back(radii[s]);
              }
  }
  foam::FoamTopology cells() const {
    foam::FoamTopology topology;
    foam::PowerCells().compute(position, radius, id, topology);
    return topology;
  }
};

/// Area/V^(2/3) of the middle cell of Kelvin's lattice with soap films. The films at the lattice's border
/// stay plane; two cells further in they no longer matter.
double relaxedKelvin() {
  constexpr int kEdge = 5, kMiddle = 2 * (2 * kEdge * kEdge + 2 * kEdge + 2), kSegments = 4;
  foam::BubbleStore bubbles;
  for (int i = 0; i < kEdge; ++i)
    for (int j = 0; j < kEdge; ++j)
      for (int k = 0; k < kEdge; ++k)
        for (const double shift : {0.0, 0.5})
          bubbles.add({.position = Vector3d(i + shift, j + shift, k + shift), .radius = 0.7});
  const foam::SoapFilms films = foam::soapFilms(bubbles, kSegments, {.areaTolerance = 3e-6});
  double area = 0;
  for (const foam::NetworkFilm& film : films.network.films)
    if (film.i == kMiddle || film.j == kMiddle) area += films.network.areaOf(film);
  constexpr double kCellVolume = 0.5;  // of the lattice
  return area / std::pow(kCellVolume, 2.0 / 3);
}

/// G5: Kelvin's cells.
std::vector<ResultRow> kelvin(const StudyContext&) {
  const PeriodicFoam foam({{0, 0, 0}, {.5, .5, .5}}, {.6, .6}, 1);
  const foam::FoamTopology cells = foam.cells();
  const double exact = (6 + 12 * std::sqrt(3.0)) / std::pow(2.0, 7.0 / 3);  // edge a: V = 8 sqrt(2) a^3
  const double ratio = cells.filmArea[0] / std::pow(cells.volume[0], 2.0 / 3);
  ResultRow area{.resolution = "lattice, flat films",
                 .quantity = "area/V^(2/3) off",
                 .reference = "5.314740",
                 .source = "truncated octahedron"};
  ResultRow gap{.resolution = "lattice, flat films",
                .quantity = "above the relaxed foam",
                .reference = "5.306",
                .source = "Weaire and Phelan 1994"};
  ResultRow soap = gap;
  soap.resolution = "lattice, soap films";
  soap.note = "foam/soap_films, 16 triangles for every side of a film";
  constexpr double kRelaxed = 5.306;
  return {aimAtMost(area, ratio / exact - 1, 1e-10, "-"), reportOnly(gap, 100 * (ratio / kRelaxed - 1), "%"),
          aimAtMost(soap, 100 * std::abs(relaxedKelvin() / kRelaxed - 1), 0.03, "%")};
}

/// G6: the sites of Weaire and Phelan, with weights that make the volumes equal.
std::vector<ResultRow> weairePhelan(const StudyContext&) {
  const std::vector<Vector3d> sites{{0, 0, 0},  {1, 1, 1},   {.5, 0, 1}, {1.5, 0, 1},
                                    {0, 1, .5}, {0, 1, 1.5}, {1, .5, 0}, {1, 1.5, 0}};
  constexpr double kPeriod = 2, kVolume = 1;
  std::vector<double> weight(sites.size(), 0.9 * 0.9);
  double worst = 1, area = 0, faces = 0;
  for (int step = 0; step < 30 && worst > 1e-13; ++step) {
    std::vector<double> radii(sites.size());
    std::transform(weight.begin(), weight.end(), radii.begin(), [](double w) { return std::sqrt(w); });
    const PeriodicFoam foam(sites, radii, kPeriod);
    const foam::FoamTopology cells = foam.cells();
    // One weight for each of the two kinds of cell: their difference alone moves volume.
    double slope = 0;
    faces = area = 0;
    for (const foam::Film& film : cells.films) {
      const bool first = film.i < 8, second = film.j < 8;
      faces += first + second;
      const bool kindI = film.i % 8 < 2, kindJ = film.j % 8 < 2;
      if (kindI != kindJ && (first ? kindI : second && kindJ)) slope += film.area / (2 * film.distance);
    }
    worst = 0;
    for (std::size_t s = 0; s < 8; ++s)
      area += cells.filmArea[s] / 8, worst = std::max(worst, std::abs(cells.volume[s] - kVolume));
    const double change = slope > 0 ? 2 * (kVolume - cells.volume[0]) / slope : 0;
    weight[0] += change, weight[1] += change;
  }
  const auto row = [](const char* quantity, const char* reference) {
    return ResultRow{.resolution = "8 cells and their images",
                     .quantity = quantity,
                     .reference = reference,
                     .source = "Weaire and Phelan 1994"};
  };
  ResultRow volume = row("volumes off", "1"), mean = row("faces per cell off", "13.5"),
            films = row("area/V^(2/3)", "5.288 relaxed");
  return {aimAtMost(volume, worst, 1e-10, "-"), aimAtMost(mean, faces / 8 - 13.5, 1e-12, "-"),
          aimAtMost(films, area, 5.32, "-")};
}

}  // namespace

std::vector<Study> clusterStudies() {
  return {{"G1", "clusters of equal bubbles", 2, equalClusters},
          {"G2", "an unequal pair", 1, unequalPair},
          {"G4", "corners of more than four cells", 2, corners},
          {"G5", "Kelvin's foam", 1, kelvin},
          {"G6", "Weaire and Phelan's foam", 1, weairePhelan}};
}

}  // namespace spume::apps
