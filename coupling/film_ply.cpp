#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <set>
#include <sstream>
#include <utility>

#include "coupling/atomic_file.h"
#include "coupling/film_cache.h"

namespace spume::coupling {
namespace {

static_assert(std::endian::native == std::endian::little, "the caches are written as they lie in memory");

constexpr char kFaceProperties[] =
    "property list uchar int vertex_indices\nproperty double id_a\nproperty double id_b\n"
    "property float curvature\n";
constexpr char kEnd[] = "end_header\n";

/// A vertex and a face of the body, packed.
struct Vertex {
  float x[3];
};
struct Face {
  std::int32_t corner[3];
  double ids[2];
};
constexpr std::size_t kFaceBytes =
    sizeof(std::uint8_t) + 3 * sizeof(std::int32_t) + 2 * sizeof(double) + sizeof(float);

Face faceAt(const char* in) {
  Face face;
  std::memcpy(face.corner, in + 1, sizeof face.corner);
  std::memcpy(face.ids, in + 1 + sizeof face.corner, sizeof face.ids);
  return face;
}

/// How many of an element the header announces; 0 if it names none.
std::size_t announced(const std::string& header, const std::string& element) {
  const std::size_t at = header.find("element " + element + " ");
  return at == std::string::npos ? 0 : std::strtoul(header.c_str() + at + element.size() + 9, nullptr, 10);
}

template <typename Value>
void put(std::string& out, Value value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string headerOf(const foam::FilmNetwork& network, const FrameStamp& stamp) {
  std::ostringstream header;
  header.precision(17);
  header << "ply\nformat binary_little_endian 1.0\ncomment frame " << stamp.frame << "\ncomment time "
         << stamp.time << "\ncomment fps " << stamp.fps << "\nelement vertex " << network.nodes.size()
         << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
         << network.triangles.size() << "\n"
         << kFaceProperties << "end_header\n";
  return header.str();
}

}  // namespace

void writeFilmsPly(const std::string& path, const foam::SoapFilms& films,
                   const std::vector<std::uint64_t>& ids, const FrameStamp& stamp) {
  const foam::FilmNetwork& network = films.network;
  std::string contents = headerOf(network, stamp);
  for (const foam::FilmNode& node : network.nodes)
    for (const double x : node.position) put(contents, static_cast<float>(x));
  for (const foam::NetworkFilm& film : network.films)
    for (std::int32_t t = film.firstTriangle; t < film.endTriangle; ++t) {
      put(contents, std::uint8_t{3});
      for (const std::int32_t corner : network.triangles[t])
        put(contents, network.slots[film.firstSlot + corner]);
      put(contents, static_cast<double>(ids[film.i]));
      put(contents, static_cast<double>(ids[film.j]));
      put(contents, static_cast<float>(films.curvature(film)));
    }
  replaceFile(path, contents);
}

FilmTotals readFilmTotals(const std::string& path) {
  const std::string contents = readFile(path);
  const std::size_t end = contents.find(kEnd);
  const std::string header = contents.substr(0, std::min(end, contents.size()));
  if (end == std::string::npos || header.find(kFaceProperties) == std::string::npos)
    throw SceneError(path + ": is not a PLY file of films as this program writes it");
  FilmTotals totals;
  totals.vertices = announced(header, "vertex"), totals.triangles = announced(header, "face");
  const char* const body = contents.data() + end + std::strlen(kEnd);
  const std::size_t bytes = totals.vertices * sizeof(Vertex) + totals.triangles * kFaceBytes;
  if (body + bytes != contents.data() + contents.size()) throw SceneError(path + ": is cut off");
  std::vector<Vertex> vertices(totals.vertices);
  if (bytes > 0) std::memcpy(vertices.data(), body, totals.vertices * sizeof(Vertex));
  const auto place = [&](std::int32_t corner) -> Eigen::Vector3d {
    if (corner < 0 || static_cast<std::size_t>(corner) >= vertices.size())
      throw SceneError(path + ": a face names vertex " + std::to_string(corner) + " of " +
                       std::to_string(vertices.size()));
    return Eigen::Map<const Eigen::Vector3f>(vertices[corner].x).cast<double>();
  };
  std::set<std::pair<double, double>> films;
  for (std::size_t t = 0; t < totals.triangles; ++t) {
    const Face face = faceAt(body + totals.vertices * sizeof(Vertex) + t * kFaceBytes);
    const Eigen::Vector3d a = place(face.corner[0]);
    totals.area += 0.5 * (place(face.corner[1]) - a).cross(place(face.corner[2]) - a).norm();
    films.emplace(face.ids[0], face.ids[1]);
  }
  totals.films = films.size();
  return totals;
}

}  // namespace spume::coupling
