#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/parallel.h"

namespace spume::fluid {

/// Labels the connected components of a set of cells. Works on runs along k, so its cost beyond one scan of
/// the grid is that of the set's surface. The order of the labels is that of the cells, not of any threads.
class ConnectedCells {
 public:
  /// `member(i, j, k)`: whether a cell belongs to the set; `joined(axis, i, j, k)`: whether the minus face of
  /// cell (i, j, k) across `axis` connects its two sides; both are called from several threads at once.
  /// Writes components 0, 1, ... in the order of their first cells and -1 elsewhere, ghosts included; returns
  /// their number. `label` is resized if it does not fit.
  template <typename Member, typename Joined>
  int label(const Eigen::Vector3i& cells, const Member& member, const Joined& joined,
            DenseField<std::int32_t>& label) {
    if (label.size() != cells) label = DenseField<std::int32_t>(cells, -1);
    slabs_.resize(cells.x());
    tbb::parallel_for(0, cells.x(), [&](int i) { findSlab(i, cells, member, joined); });
    joinSlabs();
    for (int i = 0; i < cells.x(); ++i)
      for (int j = 0; j < cells.y(); ++j) {
        const int row = i * cells.y() + j;
        if (i > 0) uniteRows(row - cells.y(), row, [&](int k) { return joined(0, i, j, k); });
        if (j > 0) uniteRows(row - 1, row, [&](int k) { return joined(1, i, j, k); });
      }
    return write(cells, label);
  }

  /// Calls body(component, i, j, begin, end) for the runs of cells k = begin ... end - 1 of the last `label`,
  /// in the order of the cells.
  template <typename Body>
  void forEachRun(const Eigen::Vector3i& cells, const Body& body) const {
    for (int i = 0, row = 0; i < cells.x(); ++i)
      for (int j = 0; j < cells.y(); ++j, ++row)
        for (std::int32_t run = rowStart_[row]; run < rowStart_[row + 1]; ++run)
          body(number_[run], i, j, runs_[run].begin, runs_[run].end);
  }

 private:
  struct Run {
    int begin, end;       // k range
    std::int32_t parent;  // of the union-find forest; never larger than the run's own number
  };

  /// The runs of one slab of rows, found by one task.
  struct Slab {
    std::vector<Run> runs;
    std::vector<std::int32_t> rowEnd;  // in `runs`
  };

  template <typename Member, typename Joined>
  void findSlab(int i, const Eigen::Vector3i& cells, const Member& member, const Joined& joined) {
    Slab& slab = slabs_[i];
    slab.runs.clear();
    slab.rowEnd.clear();
    for (int j = 0; j < cells.y(); ++j) {
      const std::size_t rowBegin = slab.runs.size();
      for (int k = 0; k < cells.z(); ++k) {
        if (!member(i, j, k)) continue;
        const bool follows = slab.runs.size() > rowBegin && slab.runs.back().end == k;
        if (follows && joined(2, i, j, k))
          slab.runs.back().end = k + 1;
        else
          slab.runs.push_back({k, k + 1, 0});
      }
      slab.rowEnd.push_back(static_cast<std::int32_t>(slab.runs.size()));
    }
  }

  template <typename JoinedAt>
  void uniteRows(int lowerRow, int row, const JoinedAt& joinedAt) {
    std::int32_t a = rowStart_[lowerRow], b = rowStart_[row];
    while (a < rowStart_[lowerRow + 1] && b < rowStart_[row + 1]) {
      const int begin = std::max(runs_[a].begin, runs_[b].begin), end = std::min(runs_[a].end, runs_[b].end);
      for (int k = begin; k < end; ++k)
        if (joinedAt(k)) {
          unite(a, b);
          break;
        }
      runs_[a].end < runs_[b].end ? ++a : ++b;
    }
  }

  void joinSlabs();
  std::int32_t root(std::int32_t run);
  void unite(std::int32_t a, std::int32_t b);
  int write(const Eigen::Vector3i& cells, DenseField<std::int32_t>& label);

  std::vector<Slab> slabs_;
  std::vector<Run> runs_;
  std::vector<std::int32_t> rowStart_;  // first run of each row, nx ny + 1 entries
  std::vector<std::int32_t> number_;    // component of each run
};

}  // namespace spume::fluid
