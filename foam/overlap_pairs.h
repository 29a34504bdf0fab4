#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/pair_sweep.h"

namespace spume::foam {

/// For every bubble the others near enough to overlap it now or soon: a Verlet list. Two bubbles are
/// candidates when their distance is below (1 + kSkin)(r_i + r_j) at the time of building, so the list holds
/// until a bubble has |dx| + |dr| > kSkin r, with or without the mean dx of all taken off. `pair_sweep` finds
/// the pairs.
///
/// Bubbles are numbered here by *rank*, along a curve through space: neighbours are near in memory. Rows
/// list candidates by input index, so that what is summed along a row does not depend on when the list was
/// built.
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
  const std::vector<std::int32_t>& rowStart() const { return rowStart_; }
  /// Rank of the candidate in each slot.
  const std::vector<std::int32_t>& candidate() const { return candidate_; }
  /// The slot that holds the same pair seen from the other bubble.
  const std::vector<std::int32_t>& mirror() const { return mirror_; }

 private:
  bool stillValid(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius) const;
  void fillRows(const std::vector<PairSweep::Pairs>& found);
  void findMirrors();

  std::vector<Eigen::Vector3d> builtPosition_;  ///< by input index
  std::vector<double> builtRadius_;
  std::vector<std::int32_t> order_, rank_, rowStart_, candidate_, mirror_;
  std::vector<std::uint64_t> entry_;  ///< input index and rank of each slot's candidate
  std::vector<std::int32_t> next_;    ///< free slot of each row, while they fill
};

}  // namespace spume::foam
