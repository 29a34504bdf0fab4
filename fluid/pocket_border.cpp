#include "fluid/pocket_border.h"

#include <algorithm>
#include <tuple>

#include "fluid/pocket_unknowns.h"

namespace spume::fluid {

void PocketBorder::assemble(const PocketUnknowns& pockets) {
  couplings_.clear();
  for (const PocketSurface& s : pockets.surfaces)
    couplings_.push_back({static_cast<std::size_t>(s.pocket), s.cell, s.coefficient});
  diagonal_.assign(pockets.diagonal.begin(), pockets.diagonal.end());
  merge();
}

void PocketBorder::coarsen(const PocketBorder& fine) {
  couplings_ = fine.couplings_;
  for (Coupling& coupling : couplings_) {
    coupling.cell /= 2;
    coupling.coefficient *= 0.5f;
  }
  diagonal_ = fine.diagonal_;
  for (float& value : diagonal_) value *= 0.5f;
  merge();
}

/// Sorts the couplings and sums those of the same pair.
void PocketBorder::merge() {
  const auto key = [](const Coupling& c) { return std::tuple(c.pocket, c.cell.x(), c.cell.y(), c.cell.z()); };
  std::stable_sort(couplings_.begin(), couplings_.end(),
                   [&](const Coupling& a, const Coupling& b) { return key(a) < key(b); });
  std::size_t kept = 0;
  for (std::size_t n = 0; n < couplings_.size(); ++n) {
    const Coupling next = couplings_[n];
    if (kept > 0 && key(couplings_[kept - 1]) == key(next))
      couplings_[kept - 1].coefficient += next.coefficient;
    else
      couplings_[kept++] = next;
  }
  couplings_.erase(couplings_.begin() + static_cast<std::ptrdiff_t>(kept), couplings_.end());
}

void PocketBorder::start(const std::vector<float>& rhs) {
  value_.assign(diagonal_.size(), 0);
  rhs_ = rhs;
  rhs_.resize(diagonal_.size(), 0);
}

void PocketBorder::relax(const DenseField<float>& x, DenseField<float>& rhs) {
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < couplings_.size(); begin = end) {
    const std::size_t pocket = couplings_[begin].pocket;
    double sum = rhs_[pocket];
    for (end = begin; end < couplings_.size() && couplings_[end].pocket == pocket; ++end)
      sum += static_cast<double>(couplings_[end].coefficient) * x(couplings_[end].cell);
    const float value = static_cast<float>(sum / diagonal_[pocket]), change = value - value_[pocket];
    value_[pocket] = value;
    for (std::size_t n = begin; n < end; ++n) rhs(couplings_[n].cell) += couplings_[n].coefficient * change;
  }
}

}  // namespace spume::fluid
