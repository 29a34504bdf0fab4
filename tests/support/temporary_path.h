#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace spume {

/// A path in the folder for temporary files that no other test program running at the same time uses.
inline std::string temporaryPath(const std::string& name) {
  const std::string folder = testing::TempDir() + "spume_" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  return folder + "/" + name;
}

}  // namespace spume
