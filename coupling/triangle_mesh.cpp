#include "coupling/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>
#include <numeric>

#include "coupling/atomic_file.h"
#include "coupling/errors.h"
#include "coupling/ply_header.h"
#include "coupling/text_fields.h"
#include "coupling/toml_slot.h"

namespace spume::coupling {
namespace {

/// A corner of a face as the file numbers it, checked against the vertices there are.
int cornerIn(const TextLines& lines, std::string_view word, std::size_t vertices, int first) {
  const std::string_view digits = word.substr(0, word.find('/'));
  long number = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || stop != digits.data() + digits.size() || digits.empty())
    lines.fail(word, quoted(word) + " is no number of a vertex");
  const long index = number < 0 && first == 1 ? static_cast<long>(vertices) + number : number - first;
  if (index < 0 || index >= static_cast<long>(vertices))
    lines.fail(word, "vertex " + std::string(digits) + " is none of the " + std::to_string(vertices));
  return static_cast<int>(index);
}

void addFan(const std::vector<int>& corners, TriangleMesh& mesh) {
  for (std::size_t n = 2; n < corners.size(); ++n)
    mesh.triangles.emplace_back(corners[0], corners[n - 1], corners[n]);
}

TriangleMesh readObj(const std::string& path, std::string_view text) {
  TriangleMesh mesh;
  TextLines lines(path, text);
  std::string_view line, word;
  while (lines.next(line)) {
    std::string_view rest = line;
    if (!nextWord(rest, word)) continue;
    if (word == "v") {
      Eigen::Vector3d vertex;
      for (double& value : vertex) {
        if (!nextWord(rest, word)) lines.fail(line, "the vertex has fewer than 3 numbers");
        value = numberIn(lines, word, "v");
      }
      mesh.vertices.push_back(vertex);
    } else if (word == "f") {
      std::vector<int> corners;
      while (nextWord(rest, word)) corners.push_back(cornerIn(lines, word, mesh.vertices.size(), 1));
      if (corners.size() < 3) lines.fail(line, "the face has fewer than 3 corners");
      addFan(corners, mesh);
    }
  }
  return mesh;
}

/// Reads vertices and faces of a PLY behind its header.
class PlyMeshReader {
 public:
  PlyMeshReader(const std::string& path, std::string_view text)
      : path_(path), lines_(path, text), header_(readPlyHeader(lines_, path)) {
    for (int a = 0; a < 3; ++a) {
      place_[a] = header_.find(std::array{"x", "y", "z"}[a]);
      if (place_[a] < 0) throw SceneError(path_ + ": the vertices have no property " + "xyz"[a]);
    }
    if (!header_.faces)
      throw SceneError(path_ +
                       ": has no faces; a solid needs the element face with a list of vertex_indices");
  }

  TriangleMesh read() {
    if (header_.format == PlyFormat::ascii) {
      readAscii();
    } else {
      readBinary();
    }
    return std::move(mesh_);
  }

 private:
  std::string_view lineWithWords() {
    std::string_view line;
    while (lines_.next(line))
      if (!trimmed(line).empty()) return line;
    failShort();
  }
  [[noreturn]] void failShort() const {
    throw SceneError(path_ + ": is cut off: the header names " + std::to_string(header_.vertices) +
                     " vertices and " + std::to_string(header_.faces) + " faces");
  }

  void readAscii() {
    std::string_view word;
    for (std::size_t n = 0; n < header_.vertices; ++n) {
      const std::string_view line = lineWithWords();
      std::string_view rest = line;
      std::vector<double> values;
      while (nextWord(rest, word)) values.push_back(numberIn(lines_, word, "vertex"));
      if (values.size() != header_.properties.size()) lines_.fail(line, "has not one number a property");
      mesh_.vertices.emplace_back(values[place_[0]], values[place_[1]], values[place_[2]]);
    }
    for (std::size_t n = 0; n < header_.faces; ++n) {
      const std::string_view line = lineWithWords();
      std::string_view rest = line;
      nextWord(rest, word);
      const double length = numberIn(lines_, word, "face");
      std::vector<int> corners;
      while (static_cast<double>(corners.size()) < length && nextWord(rest, word))
        corners.push_back(cornerIn(lines_, word, header_.vertices, 0));
      if (length < 3 || static_cast<double>(corners.size()) != length)
        lines_.fail(line, "is no face of 3 or more corners");
      addFan(corners, mesh_);
    }
  }

