#include "apps/preview/ray_scene.h"

#include <embree3/rtcore.h>

#include <stdexcept>
#include <utility>

#include "coupling/drop_cache.h"

namespace spume::apps {

struct RayScene::Internals {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  SurfaceMesh water, solid;
  float offset = 0;  ///< shortest distance a ray sees [m]

  ~Internals() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
  void addMesh(const SurfaceMesh& mesh, SurfaceKind kind);
  /// `count` balls; ball(n) gives centre and radius [m].
  template <typename Ball>
  void addBalls(SurfaceKind kind, std::size_t count, const Ball& ball);
};

void RayScene::Internals::addMesh(const SurfaceMesh& mesh, SurfaceKind kind) {
  if (mesh.position.empty()) return;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.position.size()));
  auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangles()));
  for (std::size_t v = 0; v < mesh.position.size(); ++v) {
    Eigen::Map<Vec3>(vertex + 3 * v) = mesh.position[v];
    index[v] = static_cast<unsigned>(v);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(kind));
  rtcReleaseGeometry(geometry);
}

template <typename Ball>
void RayScene::Internals::addBalls(SurfaceKind kind, std::size_t count, const Ball& ball) {
  if (count == 0) return;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                             RTC_FORMAT_FLOAT4, 4 * sizeof(float), count));
  for (std::size_t n = 0; n < count; ++n) {
    const auto [centre, radius] = ball(n);
    Eigen::Map<Vec3>(vertex + 4 * n) = centre.template cast<float>();
    vertex[4 * n + 3] = static_cast<float>(radius);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(kind));
  rtcReleaseGeometry(geometry);
}

RayScene::RayScene(const PreviewScene& scene, SurfaceMesh water, SurfaceMesh solid)
    : internals_(std::make_unique<Internals>()) {
  internals_->water = std::move(water);
  internals_->solid = std::move(solid);
  constexpr double kOffset =
      2e-6;  // above the rounding of float positions, far below a bubble; share of the box
  internals_->offset = static_cast<float>(kOffset * (scene.upper - scene.lower).maxCoeff());
  internals_->device = rtcNewDevice(nullptr);
  if (!internals_->device) throw std::runtime_error("the ray tracing library could not start");
  internals_->scene = rtcNewScene(internals_->device);
  rtcSetSceneFlags(internals_->scene, RTC_SCENE_FLAG_ROBUST);
  internals_->addMesh(internals_->water, SurfaceKind::water);
  internals_->addMesh(internals_->solid, SurfaceKind::solid);
  internals_->addBalls(SurfaceKind::bubble, scene.bubblePosition.size(), [&](std::size_t b) {
    return std::pair(scene.bubblePosition[b], scene.bubbleRadius[b]);
  });
  internals_->addBalls(SurfaceKind::drop, scene.drops.size(), [&](std::size_t d) {
    return std::pair(scene.drops[d].position, coupling::radiusOf(scene.drops[d]));
  });
  rtcCommitScene(internals_->scene);
}

RayScene::~RayScene() = default;

SurfaceHit RayScene::nearest(const Vec3& origin, const Vec3& direction, float limit) const {
  RTCRayHit ray{};
  ray.ray.org_x = origin.x(), ray.ray.org_y = origin.y(), ray.ray.org_z = origin.z();
  ray.ray.dir_x = direction.x(), ray.ray.dir_y = direction.y(), ray.ray.dir_z = direction.z();
  ray.ray.tnear = internals_->offset;
  ray.ray.tfar = limit;
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(internals_->scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};

  SurfaceHit hit;
  hit.kind = static_cast<SurfaceKind>(ray.hit.geomID);
  hit.distance = ray.ray.tfar;
  const Vec3 flat(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
  hit.entering = flat.dot(direction) < 0;
  if (hit.kind == SurfaceKind::bubble) {
    hit.bubble = ray.hit.primID;
    hit.normal = flat.normalized();
    return hit;
  }
  if (hit.kind == SurfaceKind::drop) {
    hit.kind = SurfaceKind::water;
    hit.normal = flat.normalized();
    return hit;
  }
  const SurfaceMesh& mesh = hit.kind == SurfaceKind::water ? internals_->water : internals_->solid;
  const std::size_t v = std::size_t{3} * ray.hit.primID;
  hit.normal = ((1 - ray.hit.u - ray.hit.v) * mesh.normal[v] + ray.hit.u * mesh.normal[v + 1] +
                ray.hit.v * mesh.normal[v + 2])
                   .normalized();
  // A smooth normal that leans to the other side of the triangle would bend the ray back: use the flat one
  // there.
  if ((hit.normal.dot(direction) < 0) != hit.entering) hit.normal = flat.normalized();
  return hit;
}

}  // namespace spume::apps
