#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "coupling/liquid_cache.h"
#include "foam/soap_films.h"

namespace spume::coupling {

/// Writes films.####.ply: the films of a foam as one triangle mesh in metres, whose vertices films share
/// where they meet. Every face holds the ids of its two bubbles, its normal from id_a to id_b, and the film's
/// curvature 1/R [1/m], > 0 where it bulges towards id_b. `ids` of the bubbles. Atomic. Throws FileError.
void writeFilmsPly(const std::string& path, const foam::SoapFilms& films,
                   const std::vector<std::uint64_t>& ids, const FrameStamp& stamp);

/// What such a mesh holds.
struct FilmTotals {
  std::size_t films = 0, triangles = 0, vertices = 0;
  double area = 0;  ///< of one side [m^2]
};

/// Throws FileError (cannot be opened) or SceneError (not such a file, or cut off).
FilmTotals readFilmTotals(const std::string& path);

}  // namespace spume::coupling
