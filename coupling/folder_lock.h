#pragma once

#include <string>

namespace spume::coupling {

/// Keeps other runs out of a folder for as long as it lives; however the program ends, the system lets go of
/// it. Where a file system knows no locks nothing is kept out.
class FolderLock {
 public:
  /// Throws FileError where another run holds the folder.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int handle_;
};

}  // namespace spume::coupling
