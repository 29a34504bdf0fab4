#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace spume::foam {

/// Looks at some of x while a solve is on its way and may end it early: where the system depends on x, an x
/// of a few digits tells most of what will change. A look costs no more than the rows it looks at.
struct SolveWatch {
  double mark = 0;     ///< |b - A x| below which it looks, about; 0 for never [kg m/s]
  double step = 0;     ///< the next mark, as a share of the last
  double allowed = 0;  ///< by which the residual may be off where the solve is ended early [kg m/s]
  std::vector<std::int32_t> rows;  ///< what it looks at
  /// Whether the x of one of these ends the solve. Called by several threads.
  std::function<bool(std::int32_t row, const Eigen::Vector3d& x)> stops;

  /// Whether to look at a residual of about `norm` on the way to `goal`; goes on to the next mark if so.
  bool isDue(double norm, double goal) {
    if (mark <= goal || norm > mark) return false;
    while (mark > goal && norm <= mark) mark *= step;
    return true;
  }
};

}  // namespace spume::foam
