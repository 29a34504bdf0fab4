#pragma once

#include <fstream>
#include <string>

namespace spume::apps {

/// log.txt of a run: one line a message, with the time of day in UTC. Appends to the log of a resumed run.
class Log {
 public:
  /// Throws coupling::FileError.
  explicit Log(const std::string& path);
  /// Writes to the file at once; a full disk is noticed by the caches, not here.
  void write(const std::string& message);
  /// The same, and prints the message.
  void say(const std::string& message);

 private:
  std::ofstream stream_;
};

}  // namespace spume::apps
