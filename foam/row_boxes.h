#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

namespace spume::foam {

/// Finds the balls of a list that meet another: boxes around sixteen in a row, and around sixteen of those.
/// Where what is near in the list is near in space, few are opened. Quicker to build than a tree, for few
/// questions.
class RowBoxes {
 public:
  /// Balls at `centre` with `radius` [m], of equal length, which must outlive the use. O(n).
  void build(const std::vector<Eigen::Vector3d>& centre, const std::vector<double>& radius);

  /// Calls visit(k) for every ball k nearer to x than r + r_k [m]; for others at most within round-off.
  template <typename Visit>
  void visitMeeting(const Eigen::Vector3d& x, double r, const Visit& visit) const {
    for (std::size_t group = 0; group < coarse_.size(); ++group) {
      if (!coarse_[group].meets(x, r)) continue;
      const std::size_t last = std::min((group + 1) * kFan, fine_.size());
      for (std::size_t box = group * kFan; box < last; ++box)
        if (fine_[box].meets(x, r)) visitBox(box, x, r, visit);
    }
  }

 private:
  static constexpr std::size_t kFan = 16;
  static constexpr double kSpare = 1 + 1e-7;  ///< above round-off and what ties change

  struct Box {
    Eigen::Vector3d low, high;  ///< [m]
    bool meets(const Eigen::Vector3d& x, double r) const {
      const double reach = kSpare * r;
      return (low - x).cwiseMax(x - high).cwiseMax(0).squaredNorm() < reach * reach;
    }
  };

  template <typename Visit>
  void visitBox(std::size_t box, const Eigen::Vector3d& x, double r, const Visit& visit) const {
    const std::size_t end = std::min((box + 1) * kFan, radius_->size());
    for (std::size_t k = box * kFan; k < end; ++k) {
      const double reach = kSpare * (r + (*radius_)[k]);
      if (((*centre_)[k] - x).squaredNorm() < reach * reach) visit(k);
    }
  }

  const std::vector<Eigen::Vector3d>* centre_ = nullptr;
  const std::vector<double>* radius_ = nullptr;
  std::vector<Box> fine_, coarse_;
};

}  // namespace spume::foam
