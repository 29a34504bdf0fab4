#include "apps/reproduce/plateau_angles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace spume::apps {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFilmAngle = 120;
const double kBorderAngle = std::acos(-1.0 / 3) * 180 / std::numbers::pi;

/// Borders shorter than this share of the film's disc are round-off of a point where more than four cells
/// meet.
constexpr double kShortest = 1e-7;

double degreesBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

double rmsFrom(const std::vector<double>& values, double centre) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (const double v : values) sum += (v - centre) * (v - centre);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Contacts of every bubble, ascending.
std::vector<std::vector<std::int32_t>> contactsOf(std::size_t bubbles, const foam::FoamTopology& topology) {
  std::vector<std::vector<std::int32_t>> contacts(bubbles);
  for (const foam::Film& film : topology.films) {
    contacts[film.i].push_back(film.j);
    contacts[film.j].push_back(film.i);
  }
  for (auto& list : contacts) std::sort(list.begin(), list.end());
  return contacts;
}

/// A third bubble seen in the plane of a film: the film lies where a.q <= b, q measured from the disc's
/// centre.
struct Cut {
  std::int32_t bubble;
  Vector2d a;
  double b;
};

/// A stretch of the line a.q = b; an end holds the bubble whose cell ends it, or -1 if the disc does.
struct Stretch {
  double from, to;
  std::int32_t beforeFrom = -1, afterTo = -1;
};

Stretch stretchOf(const std::vector<Cut>& cuts, const Cut& line, double discRadius2) {
  const double a2 = line.a.squaredNorm(), half2 = discRadius2 - line.b * line.b / a2;
  const Vector2d foot = line.a * (line.b / a2), along = Vector2d(-line.a.y(), line.a.x()) / std::sqrt(a2);
  const double half = half2 > 0 ? std::sqrt(half2) : -1;
  Stretch stretch{-half, half};
  for (const Cut& other : cuts) {
    if (other.bubble == line.bubble) continue;
    const double slope = other.a.dot(along), room = other.b - other.a.dot(foot);
    if (slope > 0 && room / slope < stretch.to)
      stretch.to = room / slope, stretch.afterTo = other.bubble;
    else if (slope < 0 && room / slope > stretch.from)
      stretch.from = room / slope, stretch.beforeFrom = other.bubble;
    else if (slope == 0 && room < 0)
      stretch.to = stretch.from;
  }
  return stretch;
}

/// Films stand square on the lines of centres: inside cell a two of them meet at 180 degrees less the angle
/// of the triangle of centres at a.
void addFilmAngles(const std::array<Vector3d, 3>& centre, std::vector<double>& angles) {
  for (int a = 0; a < 3; ++a)
    angles.push_back(180 - degreesBetween(centre[(a + 1) % 3] - centre[a], centre[(a + 2) % 3] - centre[a]));
}

/// The border of three cells runs square to their triangle, away from the fourth.
void addBorderAngles(const std::array<Vector3d, 4>& centre, std::vector<double>& angles) {
  std::array<Vector3d, 4> border;
  for (int away = 0; away < 4; ++away) {
    const Vector3d& a = centre[(away + 1) % 4];
    const Vector3d square = (centre[(away + 2) % 4] - a).cross(centre[(away + 3) % 4] - a);
    border[away] = square.dot(centre[away] - a) > 0 ? Vector3d(-square) : square;
  }
  for (int a = 0; a < 4; ++a)
    for (int b = a + 1; b < 4; ++b) angles.push_back(degreesBetween(border[a], border[b]));
}

/// Four centres at Plateau's distances; false if there is no such tetrahedron. The first three always have
/// their triangle.
bool placeAtRest(const std::array<double, 4>& radius, std::array<Vector3d, 4>& centre) {
  const auto length2 = [&](int a, int b) {
    return radius[a] * radius[a] + radius[b] * radius[b] - radius[a] * radius[b];
  };
  const double base = std::sqrt(length2(0, 1));
  const auto along = [&](int c) { return (length2(0, c) + base * base - length2(1, c)) / (2 * base); };
  const double x = along(2), y = std::sqrt(length2(0, 2) - x * x);
  const double u = along(3), v = ((length2(0, 3) + length2(0, 2) - length2(2, 3)) / 2 - u * x) / y;
  const double w2 = length2(0, 3) - u * u - v * v;
  centre = {Vector3d(0, 0, 0), Vector3d(base, 0, 0), Vector3d(x, y, 0), Vector3d(u, v, std::sqrt(w2))};
  return w2 > 0;
}

