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

  struct Box {
    Eigen::Vector3d low, high;  ///< [m]
  };
  /// The smallest box around the cell.
  const Box& box() {
    if (boxIsOld_) findBox();
    return box_;
  }

  struct Face {
    std::int32_t number;
    bool cornerWithin;  ///< a corner of it lies within the radius asked for
  };
  /// Lists all faces that are left but the cube's, each once, ascending; radius2 is the square of a distance
  /// from the centre [m^2].
  void listFaces(double radius2, std::vector<Face>& faces);

 private:
  /// Edge e has face[e] on its left and face[e + 1] on its right. It is edge next[e] % 4 of corner next[e] /
  /// 4 at the other end; all corners turn the same way, so that one has the two faces the other way round.
  struct Corner {
    std::array<std::int32_t, 3> next;
    std::array<std::int32_t, 3> face;
  };
  /// An edge from a corner that goes to one that stays, and the new corner on it.
  struct Crossing {
    std::int32_t back;         ///< the edge as the corner that stays has it, 4 corner + edge
    std::int32_t left, right;  ///< the faces beside the edge, seen from the corner that goes
    std::int32_t after;        ///< the crossing next along the face on the right
    double x, y, z;            ///< of the new corner [m]
  };

  double measure(const Eigen::Vector3d& normal, double offset);
  bool listLost();
  void findCrossings();
  bool formRing();
  void replaceCorners(std::int32_t face);
  void makeRoom(std::size_t corners);
  void fillGaps(std::size_t used);
  void pad();
  void findBox();

  std::size_t count_ = 0;
  std::vector<Corner> corner_;
  std::vector<double> x_, y_, z_;   ///< of the corners, padded with copies of the first [m]
  std::vector<double> beyond_;      ///< normal . p - offset of each corner [m^2]
  std::vector<std::int32_t> lost_;  ///< corners beyond the plane, ascending
  std::size_t lostCount_ = 0, crossings_ = 0;
  std::vector<Crossing> crossing_;
  std::vector<std::int32_t> crossingAt_;    ///< the crossing with each face on its left, if it has one
  std::int32_t lastFace_ = kCubeFaces - 1;  ///< largest number of a face it has had
  std::vector<std::uint8_t> corners_;       ///< of each face, while they are listed: 1 any, 2 one within
  Box box_;
  bool boxIsOld_ = false;
  double half_ = 0;
};

}  // namespace spume::foam
