#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>

namespace spume::fluid {

/// Slabs of one tile; at least twice the passes made together. Rows of a slab taken together: those of a few
/// slabs lie in the second-level cache.
inline constexpr int kTileSlabs = 8, kTileRows = 32;

/// Makes several passes over the rows (fixed i, j) of a grid as if one after the other, where a pass over a
/// row reads no further than the rows beside it and writes what neither itself nor the passes before and
/// after write there (red and black). A task takes all passes over a tile of slabs (fixed i) while it lies in
/// the cache, each pass one slab short of the one before at sides where another tile follows; what is left
/// out between two tiles is done afterwards. Within a tile, blocks of rows follow each other, each pass one
/// row behind the one before.
class SlabTiles {
 public:
  SlabTiles(int slabs, int rows, int passes)
      : slabs_(slabs),
        rows_(rows),
        passes_(passes),
        tiles_(slabs <= 2 * kTileSlabs ? 1 : slabs / kTileSlabs) {}

  /// True if there are too few slabs for more than one tile.
  bool single() const { return tiles_ == 1; }

  /// Calls pass(n, slab, begin, end) for rows j = begin ... end - 1 of slabs. Few slabs stay on the calling
  /// thread.
  template <typename Pass>
  void sweep(const Pass& pass) const {
    if (single()) return inside(0, pass);
    tbb::parallel_for(0, tiles_, [&](int tile) { inside(tile, pass); });
    tbb::parallel_for(1, tiles_, [&](int tile) { between(beginOf(tile), pass); });
  }

 private:
  int beginOf(int tile) const {
    return tile == tiles_ ? slabs_ : tile * kTileSlabs;
  }  // the last takes the rest

  template <typename Pass>
  void inside(int tile, const Pass& pass) const {
    const int first = beginOf(tile), last = beginOf(tile + 1);
    for (int block = 0; block < rows_ + passes_ - 1; block += kTileRows)
      for (int front = first; front < last + passes_ - 1; ++front)
        for (int n = 0; n < passes_; ++n) {
          const int slab = front - n;
          const int low = first > 0 ? first + n : 0, high = last < slabs_ ? last - n : slabs_;
          const int begin = std::max(block - n, 0), end = std::min(block + kTileRows - n, rows_);
          if (slab >= low && slab < high && begin < end) pass(n, slab, begin, end);
        }
  }

  /// What tiles that meet at slab `middle` left out.
  template <typename Pass>
  void between(int middle, const Pass& pass) const {
    for (int n = 1; n < passes_; ++n)
      for (int slab = middle - n; slab < middle + n; ++slab) pass(n, slab, 0, rows_);
  }

  int slabs_, rows_, passes_, tiles_;
};

}  // namespace spume::fluid