/// Collects the angles of a foam, border by border.
class Collector {
 public:
  Collector(const std::vector<Vector3d>& position, const std::vector<double>& radius,
            const foam::FoamTopology& topology, const std::vector<std::uint8_t>& wanted)
      : position_(position),
        radius_(radius),
        wanted_(wanted),
        contacts_(contactsOf(position.size(), topology)) {}

  /// The borders of a film whose third bubble has the highest index, and their points whose fourth is higher
  /// still: each border and each point is met once.
  void add(const foam::Film& film) {
    if (!wanted_[film.i] || !wanted_[film.j]) return;
    const std::vector<Cut> cuts = cutsOf(film);
    const double disc2 = radius_[film.i] * radius_[film.i] - film.height * film.height;
    for (const Cut& cut : cuts) {
      if (cut.bubble < film.j || !wanted_[cut.bubble] || cut.a.squaredNorm() == 0) continue;
      const Stretch stretch = stretchOf(cuts, cut, disc2);
      if (stretch.to - stretch.from < kShortest * std::sqrt(std::max(disc2, 0.0))) continue;
      addBorder(film.i, film.j, cut.bubble);
      for (const std::int32_t fourth : {stretch.beforeFrom, stretch.afterTo})
        if (fourth > cut.bubble && wanted_[fourth]) addPoint({film.i, film.j, cut.bubble, fourth});
    }
  }

  int bordersOf(const foam::Film& film) const {
    const std::vector<Cut> cuts = cutsOf(film);
    const double disc2 = radius_[film.i] * radius_[film.i] - film.height * film.height;
    return static_cast<int>(std::count_if(cuts.begin(), cuts.end(), [&](const Cut& cut) {
      const Stretch stretch = stretchOf(cuts, cut, disc2);
      return cut.a.squaredNorm() > 0 && stretch.to > stretch.from;
    }));
  }

  PlateauAngles angles;

 private:
  std::vector<Cut> cutsOf(const foam::Film& film) const {
    std::vector<std::int32_t> common;
    std::set_intersection(contacts_[film.i].begin(), contacts_[film.i].end(), contacts_[film.j].begin(),
                          contacts_[film.j].end(), std::back_inserter(common));
    const Vector3d& near = position_[film.i];
    const Vector3d normal = (position_[film.j] - near) / film.distance, u = normal.unitOrthogonal(),
                   v = normal.cross(u);
    std::vector<Cut> cuts;
    for (const std::int32_t k : common) {
      const Vector3d e = position_[k] - near;
      const double plane = (e.squaredNorm() + std::pow(radius_[film.i], 2) - std::pow(radius_[k], 2)) / 2;
      cuts.push_back({k, {u.dot(e), v.dot(e)}, plane - film.height * normal.dot(e)});
    }
    return cuts;
  }

  void addBorder(std::int32_t i, std::int32_t j, std::int32_t k) {
    angles.bordersCells.push_back({i, j, k});
    addFilmAngles({position_[i], position_[j], position_[k]}, angles.films);
  }
  void addPoint(const std::array<std::int32_t, 4>& cells) {
    angles.pointsCells.push_back(cells);
    addBorderAngles({position_[cells[0]], position_[cells[1]], position_[cells[2]], position_[cells[3]]},
                    angles.borders);
  }

  const std::vector<Vector3d>& position_;
  const std::vector<double>& radius_;
  const std::vector<std::uint8_t>& wanted_;
  const std::vector<std::vector<std::int32_t>> contacts_;
};

template <std::size_t N>
bool areWanted(const std::array<std::int32_t, N>& bubbles, const std::vector<std::uint8_t>& wanted) {
  return std::all_of(bubbles.begin(), bubbles.end(), [&](std::int32_t b) { return wanted[b] != 0; });
}

/// Directions that meet in one place, noted one after the other.
template <std::size_t N>
struct Meeting {
  std::array<Vector3d, N> direction;
  std::size_t count = 0;

  void add(const Vector3d& d) {
    if (count < N) direction[count] = d;
    ++count;
  }
  void addAngles(std::vector<double>& angles) const {
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t b = a + 1; b < N; ++b) angles.push_back(degreesBetween(direction[a], direction[b]));
  }
};

