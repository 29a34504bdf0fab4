#include "apps/preview/ray_scene.h"

#include <embree3/rtcore.h>

#include <stdexcept>
#include <utility>

#include "coupling/drop_cache.h"

namespace spume::apps {
namespace {

/// Geometry numbers: water, bubbles, drops, then one per solid.
constexpr unsigned kWaterGeometry = 0, kBubbleGeometry = 1, kDropGeometry = 2, kFirstSolid = 3;

void boundBubble(const RTCBoundsFunctionArguments* args) {
  const auto& cells = *static_cast<const BubbleCells*>(args->geometryUserPtr);
  const int bubble = static_cast<int>(args->primID);
  const Vec3 low = cells.centre(bubble).array() - cells.radius(bubble);
  const Vec3 high = cells.centre(bubble).array() + cells.radius(bubble);
  *args->bounds_o = {low.x(), low.y(), low.z(), 0, high.x(), high.y(), high.z(), 0};
}

/// Accepts the point where a single ray enters a cell.
void intersectBubble(const RTCIntersectFunctionNArguments* args) {
  const auto& cells = *static_cast<const BubbleCells*>(args->geometryUserPtr);
  auto& ray = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  if (!args->valid[0]) return;
  const Vec3 origin(ray.ray.org_x, ray.ray.org_y, ray.ray.org_z);
  const Vec3 direction(ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z);
  BubbleCells::Stretch stretch;
  if (!cells.cut(static_cast<int>(args->primID), origin, direction, stretch)) return;
  if (stretch.in <= ray.ray.tnear || stretch.in >= ray.ray.tfar) return;
  ray.ray.tfar = stretch.in;
  ray.hit.geomID = args->geomID;
  ray.hit.primID = args->primID;
}

}  // namespace

struct RayScene::Internals {
  RTCDevice device = nullptr;
  RTCScene everything = nullptr, solidsOnly = nullptr;
  SurfaceMesh water;
  std::vector<SurfaceMesh> solids;
  float offset = 0;  ///< shortest distance a ray sees [m]

  ~Internals() {
    if (everything) rtcReleaseScene(everything);
    if (solidsOnly) rtcReleaseScene(solidsOnly);
    if (device) rtcReleaseDevice(device);
  }
  RTCScene newScene() const;
  void addMesh(const SurfaceMesh& mesh, unsigned number, bool solid) const;
  void addBubbles(const BubbleCells& cells) const;
  void addDrops(std::span<const fluid::Drop> drops) const;
  SurfaceHit trace(RTCScene scene, const Vec3& origin, const Vec3& direction, float limit) const;
};

RTCScene RayScene::Internals::newScene() const {
  const RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  return scene;
}

void RayScene::Internals::addMesh(const SurfaceMesh& mesh, unsigned number, bool solid) const {
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
  rtcAttachGeometryByID(everything, geometry, number);
  if (solid) rtcAttachGeometryByID(solidsOnly, geometry, number);
  rtcReleaseGeometry(geometry);
}

void RayScene::Internals::addBubbles(const BubbleCells& cells) const {
  if (cells.size() == 0) return;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(cells.size()));
  rtcSetGeometryUserData(geometry, const_cast<BubbleCells*>(&cells));  // the callbacks only read
  rtcSetGeometryBoundsFunction(geometry, boundBubble, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersectBubble);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(everything, geometry, kBubbleGeometry);
  rtcReleaseGeometry(geometry);
}

void RayScene::Internals::addDrops(std::span<const fluid::Drop> drops) const {
  if (drops.empty()) return;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), drops.size()));
  for (std::size_t n = 0; n < drops.size(); ++n) {
    Eigen::Map<Vec3>(vertex + 4 * n) = drops[n].position.cast<float>();
    vertex[4 * n + 3] = static_cast<float>(coupling::radiusOf(drops[n]));
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(everything, geometry, kDropGeometry);
  rtcReleaseGeometry(geometry);
}

RayScene::RayScene(const PreviewScene& scene, const BubbleCells& cells, SurfaceMesh water,
                   std::vector<SurfaceMesh> solids)
    : internals_(std::make_unique<Internals>()) {
  internals_->water = std::move(water);
  internals_->solids = std::move(solids);
  constexpr double kOffset =
      2e-6;  // above the rounding of float positions, far below a bubble; share of the box
  internals_->offset = static_cast<float>(kOffset * (scene.upper - scene.lower).maxCoeff());
  internals_->device = rtcNewDevice(nullptr);
  if (!internals_->device) throw std::runtime_error("the ray tracing library could not start");
  internals_->everything = internals_->newScene();
  internals_->solidsOnly = internals_->newScene();
  internals_->addMesh(internals_->water, kWaterGeometry, false);
  internals_->addBubbles(cells);
  internals_->addDrops(scene.drops);
  for (std::size_t s = 0; s < internals_->solids.size(); ++s)
    internals_->addMesh(internals_->solids[s], kFirstSolid + static_cast<unsigned>(s), true);
  rtcCommitScene(internals_->everything);
  rtcCommitScene(internals_->solidsOnly);
}

RayScene::~RayScene() = default;
float RayScene::offset() const { return internals_->offset; }

SurfaceHit RayScene::nearest(const Vec3& origin, const Vec3& direction, float limit) const {
  return internals_->trace(internals_->everything, origin, direction, limit);
}

SurfaceHit RayScene::nearestSolid(const Vec3& origin, const Vec3& direction, float limit) const {
  return internals_->trace(internals_->solidsOnly, origin, direction, limit);
}

SurfaceHit RayScene::Internals::trace(RTCScene scene, const Vec3& origin, const Vec3& direction,
                                      float limit) const {
  RTCRayHit ray{};
  ray.ray.org_x = origin.x(), ray.ray.org_y = origin.y(), ray.ray.org_z = origin.z();
  ray.ray.dir_x = direction.x(), ray.ray.dir_y = direction.y(), ray.ray.dir_z = direction.z();
  ray.ray.tnear = offset;
  ray.ray.tfar = limit;
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};

  if (ray.hit.geomID == kBubbleGeometry)
    return {SurfaceKind::bubble, static_cast<int>(ray.hit.primID), ray.ray.tfar, Vec3::Zero(), true};
  const bool isDrop = ray.hit.geomID == kDropGeometry;
  const bool isWater = isDrop || ray.hit.geomID == kWaterGeometry;
  SurfaceHit hit{isWater ? SurfaceKind::water : SurfaceKind::solid,
                 isWater ? -1 : static_cast<int>(ray.hit.geomID - kFirstSolid), ray.ray.tfar, Vec3::Zero(),
                 false};
  const Vec3 flat(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
  hit.entering = flat.dot(direction) < 0;
  if (isDrop) {
    hit.normal = flat.normalized();
    return hit;
  }
  const SurfaceMesh& mesh = isWater ? water : solids[hit.index];
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
