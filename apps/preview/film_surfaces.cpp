#include "apps/preview/film_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace spume::apps {
namespace {

constexpr float kParallel = 1e-3f;  // length below which a direction is round-off

/// Normals of a film's nodes: of the triangles around them, by their areas.
std::vector<Vec3> normalsOf(const foam::FilmNetwork& network, const foam::NetworkFilm& film) {
  std::vector<Vec3> normal(film.endSlot - film.firstSlot, Vec3::Zero());
  for (std::int32_t t = film.firstTriangle; t < film.endTriangle; ++t) {
    const auto& corner = network.triangles[t];
    const Eigen::Vector3d& a = network.at(film, corner[0]);
    const Eigen::Vector3d square = (network.at(film, corner[1]) - a).cross(network.at(film, corner[2]) - a);
    for (const std::int32_t c : corner) normal[c] += square.cast<float>();
  }
  for (Vec3& n : normal) n = n.norm() > 0 ? Vec3(n.normalized()) : Vec3::UnitY();
  return normal;
}

}  // namespace

FilmSurfaces::FilmSurfaces(const foam::SoapFilms& films, std::size_t bubbles, float offset)
    : device_(rtcNewDevice(nullptr)), offset_(offset) {
  if (!device_) throw std::runtime_error("the ray tracing library could not start");
  take(films, bubbles);
  build();
}

void FilmSurfaces::take(const foam::SoapFilms& films, std::size_t bubbles) {
  const foam::FilmNetwork& network = films.network;
  for (const foam::FilmNode& node : network.nodes) node_.push_back(node.position.cast<float>());
  atWall_.resize(bubbles);
  for (const foam::NetworkFilm& film : network.films) {
    const int first = static_cast<int>(stretch_.size());
    for (std::int32_t s = 0; s < film.rim; ++s) {
      const std::int32_t slot = film.firstSlot + s, next = film.firstSlot + (s + 1) % film.rim;
      const Stretch stretch{network.slots[slot], network.slots[next]};
      stretch_.push_back(stretch);
      const auto slides = [&](Node node) {
        const foam::NodeHold hold = network.nodes[node].hold;
        return hold == foam::NodeHold::plane || hold == foam::NodeHold::line;
      };
      if (network.borderOfSlot[slot][0] < 0 && slides(stretch.from) && slides(stretch.to))
        for (const std::int32_t bubble : {film.i, film.j}) atWall_[bubble].push_back(stretch);
    }
    const std::vector<Vec3> normal = normalsOf(network, film);
    for (std::int32_t t = film.firstTriangle; t < film.endTriangle; ++t) {
      const auto [a, b, c] = network.triangles[t];
      triangle_.push_back({network.slots[film.firstSlot + a], network.slots[film.firstSlot + b],
                           network.slots[film.firstSlot + c]});
      smooth_.push_back({normal[a], normal[b], normal[c]});
      filmOf_.push_back(static_cast<std::int32_t>(film_.size()));
    }
    film_.push_back({film.i, film.j, first, static_cast<int>(stretch_.size())});
  }
}

void FilmSurfaces::build() {
  scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  if (!triangle_.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), node_.size()));
    for (std::size_t n = 0; n < node_.size(); ++n) Eigen::Map<Vec3>(vertex + 3 * n) = node_[n];
    auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangle_.size()));
    for (const auto& triangle : triangle_)
      for (const Node node : triangle) *index++ = static_cast<unsigned>(node);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene_.get());
}

bool FilmSurfaces::meet(const Vec3& origin, const Vec3& direction, float limit, Hit& hit) const {
  RTCRayHit ray{};
  ray.ray.org_x = origin.x(), ray.ray.org_y = origin.y(), ray.ray.org_z = origin.z();
  ray.ray.dir_x = direction.x(), ray.ray.dir_y = direction.y(), ray.ray.dir_z = direction.z();
  ray.ray.tnear = offset_, ray.ray.tfar = limit, ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene_.get(), &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  const Film& film = film_[filmOf_[ray.hit.primID]];
  const auto& normal = smooth_[ray.hit.primID];
  const Vec3 flat(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
  const bool toJ = flat.dot(direction) > 0;
  const Vec3 smooth = (1 - ray.hit.u - ray.hit.v) * normal[0] + ray.hit.u * normal[1] + ray.hit.v * normal[2];
  hit.distance = ray.ray.tfar, hit.film = filmOf_[ray.hit.primID];
  hit.near = toJ ? film.i : film.j, hit.far = toJ ? film.j : film.i;
  // A smooth normal that leans to the other side of the triangle would bend the ray back.
  const bool leans = (smooth.dot(direction) > 0) != toJ;
  hit.normal = (toJ ? 1.0f : -1.0f) * (leans ? flat.normalized() : smooth.normalized());
  return true;
}

/// Distance from p to the nearest of these stretches, and the way there.
float FilmSurfaces::towards(const Stretch* first, const Stretch* end, const Vec3& p, Vec3& nearest) const {
  float least = std::numeric_limits<float>::max();
  for (const Stretch* s = first; s != end; ++s) {
    const Vec3 along = node_[s->to] - node_[s->from], from = p - node_[s->from];
    const float length2 = along.squaredNorm();
    const float share = length2 > 0 ? std::clamp(from.dot(along) / length2, 0.0f, 1.0f) : 0.0f;
    const Vec3 way = share * along - from;
    if (const float distance = way.norm(); distance < least) least = distance, nearest = way;
  }
  return least;
}

Rounding FilmSurfaces::rounded(const Hit& hit, const Vec3& p, float width) const {
  Rounding rounded{hit.normal, 0};
  const Film& film = film_[hit.film];
  Vec3 way;
  const float distance = towards(&stretch_[film.firstStretch], stretch_.data() + film.endStretch, p, way);
  if (distance >= width) return rounded;
  rounded.share = borderShare(distance, width);
  const Vec3 inFilm = way - way.dot(hit.normal) * hit.normal;
  if (inFilm.norm() > kParallel * width)
    rounded.normal = (hit.normal - kFilmTurn * rounded.share * inFilm.normalized()).normalized();
  return rounded;
}

Rounding FilmSurfaces::roundedAtWall(int bubble, const Vec3& p, const Vec3& flat, float width) const {
  Rounding rounded{flat, 0};
  const std::vector<Stretch>& films = atWall_[bubble];
  Vec3 way;
  const float distance = towards(films.data(), films.data() + films.size(), p, way);
  if (distance >= width) return rounded;
  rounded.share = borderShare(distance, width);
  const Vec3 across = way - way.dot(flat) * flat;
  if (across.norm() > kParallel * width)
    rounded.normal = (flat - kFilmTurn * rounded.share * across.normalized()).normalized();
  return rounded;
}

}  // namespace spume::apps
