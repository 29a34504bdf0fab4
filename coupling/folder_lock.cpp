#include "coupling/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "coupling/errors.h"

namespace spume::coupling {

FolderLock::FolderLock(const std::string& folder) : FolderLock(folder, ::flock) {}

FolderLock::FolderLock(const std::string& folder, Locker locker)
    : handle_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (handle_ >= 0 && locker(handle_, LOCK_EX | LOCK_NB) == 0) return;
  const int reason = errno;
  if (handle_ >= 0 && reason == EWOULDBLOCK) {
    ::close(handle_);
    throw FileError(folder + ": another run is writing here; let it end, or give this one another folder");
  }
  warning_ = folder + ": cannot be locked: " + std::generic_category().message(reason) +
             "; a second run on this folder would not be noticed and would mix its files with these: see "
             "that there is none";
}

FolderLock::~FolderLock() {
  if (handle_ >= 0) ::close(handle_);
}

}  // namespace spume::coupling
