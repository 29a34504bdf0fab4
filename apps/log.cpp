#include "apps/log.h"

#include <cerrno>
#include <cstring>
#include <ctime>
#include <iostream>

#include "coupling/errors.h"

namespace spume::apps {

Log::Log(const std::string& path) : stream_(path, std::ios::app) {
  if (!stream_) throw coupling::FileError(path + ": cannot write the log: " + std::strerror(errno));
}

void Log::write(const std::string& message) {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y-%m-%dT%H:%M:%SZ", &utc);
  stream_ << stamp << "  " << message << std::endl;
}

void Log::say(const std::string& message) {
  write(message);
  std::cout << message << std::endl;
}

}  // namespace spume::apps
