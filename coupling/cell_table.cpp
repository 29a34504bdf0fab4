#include "coupling/cell_table.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "coupling/csv_writer.h"

namespace spume::coupling {
namespace {

using foam::Film;
using foam::FoamTopology;

std::vector<std::uint32_t> filmCounts(const FoamTopology& topology) {
  std::vector<std::uint32_t> count(topology.volume.size());
  for (const Film& film : topology.films) ++count[film.i], ++count[film.j];
  return count;
}

/// The films' indices in the order of their pairs of ids.
class FilmsById {
 public:
  FilmsById(const BubbleTable& bubbles, const FoamTopology& topology)
      : id_(bubbles.id), films_(topology.films), order_(films_.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (std::is_sorted(id_.begin(), id_.end())) return;  // films are ordered by (i, j)
    tbb::parallel_sort(order_, [this](std::uint32_t a, std::uint32_t b) { return pair(a) < pair(b); });
  }

  const Film& film(std::size_t row) const { return films_[order_[row]]; }
  std::pair<std::uint64_t, std::uint64_t> ids(std::size_t row) const { return pair(order_[row]); }

 private:
  std::pair<std::uint64_t, std::uint64_t> pair(std::uint32_t film) const {
    return std::minmax({id_[films_[film].i], id_[films_[film].j]});
  }

  const std::vector<std::uint64_t>& id_;
  const std::vector<Film>& films_;
  std::vector<std::uint32_t> order_;
};

}  // namespace

void writeCellTable(const std::string& path, const BubbleTable& bubbles, const FoamTopology& topology) {
  const std::vector<std::uint32_t> films = filmCounts(topology);
  writeCsv(path, "id,volume,free_area,film_area,films,hidden", bubbles.size(),
           [&](std::size_t row, CsvRow& out) {
             out.integer(bubbles.id[row]);
             out.number(topology.volume[row]);
             out.number(topology.freeArea[row]);
             out.number(topology.filmArea[row]);
             out.integer(films[row]);
             out.integer(topology.hidden[row]);
           });
}

void writeContactTable(const std::string& path, const BubbleTable& bubbles, const FoamTopology& topology) {
  const FilmsById films(bubbles, topology);
  writeCsv(path, "id_a,id_b,distance,film_area", topology.films.size(), [&](std::size_t row, CsvRow& out) {
    const auto [a, b] = films.ids(row);
    out.integer(a);
    out.integer(b);
    out.number(films.film(row).distance);
    out.number(films.film(row).area);
  });
}

FoamTotals totalsOf(const FoamTopology& topology) {
  FoamTotals totals;
  totals.bubbles = topology.volume.size();
  totals.contacts = topology.films.size();
  for (const std::uint8_t hidden : topology.hidden) totals.hidden += hidden;
  for (const double volume : topology.volume) totals.volume += volume;
  for (const double area : topology.freeArea) totals.freeArea += area;
  for (const Film& film : topology.films) totals.filmArea += film.area;
  return totals;
}

}  // namespace spume::coupling
