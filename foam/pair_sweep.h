#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "foam/cell_hash.h"

namespace spume::foam {

/// All pairs of balls nearer to each other than a multiple of the sum of their radii. Space is cut into rods
/// along x, square in section, a set of them for every two radius octaves; the balls of a rod are sorted by x
/// and swept against those of the rods around, and of coarser sets (performance, "Foam geometry"). O(n) for
/// bounded numbers of neighbours, at any ratio of radii.
class PairSweep {
 public:
  using Pairs = std::vector<std::pair<std::int32_t, std::int32_t>>;

  /// Sorts the balls at `position` [m] with `radius` [m, > 0]. Near is a distance below `reach` (r_i + r_j).
  PairSweep(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius, double reach);

  /// Every near pair once, by input index, in lists whose order and lengths depend on the threads.
  std::vector<Pairs> find() const;

 private:
  struct Level {
    int number;              ///< from small balls to large
    double side, maxRadius;  ///< of the rods' section; of the balls [m]
  };
  struct Rod {
    std::uint64_t key;
    std::int32_t begin, end;  ///< in the order of the sweep
    std::int32_t level;       ///< index in level_
    double low[2], high[2];   ///< of the centres' y and z [m]
    double maxRadius;         ///< [m]
  };
  struct Section {
    std::int64_t y, z;
  };

  int numberOf(double radius) const;
  void findLevels(const std::vector<double>& radius);
  std::uint64_t keyOf(const Level& level, const Section& section) const;
  Section sectionOf(const Level& level, double y, double z) const;
  void sort(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius);
  void cutRods(const std::vector<std::uint64_t>& keys);
  void sweepAround(const Rod& rod, Pairs& pairs) const;
  void sweep(const Rod& rod, const Rod& other, Pairs& pairs) const;

  double reach_;
  int topOctave_ = 0;
  double lowY_ = 0, lowZ_ = 0;  ///< of all centres [m]
  std::vector<Level> level_;    ///< those that hold balls
  /// The balls in the order of the sweep, by size, rod and x: input index, centre and radius [m], padded for
  /// whole lanes.
  std::vector<std::int32_t> index_;
  std::vector<double> x_, y_, z_, r_;
  std::vector<Rod> rod_;  ///< in the order of their balls
  CellHash rodAt_;        ///< place in rod_ by key
};

}  // namespace spume::foam
