#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "foam/disc_lines.h"
#include "foam/radical_plane.h"
#include "foam/raw_buffer.h"

namespace spume::foam {

/// A ball of a foam as the local engine reads it, by rank: all that is read of a neighbour in a cache line.
struct alignas(64) RankedBall {
  double x, y, z;      ///< the centre [m]
  TieBrokenBall ball;  ///< whose radius decides
  double visible;      ///< 0: its ball is hidden and cuts nothing; else 1
  std::int32_t index;  ///< in the input
};

/// What the neighbours of one ball are to it: which of its candidates overlap it, and the radical planes with
/// those that can cut it. Distances have the same bits seen from either ball.
struct NeighbourPlanes {
  /// The neighbours that may overlap a ball.
  struct Candidates {
    const std::int32_t* rank;  ///< by ascending input index; padded for whole lanes, as the next
    const std::int32_t* pair;  ///< number of the pair
    std::size_t count, lower;  ///< how many; of lower input index than the ball
    std::size_t bubbles;       ///< how many, from the first, are bubbles and not only cut the ball
  };

  std::size_t overlaps = 0, lower = 0;  ///< candidates that overlap; of lower input index
  std::vector<std::int32_t> index;      ///< input index of each overlap
  std::vector<std::int32_t> link;       ///< twice the number of its pair, odd if the ball is its owner
  std::vector<std::int32_t> planeOf;    ///< its plane, or -1: one of the two balls is hidden
  std::vector<double> distance;         ///< of the centres [m]

  CuttingPlanes planes;
  std::vector<double> radius;     ///< of the ball behind each plane [m]
  std::vector<double> farHeight;  ///< signed distance of the plane from its centre [m]
  bool centreInside = true;       ///< no plane cuts this ball's centre away

  /// For ball s, a bubble. The smaller ball of a pair is the owner; of two that are the same the one of lower
  /// input index; of a bubble and one that is none the bubble, which alone knows all that cut their disc.
  void find(const RawBuffer<RankedBall>& balls, std::int32_t s, const Candidates& candidates);

 private:
  /// The candidates as columns.
  struct Gathered {
    std::vector<double> x, y, z, radius, weightShift, visible;
    std::vector<std::int32_t> index, link;
  };
  /// From one ball to a block of others.
  struct Block {
    Lanes x, y, z, distance, radius;
  };

  void reserve(std::size_t count);
  void gather(const RawBuffer<RankedBall>& balls, const Candidates& candidates);
  void addOverlaps(std::size_t k, const Block& to, double ownRadius, const Candidates& candidates);
  void addPlanes(std::size_t k, const Block& to, const TieBrokenBall& own, std::uint32_t cutting);

  Gathered from_;
  std::uint32_t touching_ = 0;  ///< bits of the block at hand
};

}  // namespace spume::foam
