#include "foam/topology_part.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace spume::foam {
namespace {

constexpr std::size_t kRowsPerPiece = 1024;  ///< of a parallel task

}  // namespace

void takePart(const FoamTopology& all, const Neighbours& neighbours, const std::vector<std::int32_t>& rows,
              const std::vector<std::int32_t>& place, FoamTopology& part) {
  for (auto* column : {&part.volume, &part.freeArea, &part.filmArea}) column->clear();
  part.overlaps.clear(), part.films.clear(), part.hidden.clear();
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

void PartReplacer::takeColumns(const Sources& from, FoamTopology& all) {
  isWhole_.assign(all.volume.size(), 0);
  for (std::size_t k = 0; k < from.rows.size(); ++k) {
    const std::int32_t i = from.rows[k];
    if (!from.whole[k]) continue;
    isWhole_[i] = 1;
    all.volume[i] = from.part.volume[k], all.hidden[i] = from.part.hidden[k];
    all.freeArea[i] = from.part.freeArea[k], all.filmArea[i] = from.part.filmArea[k];
  }
}

/// Pieces end between rows, in both lists.
void PartReplacer::cutPieces(const Sources& from) {
  const std::size_t count = from.all.volume.size() / kRowsPerPiece + 1;
  pieces_.assign(count + 1, {from.all.overlaps.size(), from.part.overlaps.size(), 0, 0});
  for (std::size_t piece = 0; piece < count; ++piece) {
    const auto row = static_cast<std::int32_t>(piece * kRowsPerPiece);
    const auto known = std::ranges::lower_bound(from.all.overlaps, row, {}, &OverlapPair::i);
    const auto rowOf = [&](const OverlapPair& pair) { return from.rows[pair.i]; };
    const auto fresh = std::ranges::lower_bound(from.part.overlaps, row, {}, rowOf);
    pieces_[piece].known = static_cast<std::size_t>(known - from.all.overlaps.begin());
    pieces_[piece].fresh = static_cast<std::size_t>(fresh - from.part.overlaps.begin());
  }
}

/// Calls keep(pair, i, j, topology) for the pairs of a piece in their order, between rows i and j of the
/// whole.
template <typename Keep>
void PartReplacer::merge(const Sources& from, std::size_t piece, const Keep& keep) const {
  std::size_t fresh = pieces_[piece].fresh;
  const auto keepFreshBelow = [&](std::pair<std::int32_t, std::int32_t> limit) {
    for (; fresh < pieces_[piece + 1].fresh; ++fresh) {
      const OverlapPair& pair = from.part.overlaps[fresh];
      const std::pair rowsOf(from.rows[pair.i], from.rows[pair.j]);
      if (rowsOf >= limit) return;
      if (from.whole[pair.i] || from.whole[pair.j]) keep(pair, rowsOf.first, rowsOf.second, from.part);
    }
  };
  for (std::size_t known = pieces_[piece].known; known < pieces_[piece + 1].known; ++known) {
    const OverlapPair& pair = from.all.overlaps[known];
    if (isWhole_[pair.i] || isWhole_[pair.j]) continue;
    keepFreshBelow({pair.i, pair.j});
    keep(pair, pair.i, pair.j, from.all);
  }
  keepFreshBelow({static_cast<std::int32_t>(from.all.volume.size()), 0});
}

void PartReplacer::write(const Sources& from, std::size_t piece) {
  std::size_t nextPair = pieces_[piece].overlaps, nextFilm = pieces_[piece].films;
  merge(from, piece,
        [&](const OverlapPair& pair, std::int32_t i, std::int32_t j, const FoamTopology& topology) {
          OverlapPair& kept = overlaps_[nextPair++] = pair;
          kept.i = i, kept.j = j;
          if (pair.film < 0) return;
          kept.film = static_cast<std::int32_t>(nextFilm);
          Film& film = films_[nextFilm++] = topology.films[pair.film];
          film.i = i, film.j = j;
        });
}

void PartReplacer::putBack(const FoamTopology& part, const std::vector<std::int32_t>& rows,
                           const std::vector<std::uint8_t>& whole, FoamTopology& all) {
  const Sources from{all, part, rows, whole};
  takeColumns(from, all);
  cutPieces(from);
  const std::size_t count = pieces_.size() - 1;
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t piece) {
    std::size_t overlaps = 0, films = 0;
    merge(from, piece,
          [&](const OverlapPair& pair, auto, auto, auto&) { ++overlaps, films += pair.film >= 0; });
    pieces_[piece].overlaps = overlaps, pieces_[piece].films = films;
  });
  std::size_t overlaps = 0, films = 0;
  for (Piece& piece : pieces_)
    piece.overlaps = std::exchange(overlaps, overlaps + piece.overlaps),
    piece.films = std::exchange(films, films + piece.films);
  overlaps_.resize(overlaps), films_.resize(films);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t piece) { write(from, piece); });
  all.overlaps.swap(overlaps_), all.films.swap(films_);
}

}  // namespace spume::foam