/// Where a film goes from each stretch of its borders: square to it, in the triangle along it.
void addFilmAngles(const foam::FilmNetwork& network, const std::vector<std::uint8_t>& wanted,
                   PlateauAngles& angles) {
  std::vector<std::vector<Meeting<3>>> stretches(network.borders.size());
  for (std::size_t b = 0; b < network.borders.size(); ++b)
    stretches[b].resize(network.borders[b].nodes.size() - 1);
  for (const foam::NetworkFilm& film : network.films)
    for (std::int32_t s = 0; s < film.rim; ++s) {
      const auto [border, stretch] = network.borderOfSlot[film.firstSlot + s];
      if (border < 0) continue;
      const Vector3d& from = network.at(film, s);
      const Vector3d along = (network.at(film, (s + 1) % film.rim) - from).normalized();
      const Vector3d inward = network.at(film, network.triangles[film.firstTriangle + s][2]) - from;
      stretches[border][stretch].add(inward - along * along.dot(inward));
    }
  for (std::size_t b = 0; b < network.borders.size(); ++b) {
    if (!areWanted(network.borders[b].bubbles, wanted)) continue;
    for (const Meeting<3>& meeting : stretches[b]) {
      if (meeting.count != 3) continue;  // films that do not fit together
      angles.bordersCells.push_back(network.borders[b].bubbles);
      meeting.addAngles(angles.films);
    }
  }
}

void addBorderAngles(const foam::FilmNetwork& network, const std::vector<std::uint8_t>& wanted,
                     PlateauAngles& angles) {
  std::vector<Meeting<4>> meetings(network.nodes.size());
  for (const foam::FilmBorder& border : network.borders) {
    const std::vector<std::int32_t>& nodes = border.nodes;
    const auto add = [&](std::int32_t end, std::int32_t next) {
      meetings[end].add(network.nodes[next].position - network.nodes[end].position);
    };
    add(nodes.front(), nodes[1]), add(nodes.back(), nodes[nodes.size() - 2]);
  }
  for (const foam::FilmPoint& point : network.points) {
    if (!areWanted(point.bubbles, wanted) || meetings[point.node].count != 4) continue;
    angles.pointsCells.push_back(point.bubbles);
    meetings[point.node].addAngles(angles.borders);
  }
}

}  // namespace

double PlateauAngles::filmSpread() const { return rmsFrom(films, kFilmAngle); }
double PlateauAngles::borderSpread() const { return rmsFrom(borders, kBorderAngle); }

PlateauAngles plateauAngles(const std::vector<Vector3d>& position, const std::vector<double>& radius,
                            const foam::FoamTopology& topology, const std::vector<std::uint8_t>& wanted) {
  Collector collector(position, radius, topology, wanted);
  for (const foam::Film& film : topology.films) collector.add(film);
  return std::move(collector.angles);
}

PlateauAngles plateauAngles(const foam::FilmNetwork& network, const std::vector<std::uint8_t>& wanted) {
  PlateauAngles angles;
  addFilmAngles(network, wanted, angles);
  addBorderAngles(network, wanted, angles);
  return angles;
}

PlateauAngles anglesAtRest(const std::vector<double>& radius, const PlateauAngles& measured) {
  PlateauAngles rest;
  std::array<Vector3d, 4> centre;
  for (const auto& cells : measured.bordersCells) {
    placeAtRest({radius[cells[0]], radius[cells[1]], radius[cells[2]], radius[cells[0]]}, centre);
    rest.bordersCells.push_back(cells);
    addFilmAngles({centre[0], centre[1], centre[2]}, rest.films);
  }
  for (const auto& cells : measured.pointsCells) {
    if (!placeAtRest({radius[cells[0]], radius[cells[1]], radius[cells[2]], radius[cells[3]]}, centre))
      continue;
    rest.pointsCells.push_back(cells);
    addBorderAngles(centre, rest.borders);
  }
  return rest;
}

std::vector<int> bordersOfFilms(const std::vector<Vector3d>& position, const std::vector<double>& radius,
                                const foam::FoamTopology& topology) {
  const std::vector<std::uint8_t> all(position.size(), 1);
  const Collector collector(position, radius, topology, all);
  std::vector<int> borders;
  for (const foam::Film& film : topology.films) borders.push_back(collector.bordersOf(film));
  return borders;
}

}  // namespace spume::apps
