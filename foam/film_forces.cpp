#include "foam/film_forces.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "foam/parallel.h"
#include "foam/volume_newton.h"

namespace spume::foam {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kBlock = 256;          ///< films a task takes; fixed, so that sums keep their order
constexpr double kPressureTolerance = 1e-6;  ///< relative residual

}  // namespace

void FilmForces::compute(const BubbleStore& bubbles, const FoamTopology& topology,
                         const Neighbours& neighbours, const std::vector<NearWalls>& walls,
                         const std::vector<double>& tension, const std::vector<double>& wetness,
                         const std::vector<char>& fixed) {
  const std::size_t n = bubbles.size();
  free_.resize(n), force_.assign(n, Vector3d::Zero()), byWeight_.resize(n);
  forEachIndex(n, [&](std::size_t i) { free_[i] = freeTension(tension[i], wetness[i]); });
  trace(bubbles, topology, neighbours, walls, tension);
  addPulls(bubbles, topology);
  solveWeightChanges(topology, neighbours, bubbles.radius, byWeight_, fixed, kPressureTolerance, pressure_);
  forEachIndex(n, [&](std::size_t i) {
    force_[i] += pressureOn(static_cast<std::int32_t>(i), bubbles, topology, neighbours);
  });
}

void FilmForces::trace(const BubbleStore& bubbles, const FoamTopology& topology, const Neighbours& neighbours,
                       const std::vector<NearWalls>& walls, const std::vector<double>& tension) {
  const std::size_t films = topology.films.size();
  face_.resize(films), pulls_.resize((films + kBlock - 1) / kBlock);
  tbb::parallel_for(std::size_t{0}, pulls_.size(), [&](std::size_t block) {
    FilmOutlines outlines(bubbles, topology, neighbours, walls);
    FilmOutline outline;
    pulls_[block].clear();
    for (std::size_t f = block * kBlock; f < std::min(films, (block + 1) * kBlock); ++f) {
      const Film& film = topology.films[f];
      face_[f] = {Vector3d::Zero(), Vector3d::Zero()};
      if (tension[film.i] == 0 && tension[film.j] == 0) continue;
      outlines.trace(film, outline);
      face_[f] = {outline.normal, outline.moment};
      addFilm(film, outline, bubbles, tension, pulls_[block]);
    }
  });
}

void FilmForces::addFilm(const Film& film, const FilmOutline& outline, const BubbleStore& bubbles,
                         const std::vector<double>& tension, std::vector<TensionPull>& pulls) const {
  const double ofFilm = std::min(tension[film.i], tension[film.j]);
  if (ofFilm > 0) addEdgeTension(film, outline, ofFilm, bubbles.position, pulls);
  addArcTension(film, outline, ofFilm, free_[film.i], free_[film.j], bubbles.position, bubbles.radius, pulls);
}

/// Free surfaces: dS = (2/r)(S/(2r)) dw where the sphere swells; their rims are the films' arcs.
void FilmForces::addPulls(const BubbleStore& bubbles, const FoamTopology& topology) {
  forEachIndex(byWeight_.size(), [&](std::size_t i) {
    byWeight_[i] = free_[i] * topology.freeArea[i] / (bubbles.radius[i] * bubbles.radius[i]);
  });
  for (const auto& block : pulls_)
    for (const TensionPull& pull : block)
      force_[pull.bubble] += pull.force, byWeight_[pull.bubble] += pull.byWeight;
}

/// A film moves with both its bubbles, v . n = [(y - x_i) . dx_i - (y - x_j) . dx_j]/d; what a bubble gains
/// there the other loses. A free surface moves with its own, and the gas pushes on it against its tension,
/// p - 2 T/r; its vector area is what the films leave of a closed surface. Beside a solid it is taken for
/// the free surface and the face on the solid together.
Vector3d FilmForces::pressureOn(std::int32_t i, const BubbleStore& bubbles, const FoamTopology& topology,
                                const Neighbours& neighbours) const {
  Vector3d sum = Vector3d::Zero(), areas = Vector3d::Zero();
  for (std::int32_t e = neighbours.start[i]; e < neighbours.start[i + 1]; ++e) {
    const std::int32_t f = topology.overlaps[neighbours.pair[e]].film;
    if (f < 0) continue;
    const Film& film = topology.films[f];
    const bool first = film.i == i;
    const double height = first ? film.height : film.distance - film.height;
    const Vector3d away = first ? face_[f].normal : Vector3d(-face_[f].normal);
    const double jump = (pressure_[i] - pressure_[first ? film.j : film.i]) / film.distance;
    sum += jump * (film.area * height * away + face_[f].moment);
    areas += film.area * away;
  }
  const double excess = pressure_[i] - 2 * free_[i] / bubbles.radius[i];
  return topology.freeArea[i] > 0 ? Vector3d(sum - excess * areas) : sum;
}

}  // namespace spume::foam
