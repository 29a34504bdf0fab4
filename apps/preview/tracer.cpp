#include "apps/preview/tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/preview/fresnel.h"

namespace spume::apps {
namespace {

constexpr float kTraced =
    0.10f;  // mirror images weaker than this look up the surroundings instead of being traced
constexpr float kDropped = 0.004f;    // light that no 8-bit picture shows
constexpr int kMaxDepth = 22;         // interfaces after which a path ends in the mean light of foam
constexpr float kSolidAlbedo = 0.8f;  // pale ceramic
constexpr float kEdgeWidth = 0.003f;  // of the bright edge of a pane, as a share of the box
constexpr float kHaze = 0.08f;        // of the light on a bubble, scattered by what its film carries; by eye
const Vec3 kEdgeLight{0.40f, 0.55f, 0.53f};
const Vec3 kFoamLight{0.60f, 0.66f, 0.70f};
/// What is left of white light after crossing a box full of water once; by eye, stronger than real clear
/// water.
const Vec3 kThroughBox{0.35f, 0.76f, 0.88f};
const Vec3 kGlassTint{0.975f, 0.99f, 0.985f};
const Vec3 kClassColour[] = {{0.10f, 0.35f, 0.85f}, {0.10f, 0.65f, 0.25f}, {0.90f, 0.35f, 0.10f}};

Vec3 faceNormal(int face) { return (face % 2 ? 1.0f : -1.0f) * Vec3::Unit(face / 2); }

/// Colours of interference in a film whose thickness differs from bubble to bubble and runs thin upwards;
/// mean 1.
Vec3 filmColour(unsigned bubble, float cosIn, float height) {
  constexpr float kThinnest = 220e-9f, kSpread = 260e-9f;  // thickness of a young foam film [m]
  const float share = static_cast<float>((bubble * 2654435761u) >> 8 & 0xffff) / 65536.0f;
  const float thickness = (kThinnest + kSpread * share) * (1 - 0.3f * height);
  const float path =
      2 * kWaterIndex * thickness * std::sqrt(1 - (1 - cosIn * cosIn) / (kWaterIndex * kWaterIndex));
  const auto band = [&](float wavelength) {
    return 1 - 0.55f * std::cos(2 * static_cast<float>(M_PI) * path / wavelength);
  };
  return {band(610e-9f), band(545e-9f), band(465e-9f)};
}

}  // namespace

Tracer::Tracer(const PreviewScene& scene, PreviewStyle style, const RayScene& rays,
               const Environment& environment)
    : scene_(scene),
      style_(style),
      rays_(rays),
      environment_(environment),
      lower_(scene.lower.cast<float>()),
      upper_(scene.upper.cast<float>()),
      size_((upper_ - lower_).maxCoeff()) {
  absorption_ = -kThroughBox.array().log() / size_;
}

Vec3 Tracer::radiance(const Vec3& origin, const Vec3& direction) const {
  Work work;
  Path path{origin, direction, Vec3::Ones()};
  path.inBox = (origin.array() > lower_.array()).all() && (origin.array() < upper_.array()).all();
  path.inWater = path.inBox && liquidAt(origin);
  push(path, work);
  while (work.count > 0) {
    const Path next = work.pending[--work.count];
    advance(next, work);
  }
  return work.light;
}

void Tracer::push(const Path& path, Work& work) const {
  if (path.weight.maxCoeff() < kDropped) return;
  if (path.depth > kMaxDepth || work.count == Work::kCapacity)
    work.light += path.weight.cwiseProduct(kFoamLight);
  else
    work.pending[work.count++] = path;
}

void Tracer::advance(Path path, Work& work) const {
  ++path.depth;
  if (!path.inBox) return enterBox(path, work);
  int face = 0;
  const float toWall = wallDistance(path, face);
  const SurfaceHit hit = rays_.nearest(path.origin, path.direction, toWall);
  const float distance = hit.kind == SurfaceKind::none ? toWall : hit.distance;
  if (path.inWater && path.bubbles == 0)
    path.weight = path.weight.array() * (-absorption_ * distance).array().exp();
  path.origin += distance * path.direction;
  if (hit.kind == SurfaceKind::none)
    leaveBox(path, face, work);
  else
    meetSurface(path, hit, work);
}

/// A path outside the box: it meets the nearest pane or the surroundings.
void Tracer::enterBox(Path& path, Work& work) const {
  float in = 0, out = std::numeric_limits<float>::max();
  int face = -1;
  for (int a = 0; a < 3; ++a) {
    const float inverse = 1 / path.direction[a];
    const float toLower = (lower_[a] - path.origin[a]) * inverse,
                toUpper = (upper_[a] - path.origin[a]) * inverse;
    const float first = std::min(toLower, toUpper);
    if (first > in) in = first, face = 2 * a + (toUpper < toLower);
    out = std::min(out, std::max(toLower, toUpper));
  }
  if (face < 0 || in >= out) {
    work.light += path.weight.cwiseProduct(environment_.radiance(path.origin, path.direction));
    return;
  }
  path.origin += in * path.direction;
  path.inBox = true;
  path.inWater = liquidAt(path.origin);
  const Vec3 normal = faceNormal(face);
  const float cosIn = -path.direction.dot(normal);
  if (scene_.closed[face]) {
    const float share =
        path.inWater ? fresnelReflectance(cosIn, kGlassIndex) : sheetReflectance(cosIn, kGlassIndex);
    const Vec3 image = environment_.radiance(path.origin, reflect(path.direction, normal));
    work.light += path.weight.cwiseProduct(share * image + paneEdge(path.origin, face));
    path.weight = (1 - share) * path.weight.cwiseProduct(kGlassTint);
  }
  if (path.inWater) path.direction = refract(path.direction, normal, kWaterIndex);
  push(path, work);
}

float Tracer::wallDistance(const Path& path, int& face) const {
  float nearest = std::numeric_limits<float>::max();
  for (int a = 0; a < 3; ++a) {
    if (path.direction[a] == 0) continue;
    const bool up = path.direction[a] > 0;
    const float t = ((up ? upper_[a] : lower_[a]) - path.origin[a]) / path.direction[a];
    if (t < nearest) nearest = t, face = 2 * a + up;
  }
  return std::max(nearest, 0.0f);
}

/// A path inside the box that meets a pane, the base or the open top.
void Tracer::leaveBox(Path& path, int face, Work& work) const {
  const Vec3 normal = -faceNormal(face);  // faces the path
  if (face == 2) {
    work.light += path.weight.cwiseProduct(environment_.base(path.origin));
    return;
  }
  const bool wet = path.inWater && path.bubbles == 0;
  const float cosIn = -path.direction.dot(normal);
  float share = 0;
  if (wet)
    share = fresnelReflectance(cosIn, 1 / kWaterIndex);
  else if (scene_.closed[face])
    share = sheetReflectance(cosIn, kGlassIndex);
  if (share > 0) mirror(path, normal, Vec3::Constant(share), work);
  if (scene_.closed[face]) {
    work.light += path.weight.cwiseProduct(paneEdge(path.origin, face));
    path.weight = path.weight.cwiseProduct(kGlassTint);
  }
  if (share >= 1) return;
  const Vec3 direction = wet ? refract(path.direction, normal, 1 / kWaterIndex) : path.direction;
  work.light += (1 - share) * path.weight.cwiseProduct(environment_.radiance(path.origin, direction));
}

void Tracer::meetSurface(const Path& path, const SurfaceHit& hit, Work& work) const {
  if (hit.kind == SurfaceKind::bubble) return meetBubble(path, hit, work);
  const Vec3 normal = hit.entering ? hit.normal : Vec3(-hit.normal);
  if (hit.kind == SurfaceKind::solid) {
    work.light += path.weight.cwiseProduct(Environment::ambient(normal)) * kSolidAlbedo;
    return;
  }
  Path behind = path;
  behind.inWater = hit.entering;
  if (path.bubbles > 0 || path.inWater == hit.entering)
    return push(behind, work);  // no water inside a bubble
  const float eta = hit.entering ? kWaterIndex : 1 / kWaterIndex;
  split(path, behind, normal, Vec3::Constant(fresnelReflectance(-path.direction.dot(normal), eta)), eta,
        work);
}

void Tracer::meetBubble(const Path& path, const SurfaceHit& hit, Work& work) const {
  const Vec3 normal = hit.entering ? hit.normal : Vec3(-hit.normal);
  if (style_ == PreviewStyle::classes) {
    const Vec3& colour = kClassColour[static_cast<int>(scene_.bubbleType[hit.bubble])];
    work.light += path.weight.cwiseProduct(colour).cwiseProduct(Environment::ambient(normal));
    return;
  }
  Path behind = path;
  behind.bubbles = std::max(0, path.bubbles + (hit.entering ? 1 : -1));
  const float cosIn = std::min(1.0f, -path.direction.dot(normal));
  work.light += path.weight.cwiseProduct(Environment::ambient(normal)) * kHaze;
  if (path.inWater && std::max(path.bubbles, behind.bubbles) <= 1) {
    const float eta = hit.entering ? 1 / kWaterIndex : kWaterIndex;
    split(path, behind, normal, Vec3::Constant(fresnelReflectance(cosIn, eta)), eta, work);
  } else {  // air on both sides
    const Vec3 share = sheetReflectance(cosIn, kWaterIndex) * filmColour(hit.bubble, cosIn, hit.normal.y());
    split(path, behind, normal, share.cwiseMin(1), 1, work);
  }
}

void Tracer::split(const Path& front, Path behind, const Vec3& normal, const Vec3& share, float eta,
                   Work& work) const {
  mirror(front, normal, share, work);
  if (share.minCoeff() >= 1) return;
  behind.weight = behind.weight.cwiseProduct(Vec3::Ones() - share);
  if (eta != 1) behind.direction = refract(front.direction, normal, eta);
  push(behind, work);
}

void Tracer::mirror(const Path& path, const Vec3& normal, const Vec3& share, Work& work) const {
  Path image = path;
  image.weight = path.weight.cwiseProduct(share);
  image.direction = reflect(path.direction, normal);
  if (image.weight.maxCoeff() >= kTraced) return push(image, work);
  work.light += image.weight.cwiseProduct(environment_.radiance(image.origin, image.direction));
}

/// Light that the cut edges of the panes lead to the eye.
Vec3 Tracer::paneEdge(const Vec3& p, int face) const {
  float nearest = std::numeric_limits<float>::max();
  for (int a = 0; a < 3; ++a)
    if (a != face / 2) nearest = std::min({nearest, p[a] - lower_[a], upper_[a] - p[a]});
  const float x = nearest / (kEdgeWidth * size_);
  return kEdgeLight * std::exp(-x * x);
}

bool Tracer::liquidAt(const Vec3& p) const {
  const Eigen::Vector3d cells = scene_.grid.toCells(p.cast<double>()) - Eigen::Vector3d::Constant(0.5);
  Eigen::Vector3i c;
  Eigen::Vector3d f;
  for (int a = 0; a < 3; ++a) {
    const double inside = std::clamp(cells[a], 0.0, scene_.grid.cells[a] - 1.0);
    c[a] = std::min(static_cast<int>(inside), scene_.grid.cells[a] - 2);
    f[a] = inside - c[a];
  }
  double phi = 0;
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector3i o(n & 1, n >> 1 & 1, n >> 2 & 1);
    double weight = 1;
    for (int a = 0; a < 3; ++a) weight *= o[a] ? f[a] : 1 - f[a];
    phi += weight * scene_.phi(c + o);
  }
  return phi < 0;
}

}  // namespace spume::apps
