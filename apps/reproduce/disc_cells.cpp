#include "apps/reproduce/disc_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spume::apps {
namespace {

/// A piece of a line, by the distance along it from the point nearest to the centre.
struct Piece {
  double from, to;
};

/// What of line k lies in the disc and on the near side of all other lines.
Piece edgeOn(std::size_t k, double radius, const std::vector<CuttingLine>& lines) {
  const auto& [normal, height] = lines[k];
  const Eigen::Vector2d along(-normal.y(), normal.x());
  const double half = std::sqrt(std::max(radius * radius - height * height, 0.0));
  Piece piece{-half, half};
  for (std::size_t other = 0; other < lines.size(); ++other) {
    if (other == k) continue;
    const double slope = lines[other].normal.dot(along),
                 room = lines[other].height - height * lines[other].normal.dot(normal);
    if (slope > 0) piece.to = std::min(piece.to, room / slope);
    if (slope < 0) piece.from = std::max(piece.from, room / slope);
    if (slope == 0 && room < 0) piece.to = piece.from;
  }
  return piece;
}

}  // namespace

void cutDisc(double radius, const std::vector<CuttingLine>& lines, DiscCell& cell) {
  const bool centreStays =
      std::none_of(lines.begin(), lines.end(), [](const CuttingLine& line) { return line.height < 0; });
  double free = centreStays ? 2 * std::numbers::pi : 0;
  cell.area = 0;
  cell.edge.assign(lines.size(), 0);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const Piece piece = edgeOn(k, radius, lines);
    if (piece.from >= piece.to) continue;
    const double h = lines[k].height;
    cell.edge[k] = piece.to - piece.from;
    cell.area += h * cell.edge[k] / 2;
    free -= std::atan2(h * cell.edge[k], h * h + piece.from * piece.to);
  }
  cell.rim = radius * std::max(free, 0.0);
  cell.area += radius * cell.rim / 2;
}

}  // namespace spume::apps
