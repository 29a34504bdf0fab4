#pragma once

#include <string>

namespace spume::coupling {

/// Keeps other runs out of a folder for as long as it lives; however the program ends, the system lets go of
/// it. Where a file system knows no locks nothing is kept out, and a warning says so.
class FolderLock {
 public:
  /// The system's flock(), or what stands for it.
  using Locker = int (*)(int handle, int operation);

  /// Throws FileError where another run holds the folder.
  explicit FolderLock(const std::string& folder);
  FolderLock(const std::string& folder, Locker locker);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// The folder, the system's reason and what a user must see to, where the folder could not be locked; else
  /// empty.
  const std::string& warning() const { return warning_; }

 private:
  int handle_;
  std::string warning_;
};

}  // namespace spume::coupling
