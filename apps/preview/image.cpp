#include "apps/preview/image.h"

#include <png.h>

#include <cerrno>
#include <cstring>

#include "coupling/atomic_file.h"

namespace spume::apps {

void writePng(const Image& image, const std::string& path) {
  coupling::replaceFile(path, [&](const std::string& temporary) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = image.width;
    header.height = image.height;
    header.format = PNG_FORMAT_RGB;
    errno = 0;
    if (!png_image_write_to_file(&header, temporary.c_str(), 0, image.rgb.data(), 0, nullptr))
      throw coupling::FileError(
          path + ": cannot write the picture: " + (errno ? std::strerror(errno) : header.message));
  });
}

}  // namespace spume::apps
