#pragma once

#include <chrono>
#include <exception>
#include <optional>
#include <string>

#include "apps/exit_code.h"

namespace spume::apps {

/// Thrown out of a run between two steps when it has to stop.
class Stopped : public std::exception {
 public:
  explicit Stopped(ExitCode code) : code_(code) {}
  ExitCode code() const { return code_; }
  const char* what() const noexcept override;

 private:
  ExitCode code_;
};

/// How a person goes on with what was stopped: "the same command goes on", `restart` without that flag.
std::string wayOn(bool restart);

/// Notices SIGINT, SIGTERM and the end of the allowed wall time. The first signal asks for a clean stop, a
/// second one ends the program at once. One object at a time; the destructor restores the signals' earlier
/// handling.
class StopRequest {
 public:
  explicit StopRequest(std::optional<double> wallSeconds);
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// Throws Stopped if the run has to stop.
  void check() const;

 private:
  std::optional<std::chrono::steady_clock::time_point> deadline_;
};

}  // namespace spume::apps
