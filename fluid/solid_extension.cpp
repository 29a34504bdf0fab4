#include "fluid/solid_extension.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "fluid/level_set.h"
#include "fluid/parallel.h"
#include "fluid/wall_sides.h"

namespace spume::fluid {
namespace {

/// Sources of a level lie within this of the nearest [squared cells]: beside it, not behind it.
constexpr int kRing = 2;

}  // namespace

/// Finds the sources of one slab of cells.
struct SolidExtension::Finder {
  const SolidBoundary& solids;
  const DenseField<float>* before;
  int up;
  int upSense;
  List covered = {}, uncovered = {};

  bool isFree(const Eigen::Vector3i& c) const {
    return solids.psi(c) > 0 && solids.hasOpenFace(c.x(), c.y(), c.z());
  }
  bool isUncovered(const Eigen::Vector3i& c) const { return before && isFree(c) && (*before)(c) <= 0; }
  bool isSource(const Eigen::Vector3i& c) const {
    return solids.psi.contains(c.x(), c.y(), c.z()) && isFree(c) && !isUncovered(c);
  }
  std::int32_t offsetOf(const Eigen::Vector3i& c) const {
    return static_cast<std::int32_t>(solids.psi.index(c.x(), c.y(), c.z()));
  }

  void visit(const Eigen::Vector3i& c) {
    if (isSource(c)) return;
    Eigen::Vector3i home;
    if (!solids.sides.home(c, home)) return;  // deeper than any stencil reads
    add(c, CellReach(solids.sides.openings(), c, home), isUncovered(c) ? uncovered : covered);
  }

  /// Calls body(offset) for the sources around a cell, of its level or of all.
  template <typename Body>
  void forEachSource(const Eigen::Vector3i& c, const CellReach& reach, bool levelOnly,
                     const Body& body) const {
    constexpr int r = CellReach::kRadius;
    Eigen::Vector3i d;
    for (d[0] = -r; d[0] <= r; ++d[0])
      for (d[1] = -r; d[1] <= r; ++d[1])
        for (d[2] = -r; d[2] <= r; ++d[2])
          if ((!levelOnly || d[up] == 0) && reach.reaches(d) && isSource(c + d)) body(d);
  }

  void add(const Eigen::Vector3i& c, const CellReach& reach, List& list) const {
    for (const bool levelOnly : {true, false}) {
      int nearest = std::numeric_limits<int>::max();
      Eigen::Vector3i first;
      forEachSource(c, reach, levelOnly, [&](const Eigen::Vector3i& d) {
        if (d.squaredNorm() < nearest) nearest = d.squaredNorm(), first = d;
      });
      if (nearest == std::numeric_limits<int>::max()) continue;
      Entry entry{offsetOf(c), offsetOf(c + first), static_cast<std::uint32_t>(list.sources.size()), 0,
                  first[up] * upSense > 0};
      levelOnly ? addLevel(c, reach, nearest, list) : addSlope(c, first, list);
      entry.end = static_cast<std::uint32_t>(list.sources.size());
      list.entries.push_back(entry);
      return;
    }
  }

  void addLevel(const Eigen::Vector3i& c, const CellReach& reach, int nearest, List& list) const {
    const std::size_t begin = list.sources.size();
    float sum = 0;
    forEachSource(c, reach, true, [&](const Eigen::Vector3i& d) {
      if (d.squaredNorm() > nearest + kRing) return;
      const float weight = 1 / static_cast<float>(d.squaredNorm() * d.squaredNorm());
      list.sources.push_back({offsetOf(c + d), weight});
      sum += weight;
    });
    for (std::size_t n = begin; n < list.sources.size(); ++n) list.sources[n].weight /= sum;
  }

  /// Continues the slope from the cell before the nearest source to that source.
  void addSlope(const Eigen::Vector3i& c, const Eigen::Vector3i& first, List& list) const {
    const bool above = first[up] > 0;
    const Eigen::Vector3i further = c + first + (above ? 1 : -1) * Eigen::Vector3i::Unit(up);
    const bool joined = solids.sides.openings()(c + first) >> (2 * up + above) & 1;
    if (joined && isSource(further))
      list.sources.push_back({offsetOf(further), -static_cast<float>(std::abs(first[up]))});
  }
};

void SolidExtension::rebuild(const SolidBoundary& solids, const DenseField<float>* before) {
  covered_ = uncovered_ = {};
  const Eigen::Vector3i& cells = solids.cellFraction.size();
  if (solids.sides.openings().size() != cells) return;  // no solid
  std::vector<Finder> slabs(cells.x(), Finder{solids, before, solids.sides.upAxis, solids.sides.upSense});
  tbb::parallel_for(0, cells.x(), [&](int i) {
    for (int j = 0; j < cells.y(); ++j)
      for (int k = 0; k < cells.z(); ++k) slabs[i].visit({i, j, k});
  });
  const auto join = [](List& all, const List& part) {
    const auto shift = static_cast<std::uint32_t>(all.sources.size());
    for (Entry entry : part.entries) {
      entry.begin += shift, entry.end += shift;
      all.entries.push_back(entry);
    }
    all.sources.insert(all.sources.end(), part.sources.begin(), part.sources.end());
  };
  for (const Finder& slab : slabs) join(covered_, slab.covered), join(uncovered_, slab.uncovered);
}

void SolidExtension::fill(const List& list, DenseField<float>& field) {
  float* data = field.data();
  tbb::parallel_for(std::size_t{0}, list.entries.size(), [&](std::size_t n) {
    const Entry& entry = list.entries[n];
    const float first = data[entry.first];
    float sum = 0;
    for (std::uint32_t s = entry.begin; s < entry.end; ++s)
      sum += list.sources[s].weight * (data[list.sources[s].cell] - first);
    data[entry.cell] = first + (entry.floor && first < 0 ? std::min(sum, 0.0f) : sum);
  });
}

void SolidExtension::apply(DenseField<float>& field) const {
  fill(covered_, field);
  fillGhostLayers(field);
}

}  // namespace spume::fluid
