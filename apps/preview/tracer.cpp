#include "apps/preview/tracer.h"

#include <algorithm>
#include <cmath>

#include "apps/preview/bubble_paint.h"
#include "apps/preview/fresnel.h"

namespace spume::apps {
namespace {

/// Mirror images weaker than this look up the surroundings instead of being traced.
constexpr float kTraced = 0.10f;
constexpr float kDropped = 0.004f;     // light that no 8-bit picture shows
constexpr int kMaxDepth = 64;          // boundaries after which a path ends in the mean light of foam
constexpr float kSolidAlbedo = 0.75f;  // pale ceramic
constexpr float kBorderDepth = 4e-3f;  // liquid that scattered light has crossed in the borders of a foam [m]
constexpr float kContactLine = 0.8f;   // how much darker the line of a contact is in a diagram
const Vec3 kFoamLight{0.62f, 0.64f, 0.66f};

}  // namespace

Tracer::Tracer(const PreviewScene& scene, PreviewStyle style, const Optics& optics,
               const Environment& environment)
    : scene_(scene),
      style_(style),
      optics_(optics),
      environment_(environment),
      borderTint_(passedShare(
          absorptionOf(scene.look.liquidColour.cast<float>(), static_cast<float>(scene.look.colourDepth)),
          kBorderDepth)) {}

Vec3 Tracer::radiance(const Vec3& origin, const Vec3& direction) const {
  Work work;
  push({optics_.startAt(origin, direction), Vec3::Ones()}, work);
  while (work.count > 0) {
    const Branch next = work.pending[--work.count];
    advance(next, work);
  }
  return work.light;
}

void Tracer::push(const Branch& branch, Work& work) const {
  if (branch.weight.maxCoeff() < kDropped) return;
  if (branch.depth > kMaxDepth || work.count == Work::kCapacity)
    work.light += branch.weight.cwiseProduct(kFoamLight).cwiseProduct(borderTint_);
  else
    work.pending[work.count++] = branch;
}

void Tracer::advance(Branch branch, Work& work) const {
  ++branch.depth;
  const Crossing crossing = optics_.next(branch.path);
  branch.weight = branch.weight.cwiseProduct(crossing.passed);
  const Vec3& weight = branch.weight;
  const LightPath& path = branch.path;
  switch (crossing.kind) {
    case Boundary::surroundings:
      work.light += weight.cwiseProduct(environment_.radiance(path.origin, path.direction));
      break;
    case Boundary::table:
      work.light += weight.cwiseProduct(environment_.table(path.origin));
      break;
    case Boundary::matte:
      work.light += kSolidAlbedo * weight.cwiseProduct(environment_.ambient(crossing.normal));
      break;
    case Boundary::clear:
      meet(branch, crossing, work);
  }
}

/// A boundary light goes through: a part is mirrored, a part scattered, the rest goes on.
void Tracer::meet(const Branch& branch, const Crossing& crossing, Work& work) const {
  if (crossing.bubble >= 0 && style_ != PreviewStyle::beauty) {
    const Vec3 colour = bubblePaint(scene_, style_, crossing.bubble) * (1 - kContactLine * crossing.border);
    work.light += branch.weight.cwiseProduct(colour).cwiseProduct(environment_.ambient(crossing.normal));
    return;
  }
  if (crossing.scattered > 0)
    work.light += crossing.scattered *
                  branch.weight.cwiseProduct(borderTint_).cwiseProduct(environment_.ambient(crossing.normal));
  Branch rest = branch;
  rest.weight *= 1 - crossing.scattered;
  mirror(rest, crossing, work);
  if (!crossing.passes()) return;
  rest.weight = rest.weight.cwiseProduct(Vec3::Ones() - crossing.mirrored);
  rest.path = crossing.behind;
  push(rest, work);
}

void Tracer::mirror(const Branch& branch, const Crossing& crossing, Work& work) const {
  Branch image = branch;
  image.weight = branch.weight.cwiseProduct(crossing.mirrored);
  if (image.weight.maxCoeff() < kDropped) return;
  image.path.direction = reflect(branch.path.direction, crossing.normal);
  if (image.weight.maxCoeff() >= kTraced) return push(image, work);
  work.light += image.weight.cwiseProduct(environment_.radiance(image.path.origin, image.path.direction));
}

}  // namespace spume::apps
