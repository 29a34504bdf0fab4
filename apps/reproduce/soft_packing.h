#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "apps/reproduce/cell_areas.h"
#include "foam/overlap_pairs.h"

namespace spume::apps {

/// What a packing is made of.
struct SoftPackingParams {
  int count = 1000;
  int dimensions = 3;      ///< 2: discs, all at z = 0
  double ratio = 1;        ///< every second ball is larger by this
  double fraction = 0.6;   ///< of the box that the balls fill at the start, overlaps counted twice
  std::uint64_t seed = 1;  ///< of the places they start from, at random
};

/// Soft balls in a periodic box that push each other apart by the strong spring of tangent bubbles
/// (lambda = 1) and nothing else, brought to rest at any density: the harmonic spheres of the jamming
/// transition [OHern 2003]. The smaller balls have radius 1, the springs stiffness 1. Discs may then become a
/// foam of power cells that hold their areas.
class SoftPacking {
 public:
  static constexpr double kStiffness = 1;
  /// At rest: largest net force over the mean push of the contacts.
  static constexpr double kAtRest = 1e-5;
  /// Relative error of the areas that cells hold. Radii are then right to half of it, and so are forces:
  /// below kAtRest of the pushes met 1e-4 from jamming.
  static constexpr double kAreaOff = 1e-10;

  struct Contact {
    std::int32_t i, j;
    double push, distance;
    Eigen::Vector3d normal;  ///< from i to j
    bool film = true;        ///< whether the cells meet; of soft balls always
  };

  explicit SoftPacking(const SoftPackingParams& params);

  /// From now on every disc is cut by its radical lines, and its radius is such that the cell has the area
  /// the disc had alone; the springs act between the new radii. Only cells that meet count as contacts; discs
  /// whose overlap others cover still push each other, as bubbles do. To be called at rest: cells of discs
  /// that lie on each other can not all be filled. Throws foam::InvalidParameter in three dimensions.
  void holdAreas();
  bool holdsAreas() const { return cells_.has_value(); }
  /// Largest relative departure of a cell's area from the one it holds; 0 of soft balls.
  double worstArea() const { return cells_ ? cells_->worst() : 0; }
  /// Largest net force on a ball over the mean push of the contacts; 0 if there are none.
  double unrest() const;

  /// Share of the box that the balls fill; that of the gas where areas are held.
  double fraction() const;
  /// Makes the box larger or smaller, the places with it.
  void setFraction(double fraction);
  /// Lets the balls come to rest by the steps of FIRE [Bitzek 2006]: until no net force is above
  /// kAtRest, and cells hold their areas to kAreaOff, or no ball touches another. Returns whether they
  /// did.
  bool relax();
  /// Whether relax() would leave the balls where they are.
  bool isAtRest() const;
  /// Puts the balls there, one place each.
  void moveTo(const std::vector<Eigen::Vector3d>& position);

  /// The pushes between the balls as they are.
  struct Census {
    double contacts = 0;  ///< per ball, over the balls that are held [-]; rattlers are not: they have fewer
                          ///< contacts than dimensions + 1, those with rattlers left out
    double held = 0;      ///< share of the balls [-]
    double pressure = 0;  ///< mean of push x distance over the box [stiffness / radius^(dimensions - 2)]
  };
  Census census() const;
  /// The contacts between balls that are held.
  std::vector<Contact> heldContacts() const;

  /// Places in [0, edge) and the edge of the box.
  const std::vector<Eigen::Vector3d>& position() const { return position_; }
  double edge() const { return edge_; }
  int dimensions() const { return params_.dimensions; }
  double radius(std::size_t ball) const { return radius_[ball]; }

 private:
  std::vector<std::uint8_t> rattlers() const;
  void placeImages();
  void addImagesAlong(int axis);
  double largestRadius() const;
  bool imagesSuffice() const;
  void findOverlaps();
  void fillCells();
  void findForces();
  double meanPush() const;
  double largestForce() const;

  SoftPackingParams params_;
  double edge_ = 1, ballVolume_ = 0;
  std::vector<Eigen::Vector3d> position_, force_, velocity_;  ///< of the balls
  std::vector<Eigen::Vector3d> placed_;                       ///< of the balls and their images
  std::vector<double> radius_;                                ///< of both
  std::vector<std::int32_t> ball_;                            ///< behind each of them
  std::vector<Eigen::Vector3d> shift_;                        ///< from it
  std::vector<Eigen::Vector3d> imaged_;  ///< where the balls were when images were placed
  double imagedRadius_ = 0;              ///< of the largest ball then
  std::vector<Overlap> overlaps_;        ///< of every ball with all others, in order
  std::vector<Contact> contacts_;        ///< i < j
  foam::OverlapPairs near_;
  std::optional<CellAreas> cells_;  ///< of discs that hold their areas
};

}  // namespace spume::apps
