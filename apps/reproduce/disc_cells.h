#pragma once

#include <Eigen/Core>
#include <vector>

namespace spume::apps {

/// A line that cuts a disc: points p, from the disc's centre, with normal . p <= height stay.
struct CuttingLine {
  Eigen::Vector2d normal;  ///< of length 1
  double height;           ///< signed distance of the line from the centre
};

/// What lines leave of a disc: where they are its radical lines, its power cell.
struct DiscCell {
  double area = 0;
  double rim = 0;            ///< length of the circle's arcs that are left
  std::vector<double> edge;  ///< length of the cell's edge on each line; 0 where others cover it
};

/// Cuts a disc. With h and L the height and the edge of each line, w the angle in which the centre sees that
/// edge and S the rim: S = r (2 pi [no h < 0] - sum sgn(h) w) and area = (sum h L + r S)/2, as for the balls'
/// cells in space. O(n^2) in the number of lines.
void cutDisc(double radius, const std::vector<CuttingLine>& lines, DiscCell& cell);

}  // namespace spume::apps
