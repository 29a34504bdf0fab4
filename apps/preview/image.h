#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace spume::apps {

/// An 8-bit sRGB picture, rows from the top.
struct Image {
  int width = 0, height = 0;      ///< [pixels]
  std::vector<std::uint8_t> rgb;  ///< 3 x width x height

  Image() = default;
  Image(int w, int h) : width(w), height(h), rgb(std::size_t{3} * w * h) {}
};

/// Writes `image` under a temporary name beside `path`, then renames it. Throws coupling::FileError.
void writePng(const Image& image, const std::string& path);

}  // namespace spume::apps
