#include "coupling/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

namespace spume::coupling {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& action, int error) {
  throw FileError(path + ": cannot " + action + ": " + std::strerror(error));
}

/// Hands the file's contents to the disk, so that a full one is noticed here and not after the rename.
void flushToDisk(const std::string& temporary, const std::string& path) {
  const int file = ::open(temporary.c_str(), O_RDONLY);
  if (file < 0) fail(path, "write", errno);
  const int failed = ::fsync(file) ? errno : 0;
  ::close(file);
  if (failed && failed != EINVAL) fail(path, "write", failed);
}

/// Removes the temporary file unless it was renamed.
struct TemporaryFile {
  std::string path;
  ~TemporaryFile() { ::unlink(path.c_str()); }
};

}  // namespace

void replaceFile(const std::string& path, const std::function<void(const std::string&)>& write) {
  const TemporaryFile temporary{path + ".part" + std::to_string(::getpid())};
  write(temporary.path);
  flushToDisk(temporary.path, path);
  if (std::rename(temporary.path.c_str(), path.c_str())) fail(path, "write", errno);
}

void replaceFile(const std::string& path, std::string_view contents) {
  replaceFile(path, [&](const std::string& temporary) {
    errno = 0;
    std::ofstream file(temporary, std::ios::binary);
    file.write(contents.data(), static_cast<std::streamsize>(contents.size()));
    file.close();
    if (!file) fail(path, "write", errno ? errno : EIO);
  });
}

void checkReadable(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail(path, "read", EISDIR);
  errno = 0;
  if (!std::ifstream(path, std::ios::binary)) fail(path, "read", errno ? errno : EIO);
}

std::string readFile(const std::string& path) {
  checkReadable(path);
  std::ifstream file(path, std::ios::binary);
  std::ostringstream contents;
  contents << file.rdbuf();
  if (file.bad() || contents.bad()) fail(path, "read", errno ? errno : EIO);
  return std::move(contents).str();
}

void createFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) fail(path, "create the folder", error.value());
}

}  // namespace spume::coupling
