#include "foam/film_energy.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numeric>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

using Eigen::Vector3d;

/// kappa_c |dV_c/dx|^2: the stiffness of volumes over that of films, which is 2 to 5 at a node. A fifth of it
/// leaves volumes off for three more rounds.
constexpr double kVolumeStiffness = 20;
constexpr double kFlat = 1e-8;  ///< square of the share of a mean triangle below which area is rounded off
constexpr std::size_t kFilmsOfTask = 32;

/// First entries of rows of that many members, from their counts one place later.
void sumUp(std::vector<std::int32_t>& counts) {
  std::partial_sum(counts.begin(), counts.end(), counts.begin());
}

}  // namespace

FilmEnergy::FilmEnergy(const FilmNetwork& network, std::size_t bubbles)
    : network_(network), gained_(bubbles, 0), pressure_(bubbles, 0), stiffness_(bubbles, 0) {
  for (const FilmNode& node : network.nodes) start_.push_back(node.position);
  listSlots();
  listFilms(bubbles);
  areaPull_.resize(network.slots.size()), volumePull_.resize(network.slots.size());
  area_.resize(network.films.size()), swept_.resize(network.films.size()),
      flat_.assign(network.films.size(), 0);
  measure(start_);
  setStiffness();
}

double FilmEnergy::area() const { return std::accumulate(area_.begin(), area_.end(), 0.0); }

void FilmEnergy::correctPressures() {
  for (std::size_t c = 0; c < pressure_.size(); ++c) pressure_[c] = pressureOf(static_cast<std::int32_t>(c));
}

double FilmEnergy::at(const Columns& x, Columns& gradient) {
  measure(x);
  double energy = area();
  for (std::size_t c = 0; c < gained_.size(); ++c)
    energy -= (pressure_[c] - stiffness_[c] * gained_[c] / 2) * gained_[c];
  gather(gradient);
  return energy;
}

void FilmEnergy::listSlots() {
  const std::size_t nodes = network_.nodes.size(), slots = network_.slots.size();
  slotStart_.assign(nodes + 1, 0), slotOfNode_.resize(slots), filmOfSlot_.resize(slots);
  for (const std::int32_t node : network_.slots) ++slotStart_[node + 1];
  sumUp(slotStart_);
  std::vector<std::int32_t> next(slotStart_.begin(), slotStart_.end() - 1);
  for (std::size_t s = 0; s < slots; ++s)
    slotOfNode_[next[network_.slots[s]]++] = static_cast<std::int32_t>(s);
  for (std::size_t f = 0; f < network_.films.size(); ++f)
    for (std::int32_t s = network_.films[f].firstSlot; s < network_.films[f].endSlot; ++s)
      filmOfSlot_[s] = static_cast<std::int32_t>(f);
}

void FilmEnergy::listFilms(std::size_t bubbles) {
  filmStart_.assign(bubbles + 1, 0);
  for (const NetworkFilm& film : network_.films) ++filmStart_[film.i + 1], ++filmStart_[film.j + 1];
  sumUp(filmStart_);
  filmOfCell_.resize(filmStart_.back());
  std::vector<std::int32_t> next(filmStart_.begin(), filmStart_.end() - 1);
  for (std::size_t f = 0; f < network_.films.size(); ++f)
    for (const std::int32_t c : {network_.films[f].i, network_.films[f].j})
      filmOfCell_[next[c]++] = static_cast<std::int32_t>(f);
}

void FilmEnergy::measure(const Columns& x) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, network_.films.size(), kFilmsOfTask),
                    [&](const auto& range) {
                      for (std::size_t f = range.begin(); f != range.end(); ++f) measureFilm(f, x);
                    });
  forEachIndex(gained_.size(), [&](std::size_t c) {
    double sum = 0;
    for (std::int32_t e = filmStart_[c]; e < filmStart_[c + 1]; ++e) {
      const std::int32_t f = filmOfCell_[e];
      sum += network_.films[f].i == static_cast<std::int32_t>(c) ? swept_[f] : -swept_[f];
    }
    gained_[c] = sum;
  });
}

