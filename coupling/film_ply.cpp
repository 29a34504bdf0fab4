#include <bit>
#include <sstream>

#include "coupling/atomic_file.h"
#include "coupling/film_cache.h"

namespace spume::coupling {
namespace {

static_assert(std::endian::native == std::endian::little, "the caches are written as they lie in memory");

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
         << network.triangles.size()
         << "\nproperty list uchar int vertex_indices\nproperty double id_a\nproperty double id_b\n"
            "property float curvature\nend_header\n";
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

}  // namespace spume::coupling
