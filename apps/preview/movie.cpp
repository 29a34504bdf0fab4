#include "apps/preview/movie.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <vector>

#include "coupling/atomic_file.h"

namespace spume::apps {
namespace {

constexpr int kNotFound = 127;  // the shell's code for a program that is not there

/// Runs a program in silence and returns its exit code.
int runQuietly(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0) return kNotFound;
  if (child == 0) {
    const int nowhere = open("/dev/null", O_RDWR);
    for (int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, stream);
    execvp(arguments[0], arguments.data());
    _exit(kNotFound);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

}  // namespace

std::string writeMovie(const std::string& pictures, double fps, const std::string& path) {
  try {
    coupling::replaceFile(path, [&](const std::string& temporary) {
      const int code = runQuietly({"ffmpeg",
                                   "-y",
                                   "-framerate",
                                   std::to_string(fps),
                                   "-pattern_type",
                                   "glob",
                                   "-i",
                                   pictures + ".*.png",
                                   "-vf",
                                   "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                                   "-c:v",
                                   "libx264",
                                   "-crf",
                                   "18",
                                   "-pix_fmt",
                                   "yuv420p",
                                   "-movflags",
                                   "+faststart",
                                   "-f",
                                   "mp4",
                                   temporary});
      if (code == kNotFound) throw coupling::FileError("ffmpeg is not installed");
      if (code != 0) throw coupling::FileError("ffmpeg ended with code " + std::to_string(code));
    });
  } catch (const coupling::FileError& error) {
    return std::string("no movie: ") + error.what();
  }
  return {};
}

}  // namespace spume::apps
