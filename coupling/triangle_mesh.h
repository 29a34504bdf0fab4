#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace spume::coupling {

/// Triangles over shared vertices.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;  ///< indices of corners, from 0
};

/// Reads a Wavefront OBJ (`v`, `f`) or a PLY, ascii or binary little endian, by the file's ending; faces with
/// more than three corners become fans. Throws FileError (unreadable) or SceneError (content, with its
/// place).
TriangleMesh readMesh(const std::string& path);

/// Throws SceneError naming `path` and an edge unless the mesh closes a volume: every edge, corners at the
/// same place counted as one, must lie between an even number of triangles.
void requireClosed(const TriangleMesh& mesh, const std::string& path);

}  // namespace spume::coupling
