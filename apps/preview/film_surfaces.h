#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "apps/preview/bubble_cells.h"
#include "foam/soap_films.h"

namespace spume::apps {

/// The curved films of a foam as rays inside its bubbles meet them (Embree). They take the place of the plane
/// faces between cells; skins and walls stay as they are. Thread-safe.
class FilmSurfaces {
 public:
  /// `offset`: shortest distance a ray sees [m]. Throws std::runtime_error if the tracing library cannot
  /// start.
  FilmSurfaces(const foam::SoapFilms& films, std::size_t bubbles, float offset);

  struct Hit {
    float distance = 0;       ///< along the ray [m]
    int near = -1, far = -1;  ///< the bubbles before and behind the film
    Vec3 normal;              ///< unit, smooth, from near to far
    int film = -1;
  };
  /// The first film along a ray of unit `direction` up to `limit` [m]; false if there is none.
  bool meet(const Vec3& origin, const Vec3& direction, float limit, Hit& hit) const;

  /// The film's normal at `p`, with the rounding of a border of `width` [m] along its rim.
  Rounding rounded(const Hit& hit, const Vec3& p, float width) const;
  /// The same of a bubble's face at a wall, of unit normal `flat`: films stand on it.
  Rounding roundedAtWall(int bubble, const Vec3& p, const Vec3& flat, float width) const;

 private:
  using Node = std::int32_t;
  struct Stretch {
    Node from, to;
  };
  struct Film {
    int i, j;
    int firstStretch, endStretch;  ///< of its rim
  };
  struct ReleaseDevice {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  };
  struct ReleaseScene {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };

  void take(const foam::SoapFilms& films, std::size_t bubbles);
  void build();
  float towards(const Stretch* first, const Stretch* end, const Vec3& p, Vec3& nearest) const;

  std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice> device_;
  std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene> scene_;
  float offset_;
  std::vector<Vec3> node_;
  std::vector<Film> film_;
  std::vector<Stretch> stretch_;              ///< of all rims
  std::vector<std::vector<Stretch>> atWall_;  ///< of each bubble's films
  std::vector<std::array<Node, 3>> triangle_;
  std::vector<std::int32_t> filmOf_;         ///< of each triangle
  std::vector<std::array<Vec3, 3>> smooth_;  ///< unit normals at its corners, from i to j
};

}  // namespace spume::apps
