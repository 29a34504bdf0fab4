#include "foam/weak_pairs.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "foam/ball_checks.h"
#include "foam/inflated_cell.h"

namespace spume::foam {

namespace {

using Eigen::Vector3d;

/// Cells per range at most: more would leave most of a sparse raft's cells empty.
constexpr double kCellsPerRange = 8;

/// Edge of the grid's cells [m]: about one bubble each where they are packed.
double cellSizeOf(const std::vector<double>& radius, double range) {
  const double sum = std::accumulate(radius.begin(), radius.end(), 0.0);
  return std::max(range / kCellsPerRange, 2 * sum / static_cast<double>(radius.size()));
}

/// Which bubbles share a film.
class Contacts {
 public:
  Contacts(const FoamTopology& topology, std::size_t bubbles) : topology_(topology), rowStart_(bubbles + 1) {
    for (const Film& film : topology.films) ++rowStart_[static_cast<std::size_t>(film.i) + 1];
    std::partial_sum(rowStart_.begin(), rowStart_.end(), rowStart_.begin());
  }
  bool has(std::int32_t i, std::int32_t j) const {
    const auto films = topology_.films.begin();
    return std::any_of(films + rowStart_[i], films + rowStart_[i + 1],
                       [j](const Film& film) { return film.j == j; });
  }

 private:
  const FoamTopology& topology_;
  std::vector<std::int32_t> rowStart_;  ///< of the films of each bubble i, which are sorted
};

/// What is asked of each bubble.
struct Search {
  const std::vector<std::uint8_t>& surface;
  const Contacts& contacts;
  double range;  ///< [m]
};

/// A thread's memory, and the pairs it has found.
struct Finder {
  Vicinity vicinity;
  InflatedCell cell;
  std::vector<WeakPair> pairs;

  /// Adds the weak pairs of the bubble at site `s` with those of higher numbers, in their order.
  void add(const SiteGrid& grid, std::int32_t s, const Search& search) {
    const std::int32_t i = grid.sites()[s].index;
    if (!search.surface[i] || !cell.build(s, search.range * search.range / 4, vicinity)) return;
    const auto first = static_cast<std::ptrdiff_t>(pairs.size());
    for (std::size_t k = 0; k < cell.neighbours().size(); ++k) {
      const auto& [other, distance2] = cell.neighbours()[k];
      const std::int32_t j = grid.sites()[other].index;
      const double distance = std::sqrt(distance2);
      if (i < j && search.surface[j] && distance <= search.range && !search.contacts.has(i, j) &&
          cell.sharesFace(k))
        pairs.push_back({i, j, distance});
    }
    std::sort(pairs.begin() + first, pairs.end(),
              [](const WeakPair& a, const WeakPair& b) { return a.j < b.j; });
  }
};

/// Where the pairs of one bubble are.
struct Row {
  const Finder* finder = nullptr;
  std::size_t begin = 0, end = 0;
};

}  // namespace

void WeakPairs::find(const std::vector<Vector3d>& position, const std::vector<double>& radius,
                     const std::vector<std::uint64_t>& id, const std::vector<std::uint8_t>& surface,
                     const FoamTopology& topology, double range, std::vector<WeakPair>& out) {
  checkBalls("WeakPairs", position, radius, id);
  if (!(range > 0) || !std::isfinite(range) || surface.size() != position.size())
    throw InvalidParameter("WeakPairs: range " + std::to_string(range) + " m and " +
                           std::to_string(surface.size()) + " flags for " + std::to_string(position.size()) +
                           " bubbles; the range must be positive and finite, with one flag per bubble");
  out.clear();
  if (std::count_if(surface.begin(), surface.end(), [](std::uint8_t flag) { return flag != 0; }) < 2) return;
  const SiteGrid grid(position, radius, id, cellSizeOf(radius, range));
  const Contacts contacts(topology, position.size());
  const Search search{surface, contacts, range};
  tbb::enumerable_thread_specific<Finder> finders;
  std::vector<Row> rows(position.size());
  tbb::parallel_for(std::size_t{0}, grid.runStart().size() - 1, [&](std::size_t run) {
    Finder& finder = finders.local();
    const std::int32_t begin = grid.runStart()[run], end = grid.runStart()[run + 1];
    finder.vicinity.moveTo(grid, grid.sites()[begin].position);
    for (std::int32_t s = begin; s < end; ++s) {
      Row& row = rows[grid.sites()[s].index];
      row = {&finder, finder.pairs.size(), 0};
      finder.add(grid, s, search);
      row.end = finder.pairs.size();
    }
  });
  for (const Row& row : rows)
    for (std::size_t k = row.begin; k < row.end; ++k) out.push_back(row.finder->pairs[k]);
}

}  // namespace spume::foam
