#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "coupling/text_fields.h"

namespace spume::coupling {

enum class PlyFormat { ascii, binaryLittleEndian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// A scalar property of a PLY vertex.
struct PlyProperty {
  std::string name;
  PlyType type;
  std::size_t offset;  ///< in the vertex of a binary file [bytes]
};

/// What a PLY file says about its vertices and, where they follow at once, its faces.
struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::size_t vertices = 0;
  std::size_t stride = 0;  ///< of a vertex in a binary file [bytes]
  std::vector<PlyProperty> properties;
  std::size_t faces = 0;  ///< 0 unless the second element is `face` and starts with a list of indices
  PlyType faceLength = PlyType::uint8, faceIndex = PlyType::int32;  ///< types of that list
  std::size_t faceTail = 0;  ///< bytes behind it in a face of a binary file

  /// Index of the property called `name`, or -1.
  int find(std::string_view name) const;
};

/// Reads the header and leaves `lines` behind it. The first element must be `vertex`, all its properties
/// scalar; elements but `face` after it are ignored. Throws SceneError.
PlyHeader readPlyHeader(TextLines& lines, const std::string& path);

std::size_t plyBytes(PlyType type);

/// A property's value at `bytes`, little endian whatever the machine.
double plyValue(const char* bytes, PlyType type);

}  // namespace spume::coupling
