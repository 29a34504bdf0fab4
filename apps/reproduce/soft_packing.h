#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

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
/// transition [OHern 2003]. The smaller balls have radius 1, the springs stiffness 1.
class SoftPacking {
 public:
  static constexpr double kStiffness = 1;

  struct Contact {
    std::int32_t i, j;
    double push, distance;
    Eigen::Vector3d normal;  ///< from i to j
  };

  explicit SoftPacking(const SoftPackingParams& params);

  /// Share of the box that the balls fill.
  double fraction() const;
  /// Makes the box larger or smaller, the places with it.
  void setFraction(double fraction);
  /// Lets the balls come to rest by the steps of FIRE [Bitzek 2006]: until no net force is above a small
  /// share of the contacts' own, or no ball touches another. Returns whether they did.
  bool relax();

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

 private:
  std::vector<std::uint8_t> rattlers() const;
  void placeImages();
  void addImagesAlong(int axis);
  bool imagesSuffice() const;
  void findForces();
  double largestForce() const;

  SoftPackingParams params_;
  double edge_ = 1, ballVolume_ = 0;
  std::vector<Eigen::Vector3d> position_, force_, velocity_;  ///< of the balls
  std::vector<Eigen::Vector3d> placed_;                       ///< of the balls and their images
  std::vector<double> radius_;                                ///< of both
  std::vector<std::int32_t> ball_;                            ///< behind each of them
  std::vector<Eigen::Vector3d> shift_;                        ///< from it
  std::vector<Eigen::Vector3d> imaged_;  ///< where the balls were when images were placed
  std::vector<Contact> contacts_;        ///< i < j
  foam::OverlapPairs near_;
};

}  // namespace spume::apps
