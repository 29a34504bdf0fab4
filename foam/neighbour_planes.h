#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "foam/disc_lines.h"
#include "foam/radical_plane.h"
#include "foam/raw_buffer.h"

namespace spume::foam {

/// The balls of a foam as the passes of the local engine read them, by rank: what is read together of a
/// neighbour lies together.
struct RankedBalls {
  struct Place {
    double x, y, z, radius;  ///< the centre and the radius that decides ties [m]
  };
  RawBuffer<Place> place;
  RawBuffer<double> radiusShift, weightShift;  ///< as in TieBrokenBall

  void resize(std::size_t balls) {
    place.resize(balls), radiusShift.resize(balls), weightShift.resize(balls);
  }
  TieBrokenBall ball(std::int32_t s) const;
};

/// Distances between one ball and others, a block of lanes at a time; the same bits seen from either ball.
struct NeighbourDistances {
  std::size_t count = 0;
  std::vector<double> x, y, z;   ///< of the others' centres from the ball's [m]
  std::vector<double> radius;    ///< of the others [m]
  std::vector<double> distance;  ///< of the centres [m]

  /// Measures from ball s to `count` others. Padding lanes hold numbers that mean nothing.
  void measure(const RankedBalls& balls, std::int32_t s, const std::int32_t* others, std::size_t count);
};

/// The radical planes of one ball with others, seen from both sides.
struct NeighbourPlanes {
  NeighbourDistances to;
  CuttingPlanes planes;
  std::vector<double> farHeight;    ///< signed distance of each plane from the other's centre [m]
  std::vector<double> weightShift;  ///< of the others [m^2]

  /// As NeighbourDistances::measure; a plane between coincident centres means nothing.
  void find(const RankedBalls& balls, std::int32_t s, const std::int32_t* others, std::size_t count);
};

}  // namespace spume::foam
