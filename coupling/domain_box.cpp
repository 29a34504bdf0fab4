#include "coupling/domain_box.h"

#include "coupling/object_label.h"
#include "coupling/scene_builder.h"
#include "coupling/shapes.h"
#include "coupling/toml_slot.h"

namespace spume::coupling {

DomainBox::DomainBox(const Scene& scene) : lower(scene.domain.lower), upper(gridOf(scene).upper()) {}

bool DomainBox::holds(const Eigen::Vector3d& x) const {
  return (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
}

bool DomainBox::reaches(const Eigen::Vector3d& x, double radius) const {
  return (x.array() > lower.array() - radius).all() && (x.array() < upper.array() + radius).all();
}

void DomainBox::requireOverlap(const ShapeSpec& shape) const {
  const auto [low, high] = bounds(shape);
  if ((low.array() < upper.array()).all() && (high.array() > lower.array()).all()) return;
  const auto& [key, value] = placeKey(shape);
  throw KeyFault(key, value + ": the " + nameOf(shape.kind) + " from " + exactText(low) + " to " +
                          exactText(high) + " m lies outside " + words() + "; move it or remove it");
}

std::string DomainBox::words() const {
  return "the domain from " + exactText(lower) + " to " + exactText(upper) + " m";
}

}  // namespace spume::coupling
