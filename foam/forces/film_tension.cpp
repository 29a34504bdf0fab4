#include "foam/forces/film_tension.h"

#include <cmath>

namespace spume::foam {

using Eigen::Vector3d;

double freeTension(double filmTension, double wetness) { return filmTension / std::sqrt(1 + 3 * wetness); }

void addEdgeTension(const Film& film, const FilmOutline& outline, double tension,
                    const std::vector<Vector3d>& position, std::vector<TensionPull>& pulls) {
  TensionPull first{film.i, Vector3d::Zero(), 0}, second{film.j, Vector3d::Zero(), 0};
  for (const FilmEdge& edge : outline.edges) {
    // The normal out of the film is (step - lean (x_j - x_i)) / reach; the force is against it.
    const double byThird = -tension * edge.length / edge.reach, bySecond = -byThird * edge.lean;
    const double byFirst = edge.third >= 0 ? bySecond + byThird : bySecond;
    first.force += byFirst * (edge.middle - position[film.i]);
    second.force -= bySecond * (edge.middle - position[film.j]);
    first.byWeight -= byFirst / 2, second.byWeight += bySecond / 2;
    if (edge.third >= 0)
      pulls.push_back({edge.third, -byThird * (edge.middle - position[edge.third]), byThird / 2});
  }
  pulls.push_back(first), pulls.push_back(second);
}

void addArcTension(const Film& film, const FilmOutline& outline, double tension, double freeI, double freeJ,
                   const std::vector<Vector3d>& position, const std::vector<double>& radius,
                   std::vector<TensionPull>& pulls) {
  if (!(outline.arc > 0 && outline.discRadius > 0)) return;
  const double d = film.distance, heightI = film.height, heightJ = d - film.height;
  const double byRadiusI = freeI / radius[film.i], byRadiusJ = freeJ / radius[film.j];
  // Normals out of the three surfaces, times their tensions: along the disc's radius, over it, and along the
  // line of centres, over d. A point c + q of the arc is heightJ/d of the way from x_i, the rest from x_j.
  const double outward = (tension - byRadiusI * heightI - byRadiusJ * heightJ) / outline.discRadius;
  const double along = (byRadiusI - byRadiusJ) * outline.discRadius / d;
  const double shareI = outward * heightJ / d + along, shareJ = outward * heightI / d - along;
  const double length = outline.discRadius * outline.arc;
  const Vector3d arms = outline.discRadius * outline.arcPull;  // integral of y - c
  pulls.push_back(
      {film.i, -shareI * (arms + length * (outline.centre - position[film.i])), shareI * length / 2});
  pulls.push_back(
      {film.j, -shareJ * (arms + length * (outline.centre - position[film.j])), shareJ * length / 2});
}

}  // namespace spume::foam
