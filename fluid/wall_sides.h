#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"

namespace spume::fluid {

struct SolidBoundary;

/// Which values a cell may read. A wall of one or two cells is thinner than the stencils of interpolation:
/// the liquid on its one side must not see what is on the other. Cells belong to the same side if open faces
/// join them nearby; a cell without open faces belongs to the side of the nearest cell that has some, because
/// that is where its value comes from (SolidExtension).
class WallSides {
 public:
  /// Values of a cell and its 26 neighbours, z fastest; the cell itself is number kCentre.
  using Block = std::array<float, 27>;
  static constexpr int kCentre = 13;

  /// What a cell needs to know, in one word; 0 far from solids.
  using Guard = std::uint32_t;
  static constexpr Guard kSeen = (1u << 27) - 1;  ///< neighbours of the same side, as in Block
  static constexpr Guard kNear = 1u << 27;        ///< another side within two cells
  static constexpr Guard kBeside = 1u << 28;      ///< another side among the neighbours
  static constexpr Guard kInReach = 1u << 29;     ///< another side within the reach of a sub-step
  static constexpr Guard kByWall = 1u << 30;      ///< a cell behind a wall within two cells

  /// Values behind walls are continued level by level across this axis: the one that gravity is along, so
  /// that a surface at rest stays exactly level.
  int upAxis = 1;
  /// Sense of that axis against gravity: 1 or -1, 0 without gravity.
  int upSense = 1;
  /// What a path of a sub-step may cross [cells].
  int walkReach = 7;

  /// True if there is a thin wall anywhere.
  bool any() const { return thin_; }
  Guard guard(int i, int j, int k) const { return byWall_.empty() ? 0 : guard_(i, j, k); }
  Guard guard(const Eigen::Vector3i& c) const { return guard(c.x(), c.y(), c.z()); }
  /// The same by the cell's offset in a field of floats; only where there is a thin wall.
  Guard guardAt(std::int32_t offset) const { return guard_.data()[offset]; }
  /// The cells with kByWall, in the order of the grid.
  const std::vector<Eigen::Vector3i>& cellsByWalls() const { return byWall_; }
  /// True if cell `n`, a neighbour of `c` or `c` itself, is on the same side.
  bool sees(const Eigen::Vector3i& c, const Eigen::Vector3i& n) const;

  /// Values around a cell as its side has them: those of other sides are replaced by its own continued.
  Block read(const DenseField<float>& field, const Eigen::Vector3i& c) const;
  /// Trilinear value and gradient per cell in such a block at an offset from its middle, within one cell.
  struct Sample {
    float value;
    Eigen::Vector3f gradient;
  };
  static Sample sample(const Block& block, const Eigen::Vector3f& offset);
  /// Trilinear value at a point of cell `c` [cell units].
  float valueIn(const DenseField<float>& field, const Eigen::Vector3i& c, const Eigen::Vector3f& x) const;

  /// Finds the sides of all cells.
  void find(const SolidBoundary& solids);

  /// Which faces of a cell let flow through, as bits 2 axis + (0 low, 1 high); 0 in the ghosts.
  std::uint8_t openings(const Eigen::Vector3i& c) const { return openings_(c); }
  const DenseField<std::uint8_t>& openings() const { return openings_; }
  /// The cell whose side the values of a cell are those of: itself, or the nearest with an open face within
  /// CellReach::kRadius; false if there is none.
  bool home(const Eigen::Vector3i& c, Eigen::Vector3i& cell) const;

 private:
  void findOpenings(const SolidBoundary& solids);
  void findHomes(const SolidBoundary& solids);
  Guard guardOf(const Eigen::Vector3i& c) const;
  void markReach();

  DenseField<Guard> guard_;
  DenseField<std::uint8_t> openings_;
  DenseField<std::int8_t> home_;  ///< number of the offset to it, -1 for none
  std::vector<Eigen::Vector3i> byWall_;
  bool thin_ = false;
};

/// The 5^3 cells around one, and which of them open faces within the block join to a start.
class CellReach {
 public:
  static constexpr int kRadius = 2, kEdge = 2 * kRadius + 1, kCells = kEdge * kEdge * kEdge;
  CellReach(const DenseField<std::uint8_t>& openings, const Eigen::Vector3i& centre,
            const Eigen::Vector3i& start);
  /// `offset` from the centre, at most kRadius along each axis.
  bool reaches(const Eigen::Vector3i& offset) const { return reached_[number(offset)]; }
  static bool covers(const Eigen::Vector3i& offset) { return offset.cwiseAbs().maxCoeff() <= kRadius; }
  static int number(const Eigen::Vector3i& offset) {
    return ((offset.x() + kRadius) * kEdge + offset.y() + kRadius) * kEdge + offset.z() + kRadius;
  }

 private:
  std::array<bool, kCells> reached_{};
};

/// Where a way from cell to cell ends that only open faces let through.
struct Walk {
  Eigen::Vector3i cell;
  Eigen::Vector3f at;             ///< [cell units]
  std::array<bool, 3> stopped{};  ///< along which axes a wall stopped it
};

/// Walks on the straight line from a point in `cell` to another [cell units]; at a closed face the way goes
/// on along it.
Walk walkThroughFaces(const SolidBoundary& solids, const Eigen::Vector3i& cell, const Eigen::Vector3f& from,
                      const Eigen::Vector3f& to);

}  // namespace spume::fluid
