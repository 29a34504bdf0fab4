#include "foam/topology_part.h"

#include <utility>

namespace spume::foam {

void takePart(const FoamTopology& all, const Neighbours& neighbours, const std::vector<std::int32_t>& rows,
              const std::vector<std::int32_t>& place, FoamTopology& part) {
  part = {};
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::int32_t i = rows[k];
    part.volume.push_back(all.volume[i]), part.hidden.push_back(all.hidden[i]);
    part.freeArea.push_back(all.freeArea[i]), part.filmArea.push_back(all.filmArea[i]);
    for (std::int32_t e = neighbours.start[i]; e < neighbours.start[i + 1]; ++e) {
      const std::int32_t j = neighbours.other[e];
      if (j < i || place[j] < 0) continue;
      OverlapPair pair = all.overlaps[neighbours.pair[e]];
      pair.i = static_cast<std::int32_t>(k), pair.j = place[j];
      if (pair.film >= 0) {
        Film film = all.films[pair.film];
        film.i = pair.i, film.j = pair.j;
        pair.film = static_cast<std::int32_t>(part.films.size());
        part.films.push_back(film);
      }
      part.overlaps.push_back(pair);
    }
  }
}

/// Appends a pair of `from`, between rows i and j of the whole, and its film.
void PartReplacer::keep(const OverlapPair& pair, std::int32_t i, std::int32_t j, const FoamTopology& from) {
  OverlapPair& kept = overlaps_.emplace_back(pair);
  kept.i = i, kept.j = j;
  if (pair.film < 0) return;
  kept.film = static_cast<std::int32_t>(films_.size());
  Film& film = films_.emplace_back(from.films[pair.film]);
  film.i = i, film.j = j;
}

void PartReplacer::putBack(const FoamTopology& part, const std::vector<std::int32_t>& rows,
                           const std::vector<std::uint8_t>& whole, FoamTopology& all) {
  isWhole_.assign(all.volume.size(), 0);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::int32_t i = rows[k];
    if (!whole[k]) continue;
    isWhole_[i] = 1;
    all.volume[i] = part.volume[k], all.hidden[i] = part.hidden[k];
    all.freeArea[i] = part.freeArea[k], all.filmArea[i] = part.filmArea[k];
  }
  overlaps_.clear(), films_.clear();
  auto fresh = part.overlaps.begin();
  const auto keepFreshBelow = [&](std::pair<std::int32_t, std::int32_t> limit) {
    for (; fresh != part.overlaps.end(); ++fresh) {
      const std::pair rowsOf(rows[fresh->i], rows[fresh->j]);
      if (rowsOf >= limit) return;
      if (whole[fresh->i] || whole[fresh->j]) keep(*fresh, rowsOf.first, rowsOf.second, part);
    }
  };
  for (const OverlapPair& pair : all.overlaps) {
    if (isWhole_[pair.i] || isWhole_[pair.j]) continue;
    keepFreshBelow({pair.i, pair.j});
    keep(pair, pair.i, pair.j, all);
  }
  keepFreshBelow({static_cast<std::int32_t>(all.volume.size()), 0});
  all.overlaps.swap(overlaps_), all.films.swap(films_);
}

}  // namespace spume::foam
