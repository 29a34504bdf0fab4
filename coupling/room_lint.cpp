#include "coupling/room_lint.h"

#include <cmath>

#include "coupling/object_label.h"
#include "coupling/scene_builder.h"
#include "coupling/shapes.h"

namespace spume::coupling {
namespace {

constexpr double kRounding = 0.05;  // share by which whole cells may change an edge of the domain unsaid

class RoomLinter {
 public:
  RoomLinter(const Scene& scene, FindingList& findings)
      : scene_(scene), grid_(gridOf(scene)), psi_(solidDistance(scene)), findings_(findings) {}

  void lint() {
    lintEdges();
    const auto everywhere = [](const Eigen::Vector3d&) { return -1.0; };
    if (!hasFreeCell(everywhere)) return findings_.warn("domain", "is all solid: nothing can move in it");
    lintBodies();
    lintOutflows();
  }

 private:
  void lintEdges() {
    for (int axis = 0; axis < 3; ++axis) {
      const double asked = scene_.domain.size[axis], made = grid_.cells[axis] * grid_.dx;
      if (std::abs(made - asked) > kRounding * asked)
        findings_.warn("domain.size", asked, " m along ", "xyz"[axis], " becomes ", made, " m, ",
                       grid_.cells[axis], " cells of ", grid_.dx,
                       " m; raise domain.resolution or make it a whole number of cells");
    }
  }

  /// Whether the centre of a cell lies in the region and in no solid.
  bool hasFreeCell(const SignedDistance& region) const {
    for (int i = 0; i < grid_.cells.x(); ++i)
      for (int j = 0; j < grid_.cells.y(); ++j)
        for (int k = 0; k < grid_.cells.z(); ++k) {
          const Eigen::Vector3d x = grid_.cellCentre(i, j, k);
          if (region(x) < 0 && psi_(x) > 0) return true;
        }
    return false;
  }

  void lintBodies() {
    for (std::size_t i = 0; i < scene_.liquidBodies.size(); ++i) {
      Scene alone = scene_;
      alone.liquidBodies = {scene_.liquidBodies[i]};
      if (!hasFreeCell(initialPhi(alone)))
        findings_.warn(objectLabel("liquid_body", scene_.liquidBodies[i].name, i),
                       "holds no free centre of a cell of ", grid_.dx,
                       " m: no liquid comes of it; make it larger, move it out of solids, or raise "
                       "domain.resolution");
    }
  }

  void lintOutflows() {
    for (std::size_t i = 0; i < scene_.outflows.size(); ++i) {
      const ShapeSpec& shape = scene_.outflows[i].shape;
      if (!hasFreeCell([&](const Eigen::Vector3d& x) { return signedDistance(shape, x); }))
        findings_.warn(objectLabel("outflow", scene_.outflows[i].name, i),
                       "is all inside a solid at the start: it takes nothing out; move the outflow or the "
                       "solid");
    }
  }

  const Scene& scene_;
  fluid::GridSpec grid_;
  SignedDistance psi_;
  FindingList& findings_;
};

}  // namespace

void lintRoom(const Scene& scene, FindingList& findings) { RoomLinter(scene, findings).lint(); }

}  // namespace spume::coupling