  void readBinary() {
    std::string_view data = lines_.rest();
    const auto take = [&](std::size_t bytes) {
      if (bytes > data.size()) failShort();
      const char* start = data.data();
      data.remove_prefix(bytes);
      return start;
    };
    for (std::size_t n = 0; n < header_.vertices; ++n) {
      const char* vertex = take(header_.stride);
      Eigen::Vector3d x;
      for (int a = 0; a < 3; ++a) {
        const PlyProperty& property = header_.properties[place_[a]];
        x[a] = plyValue(vertex + property.offset, property.type);
      }
      mesh_.vertices.push_back(x);
    }
    for (std::size_t n = 0; n < header_.faces; ++n) {
      const double length = plyValue(take(plyBytes(header_.faceLength)), header_.faceLength);
      std::vector<int> corners;
      for (int c = 0; c < length; ++c)
        corners.push_back(checked(plyValue(take(plyBytes(header_.faceIndex)), header_.faceIndex), n));
      take(header_.faceTail);
      addFan(corners, mesh_);
    }
  }

  int checked(double index, std::size_t face) const {
    if (index >= 0 && index < static_cast<double>(header_.vertices)) return static_cast<int>(index);
    throw SceneError(path_ + ": face " + std::to_string(face) + " names vertex " + exactText(index) +
                     ", which is none of the " + std::to_string(header_.vertices));
  }

  const std::string& path_;
  TextLines lines_;
  PlyHeader header_;
  int place_[3];  // of x, y, z among the properties
  TriangleMesh mesh_;
};

bool isBefore(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// For every vertex the first one at the same place.
std::vector<int> joinEqual(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<int> order(vertices.size()), joined(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return isBefore(vertices[a], vertices[b]); });
  for (std::size_t n = 0; n < order.size(); ++n) {
    const bool same = n > 0 && vertices[order[n]] == vertices[order[n - 1]];
    joined[order[n]] = same ? joined[order[n - 1]] : order[n];
  }
  return joined;
}

std::string placeText(const Eigen::Vector3d& x) {
  return "(" + exactText(x.x()) + ", " + exactText(x.y()) + ", " + exactText(x.z()) + ")";
}

}  // namespace

TriangleMesh readMesh(const std::string& path) {
  const std::string text = readFile(path);
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  TriangleMesh mesh;
  if (ending == ".obj") {
    mesh = readObj(path, text);
  } else if (ending == ".ply") {
    mesh = PlyMeshReader(path, text).read();
  } else {
    throw SceneError(path + ": is no mesh that can be read; expected a file that ends in .obj or .ply");
  }
  const auto finite = [](const Eigen::Vector3d& x) { return x.allFinite(); };
  if (!std::all_of(mesh.vertices.begin(), mesh.vertices.end(), finite))
    throw SceneError(path + ": a vertex is not finite");
  if (mesh.triangles.empty()) throw SceneError(path + ": has no faces");
  return mesh;
}

void requireClosed(const TriangleMesh& mesh, const std::string& path) {
  const std::vector<int> joined = joinEqual(mesh.vertices);
  std::map<std::pair<int, int>, int> uses;
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    for (int n = 0; n < 3; ++n) {
      const int a = joined[triangle[n]], b = joined[triangle[(n + 1) % 3]];
      if (a != b) ++uses[std::minmax(a, b)];
    }
  for (const auto& [edge, triangles] : uses)
    if (triangles % 2 != 0)
      throw SceneError(
          path + ": the mesh leaks: the edge from vertex " + std::to_string(edge.first + 1) + " " +
          placeText(mesh.vertices[edge.first]) + " to vertex " + std::to_string(edge.second + 1) + " " +
          placeText(mesh.vertices[edge.second]) + " belongs to " + std::to_string(triangles) +
          " triangle(s), expected 2; close the hole, or join the vertices where it only seems open");
}

}  // namespace spume::coupling
