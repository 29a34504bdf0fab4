#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/pair_rows.h"

namespace spume::foam {

/// For every bubble the others near enough to overlap it now or soon: a Verlet list. Two bubbles are
/// candidates when their distance is below (1 + kSkin)(r_i + r_j) at the time of building, so the list holds
/// until a bubble has |dx| + |dr| > kSkin r, with or without the mean dx of all taken off. Building is O(n)
/// in the number of bubbles: a hierarchical grid with one level per radius octave finds each pair from its
/// smaller bubble (performance, "Foam geometry").
///
/// Bubbles are numbered here by *rank*: sorted by radius octave, then Morton cell, so that neighbours are
/// near in memory. Rows list candidates by input index, so that what is summed along a row does not depend on
/// when the list was built.
class OverlapPairs {
 public:
  /// Free motion before a rebuild, in radii: larger means fewer rebuilds but longer rows (they grow with its
  /// cube).
  static constexpr double kSkin = 0.12;

  /// Brings the list up to date for `position` [m] and `radius` [m, > 0], of equal length and finite. Returns
  /// true if it had to be rebuilt. The content may depend on earlier calls; the true overlaps within it do
  /// not.
  bool update(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius);

  int size() const { return static_cast<int>(order_.size()); }
  /// Input index of each rank, and rank of each input index.
  const std::vector<std::int32_t>& order() const { return order_; }
  const std::vector<std::int32_t>& rank() const { return rank_; }
  /// The candidates of rank s are slots rowStart()[s] .. rowStart()[s + 1] - 1.
  const std::vector<std::int32_t>& rowStart() const { return rows_.start; }
  /// Rank of the candidate in each slot.
  const std::vector<std::int32_t>& candidate() const { return candidate_; }
  /// The slot that holds the same pair seen from the other bubble.
  const std::vector<std::int32_t>& mirror() const { return mirror_; }

 private:
  struct Levels;
  class CellSearch;
  struct Sorted {
    Eigen::Vector3d position;
    double radius;
  };
  using Half = std::vector<std::pair<std::int32_t, std::int32_t>>;

  bool stillValid(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius) const;
  Levels sortIntoCells();
  std::vector<Half> findPairs(const Levels& levels) const;
  void fillRows(const std::vector<Half>& found);

  std::vector<Eigen::Vector3d> builtPosition_;  ///< by input index
  std::vector<double> builtRadius_;
  std::vector<Sorted> sorted_;  ///< the same by rank
  std::vector<std::int32_t> order_, rank_, candidate_, mirror_;
  PairRows rows_;
};

}  // namespace spume::foam