/// Area, its gradient by nodes, the volume the film has swept towards j, and that volume's gradient. A
/// triangle whose nodes go straight from their start sweeps the integral of their mean motion times its
/// area vector, a polynomial; what its three sides sweep, neighbours take back.
void FilmEnergy::measureFilm(std::size_t f, const Columns& x) {
  const NetworkFilm& film = network_.films[f];
  std::fill(areaPull_.begin() + film.firstSlot, areaPull_.begin() + film.endSlot, Vector3d::Zero());
  std::fill(volumePull_.begin() + film.firstSlot, volumePull_.begin() + film.endSlot, Vector3d::Zero());
  double area = 0, swept = 0;
  for (std::int32_t t = film.firstTriangle; t < film.endTriangle; ++t) {
    std::array<std::int32_t, 3> slot = network_.triangles[t];
    for (std::int32_t& s : slot) s += film.firstSlot;
    const std::array<std::int32_t, 3> node{network_.slots[slot[0]], network_.slots[slot[1]],
                                           network_.slots[slot[2]]};
    const Vector3d &a = x[node[0]], &b = x[node[1]], &c = x[node[2]];
    const Vector3d ab = b - a, ac = c - a, square = ab.cross(ac);
    const double twice = std::sqrt(square.squaredNorm() + flat_[f]);
    area += twice / 2;
    const Vector3d unit = square / twice, atB = ac.cross(unit) / 2, atC = unit.cross(ab) / 2;
    areaPull_[slot[1]] += atB, areaPull_[slot[2]] += atC, areaPull_[slot[0]] -= atB + atC;
    for (const std::int32_t s : slot) volumePull_[s] += square / 6;
    const Vector3d ua = a - start_[node[0]], ub = b - start_[node[1]], uc = c - start_[node[2]];
    const Vector3d db = ub - ua, dc = uc - ua, ab0 = ab - db, ac0 = ac - dc;
    const Vector3d mean = ab0.cross(ac0) + (ab0.cross(dc) + db.cross(ac0)) / 2 + db.cross(dc) / 3;
    swept += (ua + ub + uc).dot(mean) / 6;
  }
  area_[f] = area, swept_[f] = swept;
}

/// Needs the films measured at their start.
void FilmEnergy::setStiffness() {
  std::vector<double> norm2(stiffness_.size(), 0);
  for (std::size_t f = 0; f < network_.films.size(); ++f) {
    double sum = 0;
    for (std::int32_t s = network_.films[f].firstSlot; s < network_.films[f].endSlot; ++s)
      sum += volumePull_[s].squaredNorm();
    norm2[network_.films[f].i] += sum, norm2[network_.films[f].j] += sum;
  }
  for (std::size_t c = 0; c < norm2.size(); ++c)
    stiffness_[c] = norm2[c] > 0 ? kVolumeStiffness / norm2[c] : 0;
  for (std::size_t f = 0; f < area_.size(); ++f) {
    const double mean = area_[f] / (network_.films[f].endTriangle - network_.films[f].firstTriangle);
    flat_[f] = kFlat * mean * mean;
  }
}

void FilmEnergy::gather(Columns& gradient) const {
  gradient.resize(start_.size());
  forEachIndex(start_.size(), [&](std::size_t n) {
    const FilmNode& node = network_.nodes[n];
    Vector3d sum = Vector3d::Zero();
    if (node.hold != NodeHold::fixed)
      for (std::int32_t e = slotStart_[n]; e < slotStart_[n + 1]; ++e) {
        const std::int32_t s = slotOfNode_[e];
        const NetworkFilm& film = network_.films[filmOfSlot_[s]];
        sum += areaPull_[s] - (pressureOf(film.i) - pressureOf(film.j)) * volumePull_[s];
      }
    if (node.hold == NodeHold::plane) sum -= node.axis * node.axis.dot(sum);
    if (node.hold == NodeHold::line) sum = node.axis * node.axis.dot(sum);
    gradient[n] = sum;
  });
}

}  // namespace spume::foam
