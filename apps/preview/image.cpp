#include "apps/preview/image.h"

#include <png.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "coupling/scene_toml.h"

namespace spume::apps {

void writePng(const Image& image, const std::string& path) {
  const std::string temporary = path + ".tmp";
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = image.width;
  header.height = image.height;
  header.format = PNG_FORMAT_RGB;
  if (!png_image_write_to_file(&header, temporary.c_str(), 0, image.rgb.data(), 0, nullptr)) {
    const std::string reason = errno ? std::strerror(errno) : header.message;
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw coupling::FileError(path + ": cannot write the picture: " + reason);
  }
  std::error_code error;
  std::filesystem::rename(temporary, path, error);
  if (error) throw coupling::FileError(path + ": cannot write the picture: " + error.message());
}

}  // namespace spume::apps
