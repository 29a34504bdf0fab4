#pragma once

#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// Continues cell-centred fields into the solids: nothing may read past a wall (model, "Liquid"). A cell
/// behind a wall takes the mean of the free cells nearest to it on its own level, so that a surface at rest
/// is level up to the wall whatever the wall's slope, and a moving one meets it at 90 degrees along the
/// level; where its level is all solid, the two levels before it are continued linearly. Below liquid that
/// goes no higher than the liquid's own value: the cells of a floor do not move, so a surface that the slope
/// makes there would stay, air that nothing can lift. Only cells on its own side of a thin wall count
/// (WallSides).
class SolidExtension {
 public:
  /// Finds the cells behind walls and where their values come from. Call again whenever solids have moved;
  /// `before` is psi as it was: cells uncovered since then are no sources until `uncover` has filled them.
  void rebuild(const SolidBoundary& solids, const DenseField<float>* before = nullptr);
  /// Fills the cells that the last rebuild found uncovered, from their side of the walls.
  void uncover(DenseField<float>& field) const { fill(uncovered_, field); }
  bool hasUncovered() const { return !uncovered_.entries.empty(); }
  /// Overwrites `field` behind the walls, as deep as any stencil reads, and in the ghosts.
  void apply(DenseField<float>& field) const;

 private:
  struct Source {
    std::int32_t cell;  ///< offset in the field
    float weight;
  };
  /// value = field[first] + sum of weight (field[cell] - field[first]): equal values stay so to the bit.
  struct Entry {
    std::int32_t cell, first;
    std::uint32_t begin, end;  ///< of its sources
    bool floor;                ///< lies below `first`, under which liquid keeps no air
  };
  struct List {
    std::vector<Entry> entries;
    std::vector<Source> sources;
  };
  struct Finder;
  static void fill(const List& list, DenseField<float>& field);

  List covered_, uncovered_;
};

}  // namespace spume::fluid
