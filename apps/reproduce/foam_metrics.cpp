#include "apps/reproduce/foam_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "apps/reproduce/csv_reader.h"
#include "foam/power_cells.h"

namespace spume::apps {
namespace {

/// Of the way along a vertical line, in radii of the smallest bubble near it: no cell worth counting is
/// thinner.
constexpr double kLineStep = 0.05;

std::vector<std::uint8_t> touchesAnother(std::size_t bubbles, const foam::FoamTopology& topology) {
  std::vector<std::uint8_t> touches(bubbles, 0);
  for (const foam::Film& film : topology.films) touches[film.i] = touches[film.j] = 1;
  return touches;
}

double ratio(std::size_t part, std::size_t whole) {
  return whole ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

/// Time a bubble has spent out of the water.
struct Outing {
  double since = -1;  ///< when it came up; < 0: it is under water [s]
  double before = 0;  ///< earlier outings [s]
};

/// Follows the outings of all bubbles through the rows of events.csv.
class Outings {
 public:
  void place(const std::string& id, bool submerged, double time) {
    Outing& outing = outings_[id];
    if (submerged && outing.since >= 0) outing.before += time - outing.since;
    if (submerged)
      outing.since = -1;
    else if (outing.since < 0)
      outing.since = time;
  }
  double lengthAt(const std::string& id, double time) {
    const Outing& outing = outings_[id];
    return outing.before + (outing.since < 0 ? 0 : time - outing.since);
  }
  void forget(const std::string& id) { outings_.erase(id); }

 private:
  std::unordered_map<std::string, Outing> outings_;
};

}  // namespace

SurfaceCensus surfaceCensus(const foam::BubbleStore& bubbles, const Eigen::VectorXd& toSolids) {
  foam::FoamTopology topology;
  foam::PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, topology);
  const std::vector<std::uint8_t> touches = touchesAnother(bubbles.size(), topology);
  std::size_t clustered = 0, atWalls = 0, submerged = 0, clinging = 0;
  SurfaceCensus census;
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    const bool near = toSolids[static_cast<Eigen::Index>(i)] < kNearWall * bubbles.radius[i];
    if (bubbles.type[i] == foam::BubbleClass::liquid) ++submerged, clinging += near;
    if (bubbles.type[i] != foam::BubbleClass::surface) continue;
    ++census.floating;
    clustered += touches[i];
    atWalls += near;
  }
  census.clustered = ratio(clustered, census.floating);
  census.atWalls = ratio(atWalls, census.floating);
  census.clinging = ratio(clinging, submerged);
  return census;
}

int layersAlong(const foam::BubbleStore& bubbles, const foam::FoamTopology& topology, double x, double z) {
  const std::vector<std::uint8_t> touches = touchesAnother(bubbles.size(), topology);
  struct Crossed {
    double height, power;  ///< of the centre; squared distance to the line less the weight [m], [m^2]
    double half;           ///< of the chord inside the ball [m]
  };
  std::vector<Crossed> crossed;
  double low = std::numeric_limits<double>::infinity(), high = -low, step = low;
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    const Eigen::Vector3d& p = bubbles.position[i];
    const double r = bubbles.radius[i], power = std::pow(p.x() - x, 2) + std::pow(p.z() - z, 2) - r * r;
    if (power >= 0 || !touches[i]) continue;
    const double half = std::sqrt(-power);
    crossed.push_back({p.y(), power, half});
    low = std::min(low, p.y() - half), high = std::max(high, p.y() + half),
    step = std::min(step, kLineStep * r);
  }
  std::vector<std::uint8_t> owns(crossed.size(), 0);
  for (double y = low; y <= high; y += step) {
    double least = 0;  // outside all balls the power distance is positive
    std::size_t owner = crossed.size();
    for (std::size_t c = 0; c < crossed.size(); ++c)
      if (const double power = std::pow(y - crossed[c].height, 2) + crossed[c].power; power < least)
        least = power, owner = c;
    if (owner < crossed.size()) owns[owner] = 1;
  }
  return static_cast<int>(std::count(owns.begin(), owns.end(), 1));
}

std::size_t insideSolids(const foam::BubbleStore& bubbles, const Eigen::VectorXd& toSolids) {
  std::size_t inside = 0;
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    inside += toSolids[static_cast<Eigen::Index>(i)] < -kInside * bubbles.radius[i];
  return inside;
}

double deepestInSolids(const foam::BubbleStore& bubbles, const Eigen::VectorXd& toSolids) {
  double deepest = 0;
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    deepest = std::max(deepest, -toSolids[static_cast<Eigen::Index>(i)] / bubbles.radius[i]);
  return deepest;
}

BubbleBooks readBooks(const std::string& eventsPath) {
  CsvReader events(eventsPath);
  const std::size_t time = events.column("time"), kind = events.column("kind"), id = events.column("id"),
                    cause = events.column("cause"), to = events.column("to");
  BubbleBooks books;
  Outings outings;
  while (events.next()) {
    const std::string_view what = events.text(kind);
    const std::string who(events.text(id));
    if (what == "birth" || what == "class") {
      books.born += what == "birth";
      outings.place(who, events.text(to) == "liquid", events.number(time));
      continue;
    }
    ++books.ended;
    books.left += what == "leave";
    if (what == "burst" && events.text(cause) == "age")
      books.surfaceLives.push_back(outings.lengthAt(who, events.number(time)));
    outings.forget(who);
  }
  return books;
}

double medianOf(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace spume::apps
