#pragma once

#include <algorithm>
#include <string>
#include <type_traits>
#include <vector>

#include "coupling/key_table_builder.h"
#include "coupling/shapes.h"

namespace spume::coupling {

inline const KeyRange kPlace{-1e4, 1e4, "m"};
inline const KeyRange kLength{1e-6, 1e4, "m"};
inline const KeyRange kDirection{-1e6, 1e6, "-"};

/// Whether the object has a shape of its own.
inline bool hasShape(const SolidSpec&) { return true; }
inline bool hasShape(const LiquidBodySpec& body) { return body.vessel.empty(); }

inline bool hasShape(const OutflowSpec&) { return true; }
inline bool hasShape(const BubbleSourceSpec&) { return true; }
inline bool hasShape(const BubbleKillSpec&) { return true; }
inline bool hasShape(const ProbeSpec& probe) { return probe.kind == ProbeKind::volume; }

/// The keys of `Object::shape`, each only where the kind of the shape uses it.
template <typename Object>
class ShapeKeys {
 public:
  ShapeKeys(KeyTableBuilder<Object>& table, const std::vector<ShapeKind>& kinds) : table_(table) {
    std::vector<std::string> names;
    for (const ShapeKind kind : kinds) names.emplace_back(nameOf(kind));
    table.choice(
        "shape", [](Object & o) -> auto& { return o.shape.kind; }, names, "kind of the shape");
    if (std::is_same_v<Object, LiquidBodySpec>) table.onlyIf(hasShapeOf, "bodies without a vessel");
    if (std::is_same_v<Object, ProbeSpec>) table.onlyIf(hasShapeOf, "volume");
  }

  void addPrimitives() {
    using enum ShapeKind;
    add("lower", &ShapeSpec::lower, kPlace, "low corner", {box});
    add("upper", &ShapeSpec::upper, kPlace, "high corner", {box});
    add("centre", &ShapeSpec::centre, kPlace,
        "centre, a point of the plane, or the middle of a vessel's inner bottom",
        {sphere, cylinder, halfSpace, vessel});
    add("axis", &ShapeSpec::axis, kDirection, "axis, normal out of the shape, or towards a vessel's mouth",
        {cylinder, halfSpace, vessel});
    add("radius", &ShapeSpec::radius, kLength, "radius", {sphere, cylinder});
    add("height", &ShapeSpec::height, kLength, "length along the axis", {cylinder});
  }
  void addVessel() {
    using enum ShapeKind;
    add("inner_diameter", &ShapeSpec::innerDiameter, kLength, "of the inside", {vessel});
    add("inner_height", &ShapeSpec::innerHeight, kLength, "from the inner bottom to the rim", {vessel});
    add("wall_thickness", &ShapeSpec::wallThickness, kLength, "of its wall", {vessel});
    add("bottom_thickness", &ShapeSpec::bottomThickness, kLength, "of its bottom", {vessel});
  }
  void addFile() {
    using enum ShapeKind;
    add("file", &ShapeSpec::file, {0, 0, ""},
        "closed mesh (.obj, .ply) or level set (.vdb); from the scene's folder", {mesh, levelSet});
    add("scale", &ShapeSpec::scale, kLength, "of a unit of the file", {mesh, levelSet});
  }

 private:
  static bool hasShapeOf(const Object& object) { return hasShape(object); }

  template <typename Member>
  void add(const char* name, Member member, const KeyRange& range, const char* meaning,
           const std::vector<ShapeKind>& kinds) {
    std::string words;
    for (const ShapeKind kind : kinds) words.append(words.empty() ? "" : ", ").append(nameOf(kind));
    table_
        .key(
            name, [member](Object & o) -> auto& { return o.shape.*member; }, range, meaning)
        .onlyIf(
            [kinds](const Object& object) {
              return hasShapeOf(object) &&
                     std::find(kinds.begin(), kinds.end(), object.shape.kind) != kinds.end();
            },
            words);
  }

  KeyTableBuilder<Object>& table_;
};

}  // namespace spume::coupling
