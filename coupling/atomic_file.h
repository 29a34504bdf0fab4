#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "coupling/errors.h"

namespace spume::coupling {

/// Writes `path` so that a reader sees the old file or the whole new one, never a part: `write` fills a
/// temporary file beside it, which is flushed to the disk and renamed. Whatever fails, the temporary file is
/// removed. Throws FileError with path and reason; exceptions of `write` pass through.
void replaceFile(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// The same for contents held in memory.
void replaceFile(const std::string& path, std::string_view contents);

/// Throws FileError unless `path` is a file that can be opened for reading.
void checkReadable(const std::string& path);

/// The whole file. Throws FileError.
std::string readFile(const std::string& path);

/// Creates a folder and its parents. Throws FileError.
void createFolder(const std::string& path);

}  // namespace spume::coupling
