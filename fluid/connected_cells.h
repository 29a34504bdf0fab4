#pragma once

#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Labels the connected components of a set of cells; two cells are joined if the face between them is open.
/// Works on runs along k, so its cost beyond one scan of the grid is that of the set's surface.
class ConnectedCells {
 public:
  /// `member(i, j, k)` tells whether a cell belongs to the set. Writes components 0, 1, ... in the order of
  /// their first cells and -1 elsewhere, ghosts included; returns their number.
  template <typename Member>
  int label(const Eigen::Vector3i& cells, const SolidBoundary& boundary, const Member& member,
            DenseField<std::int32_t>& label);

 private:
  struct Run {
    int begin, end;  // k range
    std::int32_t parent;
  };
  std::int32_t root(std::int32_t run);
  void unite(std::int32_t a, std::int32_t b);
  void uniteRows(int axis, int i, int j, int otherRow, int row, const SolidBoundary& boundary);
  int write(const Eigen::Vector3i& cells, DenseField<std::int32_t>& label);

  std::vector<Run> runs_;
  std::vector<std::int32_t> rowStart_;  // first run of each row, nx ny + 1 entries
  std::vector<std::int32_t> number_;    // component of each root run
};

}  // namespace spume::fluid
