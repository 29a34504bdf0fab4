#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>

#include "coupling/atomic_file.h"
#include "coupling/bubble_cache.h"
#include "coupling/folder_lock.h"
#include "coupling/run_folder.h"
#include "coupling/statistics.h"
#include "tests/support/temporary_path.h"

namespace spume::coupling {
namespace {

namespace fs = std::filesystem;

/// A folder of this test that goes away with the object.
class Folder {
 public:
  Folder() : path_(temporaryPath("spume_files")) { fs::create_directories(path_); }
  ~Folder() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  std::size_t files() const { return std::distance(fs::directory_iterator(path_), {}); }

 private:
  std::string path_;
};

TEST(FolderLock, LetsOneRunIn) {
  const Folder folder;
  const FolderLock lock(folder / "");
  EXPECT_EQ(lock.warning(), "");
  EXPECT_THROW(FolderLock(folder / ""), FileError);
}

TEST(FolderLock, WarnsWhereTheFileSystemKnowsNoLocks) {
  const Folder folder;
  const FolderLock::Locker noLocks = [](int, int) {
    errno = ENOLCK;
    return -1;
  };
  const FolderLock lock(folder / "run", noLocks);  // there is no such folder
  for (const char* part : {"run: cannot be locked: No such file or directory", "second run"})
    EXPECT_NE(lock.warning().find(part), std::string::npos) << lock.warning();
  fs::create_directories(folder / "run");
  const FolderLock other(folder / "run", noLocks);
  EXPECT_NE(other.warning().find("run: cannot be locked: No locks available; a second run"),
            std::string::npos)
      << other.warning();
}

TEST(AtomicFile, ReplacesWholeFiles) {
  const Folder folder;
  replaceFile(folder / "a", "old");
  replaceFile(folder / "a", "newer");
  EXPECT_EQ(readFile(folder / "a"), "newer");
  EXPECT_EQ(folder.files(), 1u);
}

TEST(AtomicFile, FailedWriteKeepsTheOldFileAndLeavesNoOther) {
  const Folder folder;
  replaceFile(folder / "a", "old");
  const auto half = [](const std::string& temporary) {
    std::ofstream(temporary) << "half";
    throw FileError("the disk is full");
  };
  EXPECT_THROW(replaceFile(folder / "a", half), FileError);
  EXPECT_EQ(readFile(folder / "a"), "old");
  EXPECT_EQ(folder.files(), 1u);
}

/// A temporary name that leads to the device that is always full.
void linkToFullDisk(const std::string& path) {
  fs::create_symlink("/dev/full", path + ".part" + std::to_string(getpid()));
}

template <typename Write>
void expectNoSpace(const std::string& path, const Write& write) {
  linkToFullDisk(path);
  try {
    write(path);
    FAIL() << "a full disk went unnoticed";
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), path + ": cannot write: No space left on device");
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(Files, FullDiskIsNamedWithPathAndReasonAndLeavesNoFile) {
  const Folder folder;
  foam::BubbleStore bubbles;
  for (int n = 0; n < 1000; ++n) bubbles.add({{0.001 * n, 0, 0}, {0, 0, 0}, 1e-3});
  expectNoSpace(folder / "a", [](const std::string& path) { replaceFile(path, "this does not fit"); });
  expectNoSpace(folder / "b.ply", [&](const std::string& path) { writeBubblesPly(path, bubbles, {}); });
  expectNoSpace(folder / "b.vdb", [&](const std::string& path) { writeBubblesVdb(path, bubbles, {}, 0.01); });
  EXPECT_EQ(folder.files(), 0u);
}

TEST(Files, UnwritablePlacesAreFileErrors) {
  EXPECT_THROW(replaceFile("/no/such/folder/a", "x"), FileError);
  EXPECT_THROW(RunFolder("/proc/spume"), FileError);
  EXPECT_THROW(createFolder("/proc/spume"), FileError);
  EXPECT_THROW(StatisticsWriter("/no/such/folder"), FileError);
  EXPECT_THROW(writeBubblesPly("/no/such/b.ply", {}, {}), FileError);
  EXPECT_THROW(writeBubblesVdb("/no/such/b.vdb", {}, {}, 0.01), FileError);
  EXPECT_THROW(readFile("/no/such/file"), FileError);
}

TEST(RunFolder, ClearsWhatRunsWriteAndNothingElse) {
  const Folder folder;
  const RunFolder run(folder / "run");
  for (const std::string& path : {run.liquid(1), run.bubblesPly(12), run.preview(3), run.runJson()})
    replaceFile(path, "x");
  replaceFile(run.root() + "/notes.txt", "mine");
  replaceFile(run.root() + "/liquid/mine.vdb", "mine");
  run.clear();
  EXPECT_FALSE(fs::exists(run.liquid(1)));
  EXPECT_FALSE(fs::exists(run.bubblesPly(12)));
  EXPECT_FALSE(fs::exists(run.preview(3)));
  EXPECT_FALSE(fs::exists(run.runJson()));
  EXPECT_TRUE(fs::exists(run.root() + "/notes.txt"));
  EXPECT_TRUE(fs::exists(run.root() + "/liquid/mine.vdb"));
}

}  // namespace
}  // namespace spume::coupling
