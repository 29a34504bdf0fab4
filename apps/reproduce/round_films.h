#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "apps/reproduce/plateau_angles.h"
#include "foam/bubble_store.h"
#include "foam/liquid_sampler.h"

namespace spume::apps {

/// How far the films of a foam would lean out of their planes were they as round as the pressures of their
/// cells demand. The model's films are plane; those of soap bulge into the cell of lower pressure, and it is
/// their tangents that meet at 120 degrees. A film of tension T, area A and rim P under a pressure jump leans
/// by the jump times A / (T P) on the mean of its rim, as all it carries hangs there.
class RoundFilms {
 public:
  /// Pressures are those that hold the volumes of all cells against the tension of films and free surfaces
  /// (foam::FilmForces); bubbles of `wetness` as in the store.
  RoundFilms(const foam::BubbleStore& bubbles, const foam::LiquidSampler& liquid);

  /// Lean of the film of these two where they have one, > 0 if it bulges into `other` [degrees].
  double lean(std::int32_t bubble, std::int32_t other) const;
  /// The films' angles of `measured` with both films of each leaning [degrees]; its borders as they are.
  PlateauAngles angles(const PlateauAngles& measured) const;

 private:
  std::map<std::pair<std::int32_t, std::int32_t>, double> lean_;  ///< of bubbles i < j
};

}  // namespace spume::apps
