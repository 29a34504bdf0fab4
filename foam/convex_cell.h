#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace spume::foam {

/// Convex polyhedron around a bubble's centre, cut plane by plane: a bound on its power cell that tells at
/// once which planes cannot matter. Every corner has three faces and three edges, which the tie-breaking
/// jitter of the radii ensures but for round-off. Faces go by numbers: 0 to 5 are the sides of the cube it
/// starts from, the others are given with the planes. Holds scratch memory; one per thread.
class ConvexCell {
 public:
  static constexpr int kCubeFaces = 6;

  enum class Cut : std::uint8_t {
    missed,  ///< the plane leaves the cell as it is
    done,    ///< it took a part and has a face now
    gone,    ///< it took all
    unsure   ///< it touches within round-off: the cell is as before, and larger than it might be
  };

  /// Back to the cube of half-edge `half` [m] around the centre.
  void reset(double half);
  /// Takes away the points p with normal . p > offset; the normal [m], any length, and offset [m^2].
  Cut cut(const Eigen::Vector3d& normal, double offset, std::int32_t face);

  /// The smallest box around the cell [m].
  const Eigen::Vector3d& low() const { return low_; }
  const Eigen::Vector3d& high() const { return high_; }
  /// Distance from the centre to the farthest corner [m].
  double farthest() const { return farthest_; }
  /// Lists the numbers of all faces that are left but the cube's, each once, ascending.
  void listFaces(std::vector<std::int32_t>& faces);

 private:
  /// Edge e leads to corner next[e] and has face[e] on its left, face[e + 1] on its right. All corners turn
  /// the same way, so the corner at the other end has the two the other way round.
  struct Corner {
    std::array<std::int32_t, 3> next;
    std::array<std::int32_t, 3> face;
  };
  /// An edge from a corner that goes to one that stays, and the new corner on it.
  struct Crossing {
    std::int32_t goes, stays;
    std::int32_t back;         ///< the edge as the corner that stays numbers it
    std::int32_t left, right;  ///< the faces beside the edge, seen from the corner that goes
    std::int32_t after = -1;   ///< the crossing next along the face on the right
    Eigen::Vector3d place;     ///< of the new corner [m]
  };

  void setPlace(std::size_t corner, const Eigen::Vector3d& p) {
    x_[corner] = p.x(), y_[corner] = p.y(), z_[corner] = p.z();
  }
  Eigen::Vector3d place(std::int32_t corner) const { return {x_[corner], y_[corner], z_[corner]}; }
  double measure(const Eigen::Vector3d& normal, double offset);
  void findCrossings();
  bool formRing();
  void replaceCorners(std::int32_t face);
  void makeRoom(std::size_t corners);
  void fillGaps(std::size_t used);
  void pad();
  void findBounds();

  std::size_t count_ = 0;
  std::vector<Corner> corner_;
  std::vector<double> x_, y_, z_;  ///< of the corners, padded with copies of the first [m]
  std::vector<double> beyond_;     ///< normal . p - offset of each corner [m^2]
  std::vector<std::int32_t> lost_;
  std::vector<Crossing> crossing_;
  std::vector<std::int32_t> crossingAt_;    ///< the crossing with each face on its left, if it has one
  std::int32_t lastFace_ = kCubeFaces - 1;  ///< largest number of a face it has had
  std::vector<std::uint8_t> isLeft_;        ///< of each face, while they are listed
  Eigen::Vector3d low_, high_;
  double half_ = 0, farthest_ = 0;
};

}  // namespace spume::foam
