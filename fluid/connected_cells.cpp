#include "fluid/connected_cells.h"

namespace spume::fluid {

/// Strings the runs of all slabs together, each its own component.
void ConnectedCells::joinSlabs() {
  runs_.clear();
  rowStart_.assign(1, 0);
  for (const Slab& slab : slabs_) {
    const auto before = static_cast<std::int32_t>(runs_.size());
    for (const Run& run : slab.runs) {
      runs_.push_back(run);
      runs_.back().parent = static_cast<std::int32_t>(runs_.size()) - 1;
    }
    for (const std::int32_t end : slab.rowEnd) rowStart_.push_back(before + end);
  }
}

std::int32_t ConnectedCells::root(std::int32_t run) {
  while (runs_[run].parent != run) {
    runs_[run].parent = runs_[runs_[run].parent].parent;
    run = runs_[run].parent;
  }
  return run;
}

void ConnectedCells::unite(std::int32_t a, std::int32_t b) {
  a = root(a);
  b = root(b);
  runs_[std::max(a, b)].parent = std::min(a, b);
}

int ConnectedCells::write(const Eigen::Vector3i& cells, DenseField<std::int32_t>& label) {
  int count = 0;
  number_.resize(runs_.size());
  for (std::int32_t run = 0; run < static_cast<std::int32_t>(runs_.size()); ++run) {
    const std::int32_t first = root(run);  // comes no later than the run itself
    number_[run] = first == run ? count++ : number_[first];
  }
  forEachRow(cells, [&](int i, int j) {
    std::int32_t* row = &label(i, j, 0);
    std::fill_n(row, cells.z(), -1);
    const int number = i * cells.y() + j;
    for (std::int32_t run = rowStart_[number]; run < rowStart_[number + 1]; ++run)
      std::fill(row + runs_[run].begin, row + runs_[run].end, number_[run]);
  });
  return count;
}

}  // namespace spume::fluid
