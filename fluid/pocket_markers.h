#pragma once

#include <vector>

#include "fluid/air_pockets.h"
#include "fluid/liquid_solver.h"
#include "fluid/marker_particles.h"

namespace spume::fluid {

/// Takes the positive markers out of the cells of filled pockets: a pocket pays its gas instead of them
/// (model, Section 4 rule 5), and left behind they would carve it open again. Pockets of one cell are marker
/// noise and pay nothing; the others are appended to `collapsed` with the impact speed at their
/// centroid. `cellMark` is scratch: -1 everywhere, and again afterwards.
void collapsePockets(const MarkerScene& scene, const std::vector<FilledPocket>& filled,
                     const DenseField<float>& phi, const MacVelocity& velocity, MarkerSorter& sorter,
                     DenseField<std::int32_t>& cellMark, MarkerSet& positive,
                     std::vector<CollapsedPocket>& collapsed);

}  // namespace spume::fluid
