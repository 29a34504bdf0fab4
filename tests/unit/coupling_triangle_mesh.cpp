#include <gtest/gtest.h>

#include <Eigen/LU>
#include <bit>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>

#include "coupling/errors.h"
#include "coupling/scene_builder.h"
#include "coupling/shapes.h"
#include "coupling/solid_files.h"
#include "coupling/triangle_mesh.h"
#include "tests/support/temporary_path.h"

namespace spume::coupling {
namespace {

/// A file that goes away with the object.
class MeshFile {
 public:
  MeshFile(const std::string& name, const std::string& bytes) : path_(temporaryPath(name)) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~MeshFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Corners of the box from 0 to (1, 2, 3), bit a of their number telling the side along axis a, and its
/// faces.
constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
Eigen::Vector3d corner(int n) { return {1.0 * (n & 1), 2.0 * (n >> 1 & 1), 3.0 * (n >> 2)}; }

std::string boxObj(int faces = 6) {
  std::string text = "# a box\no box\n";
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector3d x = corner(n);
    text += "v " + std::to_string(x.x()) + " " + std::to_string(x.y()) + " " + std::to_string(x.z()) + "\n";
  }
  for (int f = 0; f < faces; ++f) {
    text += "f";
    for (const int n : kFaces[f]) text.append(" ").append(std::to_string(n + 1)).append("/1/1");
    text += "\n";
  }
  return text;
}

std::string boxPly(bool binary) {
  std::string text = "ply\nformat " + std::string(binary ? "binary_little_endian" : "ascii") +
                     " 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
                     "element face 6\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&](auto value) { text.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (int n = 0; n < 8; ++n)
    for (int a = 0; a < 3; ++a) {
      if (binary)
        put(static_cast<float>(corner(n)[a]));
      else
        text += std::to_string(corner(n)[a]) + (a == 2 ? "\n" : " ");
    }
  for (const auto& face : kFaces) {
    if (binary) {
      put(std::uint8_t{4});
      for (const int n : face) put(std::int32_t{n});
    } else {
      text += "4";
      for (const int n : face) text.append(" ").append(std::to_string(n));
      text += "\n";
    }
  }
  return text;
}

TEST(TriangleMesh, ObjAndBothKindsOfPlyHoldTheSameBox) {
  const MeshFile files[] = {
      {"box.obj", boxObj()}, {"box.ply", boxPly(false)}, {"box_binary.ply", boxPly(true)}};
  for (const MeshFile& file : files) {
    const TriangleMesh mesh = readMesh(file.path());
    ASSERT_EQ(mesh.vertices.size(), 8u);
    ASSERT_EQ(mesh.triangles.size(), 12u);
    double volume = 0;  // by the divergence theorem; the faces of the box look outwards
    for (const Eigen::Vector3i& t : mesh.triangles) {
      Eigen::Matrix3d corners;
      corners << mesh.vertices[t.x()], mesh.vertices[t.y()], mesh.vertices[t.z()];
      volume += corners.determinant() / 6;
    }
    EXPECT_NEAR(volume, 6, 1e-12) << file.path();
    EXPECT_NO_THROW(requireClosed(mesh, file.path()));
  }
}

TEST(TriangleMesh, CornersAtTheSamePlaceCountAsOne) {
  TriangleMesh mesh = readMesh(MeshFile("box.obj", boxObj()).path());
  for (Eigen::Vector3i& triangle : mesh.triangles)
    for (int& n : triangle) {
      const Eigen::Vector3d copy = mesh.vertices[n];
      mesh.vertices.push_back(copy);
      n = static_cast<int>(mesh.vertices.size()) - 1;
    }
  EXPECT_NO_THROW(requireClosed(mesh, "box"));
}

TEST(TriangleMesh, ALeakIsNamedByFileAndEdge) {
  const MeshFile file("open.obj", boxObj(5));
  try {
    requireClosed(readMesh(file.path()), file.path());
    FAIL() << "the open box was accepted";
  } catch (const SceneError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find(file.path()), std::string::npos) << message;
    EXPECT_NE(message.find("edge from vertex 5 (0, 0, 3)"), std::string::npos) << message;
  }
}

TEST(TriangleMesh, BadFilesAreRefusedWithTheirPlace) {
  const std::pair<std::string, std::string> kBad[] = {
      {"v 0 0\n", ":1:1: "},          {"v 0 0 x\n", ":1:7: "},          {"v 0 0 0\nf 1 2 3\n", ":2:5: "},
      {"v 0 0 0\nf 1 1\n", ":2:1: "}, {"v 0 0 0\nf 1 a 1\n", ":2:5: "}, {"v 0 0 0\n", "no faces"}};
  for (const auto& [text, expected] : kBad) {
    const MeshFile file("bad.obj", text);
    try {
      readMesh(file.path());
      ADD_FAILURE() << text;
    } catch (const SceneError& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(readMesh(MeshFile("cut.ply", boxPly(true).substr(0, 250)).path()), SceneError);
  EXPECT_THROW(readMesh(MeshFile("points.stl", "solid").path()), SceneError);
  EXPECT_THROW(readMesh(temporaryPath("missing.obj")), FileError);
}

TEST(SolidFiles, CopiesOfASceneReadAFileOnce) {
  const auto file = std::make_unique<MeshFile>("once.obj", boxObj());
  Scene scene;
  scene.domain.size.setConstant(4);
  scene.domain.resolution = 16;
  scene.solids.resize(1);
  scene.solids[0].shape.kind = ShapeKind::mesh;
  scene.solids[0].shape.file = file->path();
  EXPECT_LT(solidDistance(scene)({0.5, 1, 1.5}), 0);
  std::remove(file->path().c_str());
  const Scene copy = scene;
  EXPECT_LT(solidDistance(copy)({0.5, 1, 1.5}), 0);
  scene.domain.resolution = 32;  // another spacing has to be sampled
  EXPECT_THROW(solidDistance(scene), FileError);
}

TEST(SolidFiles, DistanceToAMeshIsThatToItsBox) {
  const MeshFile file("box.obj", boxObj());
  ShapeSpec mesh;
  mesh.kind = ShapeKind::mesh;
  mesh.file = file.path();
  mesh.scale = 0.1;
  ShapeSpec box;
  box.upper = {0.1, 0.2, 0.3};
  constexpr double kDx = 0.01;
  const DistanceField field = distanceFromFile(mesh, kDx);
  // Inside the measured band trilinear interpolation of a distance errs where it has a crease, by less than
  // half a voxel; swept distances err by O(voxel log) of the way to the band.
  constexpr double kNear = 0.5 * kDx / 2, kFar = 1.5 * kDx;
  for (double x = -0.06; x < 0.17; x += 0.0113)
    for (double y = -0.06; y < 0.27; y += 0.0131)
      for (double z = -0.06; z < 0.37; z += 0.0137) {
        const Eigen::Vector3d place(x, y, z);
        const double exact = signedDistance(box, place);
        EXPECT_NEAR(field(place), exact, std::abs(exact) < kDx ? kNear : kFar) << place.transpose();
      }
  EXPECT_NEAR(field({0.05, 0.1, 0.3}), 0, 0.02 * kDx);  // the middle of a face
  EXPECT_LT(field({0.05, 0.1, 0.15}), -4 * kDx);        // deep inside
}

}  // namespace
}  // namespace spume::coupling
