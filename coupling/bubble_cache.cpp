#include "coupling/bubble_cache.h"

#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>

#include <algorithm>
#include <optional>

#include "coupling/bubble_record.h"
#include "coupling/drop_cache.h"
#include "coupling/vdb_file.h"

namespace spume::coupling {
namespace {

namespace points = openvdb::points;

constexpr char kGridName[] = "bubbles", kDropsName[] = "drops", kFlags[] = "flags";

/// Adds an attribute whose value for bubble n is value(n).
template <typename Value, typename Get>
void addAttribute(points::PointDataGrid& grid, const openvdb::tools::PointIndexGrid& index,
                  const std::string& name, std::size_t count, const Get& get) {
  std::vector<Value> values(count);
  for (std::size_t n = 0; n < count; ++n) values[n] = get(n);
  points::appendAttribute<Value>(grid.tree(), name);
  const points::PointAttributeVector<Value> wrapper(values);
  points::populateAttribute(grid.tree(), index.tree(), name, wrapper);
}

/// A grid of points without attributes yet, and the index that adds them.
struct PointSet {
  points::PointDataGrid::Ptr grid;
  openvdb::tools::PointIndexGrid::Ptr index;
};

PointSet pointsAt(const std::vector<openvdb::Vec3d>& places, double voxel) {
  const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
  const points::PointAttributeVector<openvdb::Vec3d> positions(places);
  const auto index =
      openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(positions, *transform);
  return {
      points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(*index, positions, *transform),
      index};
}

points::PointDataGrid::Ptr pointGrid(const foam::BubbleStore& bubbles, double voxel) {
  const std::size_t count = bubbles.size();
  std::vector<openvdb::Vec3d> places(count);
  for (std::size_t n = 0; n < count; ++n) places[n] = openvdb::Vec3d(bubbles.position[n].data());
  const auto [grid, index] = pointsAt(places, voxel);
  const auto velocity = [&](std::size_t n) {
    return openvdb::Vec3s(openvdb::Vec3d(bubbles.velocity[n].data()));
  };
  const auto column = [](const std::vector<double>& values) {
    return [&values](std::size_t n) { return static_cast<float>(values[n]); };
  };
  addAttribute<openvdb::Vec3s>(*grid, *index, "v", count, velocity);
  addAttribute<float>(*grid, *index, "pscale", count, column(bubbles.radius));
  addAttribute<std::int64_t>(*grid, *index, "id", count,
                             [&](std::size_t n) { return static_cast<std::int64_t>(bubbles.id[n]); });
  addAttribute<float>(*grid, *index, "age", count, column(bubbles.age));
  addAttribute<std::int32_t>(*grid, *index, "type", count,
                             [&](std::size_t n) { return static_cast<std::int32_t>(bubbles.type[n]); });
  addAttribute<float>(*grid, *index, "vol", count, column(bubbles.gas));
  addAttribute<float>(*grid, *index, "wetness", count, column(bubbles.wetness));
  addAttribute<std::int32_t>(*grid, *index, kFlags, count,
                             [&](std::size_t n) { return flagsOf(bubbles, n); });
  return grid;
}

points::PointDataGrid::Ptr pointGrid(const std::vector<fluid::Drop>& drops, double voxel) {
  std::vector<openvdb::Vec3d> places;
  for (const fluid::Drop& drop : drops) places.emplace_back(drop.position.data());
  const auto [grid, index] = pointsAt(places, voxel);
  const auto add = [&, &grid = grid, &index = index]<typename Value>(const char* name, const auto& get) {
    addAttribute<Value>(*grid, *index, name, drops.size(), [&](std::size_t n) { return get(drops[n]); });
  };
  using fluid::Drop;
  add.operator()<openvdb::Vec3s>(
      "v", [](const Drop& d) { return openvdb::Vec3s(openvdb::Vec3d(d.velocity.data())); });
  add.operator()<float>("pscale", [](const Drop& d) { return static_cast<float>(radiusOf(d)); });
  add.operator()<float>("vol", [](const Drop& d) { return static_cast<float>(d.volume); });
  add.operator()<std::int64_t>("id", [](const Drop& d) { return static_cast<std::int64_t>(d.id); });
  return grid;
}

using Leaf = points::PointDataTree::LeafNodeType;

void appendDrops(const Leaf& leaf, const openvdb::math::Transform& transform,
                 std::vector<fluid::Drop>& drops) {
  const points::AttributeHandle<openvdb::Vec3f> place(leaf.constAttributeArray("P")),
      velocity(leaf.constAttributeArray("v"));
  const points::AttributeHandle<float> volume(leaf.constAttributeArray("vol"));
  const points::AttributeHandle<std::int64_t> id(leaf.constAttributeArray("id"));
  for (auto at = leaf.beginIndexOn(); at; ++at) {
    const openvdb::Vec3d world =
        transform.indexToWorld(openvdb::Vec3d(place.get(*at)) + at.getCoord().asVec3d());
    const openvdb::Vec3f speed = velocity.get(*at);
    drops.push_back({Eigen::Map<const Eigen::Vector3d>(world.asPointer()),
                     Eigen::Map<const Eigen::Vector3f>(speed.asPointer()).cast<double>(), volume.get(*at),
                     static_cast<std::uint64_t>(id.get(*at))});
  }
}

void appendRecords(const Leaf& leaf, const openvdb::math::Transform& transform,
                   std::vector<BubbleRecord>& records) {
  const auto numbers = [&](const char* name) {
    return points::AttributeHandle<float>(leaf.constAttributeArray(name));
  };
  const points::AttributeHandle<openvdb::Vec3f> place(leaf.constAttributeArray("P")),
      velocity(leaf.constAttributeArray("v"));
  const points::AttributeHandle<std::int64_t> id(leaf.constAttributeArray("id"));
  const points::AttributeHandle<std::int32_t> type(leaf.constAttributeArray("type"));
  const auto radius = numbers("pscale"), age = numbers("age"), gas = numbers("vol"),
             wetness = numbers("wetness");
  std::optional<points::AttributeHandle<std::int32_t>> flags;
  if (leaf.hasAttribute(kFlags)) flags.emplace(leaf.constAttributeArray(kFlags));
  for (auto at = leaf.beginIndexOn(); at; ++at) {
    BubbleRecord record;
    const openvdb::Vec3d world =
        transform.indexToWorld(openvdb::Vec3d(place.get(*at)) + at.getCoord().asVec3d());
    const openvdb::Vec3f speed = velocity.get(*at);
    for (int axis = 0; axis < 3; ++axis)
      record.position[axis] = world[axis], record.velocity[axis] = speed[axis];
    record.radius = radius.get(*at), record.age = age.get(*at);
    record.gas = gas.get(*at), record.wetness = wetness.get(*at);
    record.id = id.get(*at), record.type = type.get(*at);
    if (flags) record.flags = flags->get(*at);
    records.push_back(record);
  }
}

}  // namespace

void writeBubblesVdb(const std::string& path, const foam::BubbleStore& bubbles, const FrameStamp& stamp,
                     double voxel) {
  openvdb::initialize();
  const auto grid = pointGrid(bubbles, voxel);
  grid->setName(kGridName);
  stampGrid(*grid, stamp);
  writeVdb(path, {grid});
}

void writeDropsVdb(const std::string& path, const std::vector<fluid::Drop>& drops, const FrameStamp& stamp,
                   double voxel) {
  openvdb::initialize();
  const auto grid = pointGrid(drops, voxel);
  grid->setName(kDropsName);
  stampGrid(*grid, stamp);
  writeVdb(path, {grid});
}

std::vector<fluid::Drop> readDropsVdb(const std::string& path) {
  const auto grid = findGrid<points::PointDataGrid>(readVdb(path), kDropsName);
  if (!grid) throw SceneError(path + ": holds no points called " + kDropsName);
  std::vector<fluid::Drop> drops;
  try {
    for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) appendDrops(*leaf, grid->transform(), drops);
  } catch (const openvdb::Exception& error) {
    throw SceneError(path + ": lacks an attribute of a drop: " + error.what());
  }
  std::sort(drops.begin(), drops.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return drops;
}

BubbleFrame readBubblesVdb(const std::string& path) {
  const auto grid = findGrid<points::PointDataGrid>(readVdb(path), kGridName);
  if (!grid) throw SceneError(path + ": holds no points called " + kGridName);
  std::vector<BubbleRecord> records;
  try {
    for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf)
      appendRecords(*leaf, grid->transform(), records);
  } catch (const openvdb::Exception& error) {
    throw SceneError(path + ": lacks an attribute of a bubble: " + error.what());
  }
  return {stampOf(*grid), storeOf(std::move(records), path)};
}

}  // namespace spume::coupling
