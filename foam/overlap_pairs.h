#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/ball_tree.h"
#include "foam/raw_buffer.h"

namespace spume::foam {

/// For every bubble the others near enough to overlap it now or soon: a Verlet list. Two bubbles are
/// candidates when their distance is below (1 + skin)(r_i + r_j) at the time of building, so the list holds
/// until a bubble has |dx| + |dr| > skin r, with or without the mean dx of all taken off. `ball_tree` finds
/// the pairs.
///
/// A list with room to move has longer rows, by a third in a dense foam, for every later pass to go through:
/// it pays where it is used three times. So it is given that room only where bubbles have moved so little
/// twice in a row; else, and in the beginning, it holds for these balls alone.
///
/// Bubbles are numbered here by *rank*, in the space order of the tree: neighbours are near in memory. Rows
/// list candidates by input index, so that what is summed along a row does not depend on when the list was
/// built. Where the input is in space order ranks are input indices.
class OverlapPairs {
 public:
  /// Free motion before a rebuild, in radii, of a list with room: larger means fewer rebuilds but longer rows
  /// (they grow with its cube).
  static constexpr double kSkin = 0.12;
  /// And of one without: no more than round-off of what moves or scales as a whole.
  static constexpr double kNoSkin = 1e-6;

  /// The ball of one rank that may come to lie within that of another while the list holds.
  using Nesting = BallTree::Nesting;

  /// Brings the list up to date for `position` [m] and `radius` [m, > 0], of equal length and finite. The
  /// last `strangers` balls know those before them alone, not each other. Returns true if it had to be
  /// rebuilt. The content may depend on earlier calls; the true overlaps within it do not.
  bool update(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
              std::size_t strangers = 0);

  int size() const { return static_cast<int>(tree_.size()); }
  /// Input index of each rank, and rank of each input index.
  const std::vector<std::int32_t>& order() const { return tree_.order(); }
  const std::vector<std::int32_t>& rank() const { return rank_; }
  /// The candidates of rank s are slots rowStart()[s] .. rowStart()[s + 1] - 1.
  const std::vector<std::int32_t>& rowStart() const { return rowStart_; }
  std::size_t slots() const { return static_cast<std::size_t>(rowStart_.back()); }
  /// The slot from which on the candidates of each rank have higher input indices than its bubble.
  const std::vector<std::int32_t>& upperStart() const { return upperStart_; }
  /// Rank of the candidate in each slot; padded for whole lanes.
  const RawBuffer<std::int32_t>& candidate() const { return candidate_; }
  /// Number of the pair in each slot, the same in both rows, below slots() / 2; padded for whole lanes. Pairs
  /// are numbered along the rows of their lower ranks: firstPair()[s] .. firstPair()[s + 1] - 1.
  const RawBuffer<std::int32_t>& pair() const { return pair_; }
  const std::vector<std::int32_t>& firstPair() const { return firstPair_; }
  /// In no order.
  const std::vector<Nesting>& nestings() const { return nestings_; }

 private:
  /// The pairs that one parallel task has found, along the rows of their lower ranks, by their higher ones.
  struct Piece {
    const BallTree::Query* query = nullptr;
    std::size_t begin = 0;      ///< in what that query has found
    std::int32_t farthest = 0;  ///< the highest rank
  };

  void chooseSkin(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius);
  bool holdsWith(double skin, const std::vector<Eigen::Vector3d>& position,
                 const std::vector<double>& radius) const;
  void findPairs();
  void findHigher(std::int32_t s, BallTree::Query& query);
  template <typename Visit>
  void forEachPairWith(std::int32_t begin, std::int32_t end, const Visit& visit) const;
  void startRows();
  void fillRows();
  void sortRows();

  double skin_ = kNoSkin;     ///< of the list
  int uses_ = 0;              ///< of the list, so far
  bool movedLittle_ = false;  ///< when it was asked for last
  std::size_t strangers_ = 0;
  std::vector<Eigen::Vector3d> builtPosition_;  ///< by input index
  std::vector<double> builtRadius_;
  BallTree tree_;
  std::vector<std::int32_t> rank_, rowStart_, upperStart_;
  RawBuffer<std::int32_t> candidate_, pair_;
  std::vector<Nesting> nestings_;
  std::vector<std::int32_t> firstPair_;  ///< of each rank with higher ones
  tbb::enumerable_thread_specific<BallTree::Query> queries_;
  std::vector<Piece> pieces_;
};

}  // namespace spume::foam
