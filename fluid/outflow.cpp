#include "fluid/outflow.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "fluid/errors.h"
#include "fluid/level_set.h"

namespace spume::fluid {
namespace {

// Distance to which an emptied region raises phi around itself [dx]: as far as reinitialisation and markers
// look.
constexpr double kStampBand = 6;
// Cells whose volume an emptied region can change lie within this of it [dx]: half a diagonal and a margin.
constexpr double kTouched = 1;
// Largest part of a cell that a pump takes in a sub-step [-]: what flows in beside it must be able to follow.
constexpr double kLargestShare = 0.5;

}  // namespace

OutflowSet::OutflowSet(const GridSpec& grid, std::vector<Outflow> outflows)
    : grid_(grid), outflows_(std::move(outflows)) {
  for (const Outflow& outflow : outflows_) {
    Region region;
    for (int i = 0; i < grid.cells.x(); ++i)
      for (int j = 0; j < grid.cells.y(); ++j)
        for (int k = 0; k < grid.cells.z(); ++k) {
          const double sdf = outflow.sdf(grid.cellCentre(i, j, k));
          if (sdf < kStampBand * grid.dx) region.cells.push_back({{i, j, k}, static_cast<float>(sdf)});
          if (sdf < 0) region.interior.emplace_back(i, j, k);
        }
    if (region.interior.size() < static_cast<std::size_t>(outflow.free ? kFewestFreeCells : 1))
      throw InvalidParameter("outflow \"" + outflow.name + "\": its region holds " +
                             std::to_string(region.interior.size()) +
                             " cell centres; at least 1 for a pump, 8 if free: make it larger or dx smaller");
    regions_.push_back(std::move(region));
  }
}

double OutflowSet::empty(double t, const SolidBoundary& boundary, DenseField<float>& phi, MarkerSet& negative,
                         VolumeControl& books) const {
  double taken = 0;
  const auto dx = static_cast<float>(grid_.dx);
  for (std::size_t n = 0; n < outflows_.size(); ++n) {
    if (!outflows_[n].free || !isOpen(n, t)) continue;
    std::vector<double> before;
    const auto forEachTouched = [&](const auto& body) {
      for (const Cell& c : regions_[n].cells)
        if (c.sdf < kTouched * grid_.dx)
          body(c.cell, boundary.cellFraction(c.cell) *
                           liquidFractionOfCell(phi, dx, c.cell.x(), c.cell.y(), c.cell.z()));
    };
    forEachTouched([&](const Eigen::Vector3i&, double liquid) { before.push_back(liquid); });
    for (const Cell& c : regions_[n].cells) phi(c.cell) = std::max(phi(c.cell), -c.sdf);
    std::size_t index = 0;
    forEachTouched([&](const Eigen::Vector3i& cell, double liquid) {
      taken += books.bookDrained(cell, (before[index++] - liquid) * grid_.cellVolume());
    });
    takeMarkers(outflows_[n], negative);
  }
  return taken;
}

/// Marks the negative markers in a region for removal: they would defend liquid that is gone.
void OutflowSet::takeMarkers(const Outflow& outflow, MarkerSet& negative) const {
  for (std::size_t m = 0; m < negative.size(); ++m) {
    const Eigen::Vector3d x = grid_.toWorld({negative.x[m], negative.y[m], negative.z[m]});
    if (outflow.sdf(x) < 0) negative.x[m] = std::numeric_limits<float>::quiet_NaN();
  }
}

std::vector<Eigen::Vector3i> OutflowSet::openCells(double t) const {
  std::vector<Eigen::Vector3i> cells;
  for (std::size_t n = 0; n < outflows_.size(); ++n)
    if (outflows_[n].free && isOpen(n, t))
      cells.insert(cells.end(), regions_[n].interior.begin(), regions_[n].interior.end());
  return cells;
}

double OutflowSet::pump(double t, double dt, const DenseField<float>& phi, const SolidBoundary& boundary,
                        DenseField<float>& divergenceSource, VolumeControl& books) const {
  double taken = 0;
  for (std::size_t n = 0; n < outflows_.size(); ++n) {
    if (outflows_[n].free || !isOpen(n, t)) continue;
    const auto roomOf = [&](const Eigen::Vector3i& c) {
      return phi(c) < 0 && boundary.hasOpenFace(c.x(), c.y(), c.z()) ? boundary.cellFraction(c) : 0.0f;
    };
    double room = 0;
    for (const Eigen::Vector3i& c : regions_[n].interior) room += roomOf(c);
    if (!(room > 0)) continue;
    const double share =
        std::min(outflows_[n].rate(t) / (room * grid_.cellVolume()), kLargestShare / dt);  // [1/s]
    for (const Eigen::Vector3i& c : regions_[n].interior) {
      if (!(roomOf(c) > 0)) continue;
      divergenceSource(c) -= static_cast<float>(share * roomOf(c));
      taken += books.bookDrained(c, share * dt * roomOf(c) * grid_.cellVolume());
    }
  }
  return taken;
}

}  // namespace spume::fluid
