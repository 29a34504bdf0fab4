#include "coupling/clearance_grid.h"

#include <algorithm>
#include <cmath>

namespace spume::coupling {
namespace {

/// Radii beyond this many usual ones would make every look a wide one.
constexpr double kWide = 4;
/// Cells along an edge at most, so that tiny balls in a large box do not ask for more memory than all
/// bubbles.
constexpr double kMostCells = 64;

}  // namespace

ClearanceGrid::ClearanceGrid(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, double usual)
    : lower_(lower), edge_(2 * usual) {
  const Eigen::Array3d size = (upper - lower).array().max(0);
  edge_ = std::max(edge_, size.maxCoeff() / (kMostCells - 1));
  cells_ = (size / edge_).floor().cast<int>() + 1;
  first_.assign(static_cast<std::size_t>(cells_.prod()), -1);
}

ClearanceGrid::Cell ClearanceGrid::cellOf(const Eigen::Vector3d& x) const {
  const Eigen::Array3d inCells = ((x - lower_) / edge_).array().floor();
  return inCells.max(0).min(cells_.cast<double>().array() - 1).cast<int>();
}

/// Balls beyond the box lie in the cells at its border, no farther from any place in it than they are.
void ClearanceGrid::add(const Eigen::Vector3d& x, double radius) {
  if (radius > kWide * edge_ / 2) {
    wide_.push_back({x, radius, -1});
    return;
  }
  std::int32_t& first = first_[place(cellOf(x))];
  largest_ = std::max(largest_, radius);
  ball_.push_back({x, radius, first});
  first = static_cast<std::int32_t>(ball_.size()) - 1;
}

double ClearanceGrid::clearance(const Eigen::Vector3d& x, double radius) const {
  double least = 0;
  const auto look = [&](const Ball& ball) {
    least = std::min(least, (x - ball.centre).norm() - ball.radius - radius);
  };
  std::for_each(wide_.begin(), wide_.end(), look);
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius + largest_);
  const Cell low = cellOf(x - reach), high = cellOf(x + reach);
  for (int i = low.x(); i <= high.x(); ++i)
    for (int j = low.y(); j <= high.y(); ++j)
      for (int k = low.z(); k <= high.z(); ++k)
        for (std::int32_t b = first_[place({i, j, k})]; b >= 0; b = ball_[b].next) look(ball_[b]);
  return least;
}

}  // namespace spume::coupling
