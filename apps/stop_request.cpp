#include "apps/stop_request.h"

#include <csignal>

namespace spume::apps {
namespace {

volatile std::sig_atomic_t signalSeen = 0;  // the one thing a signal handler may write

void remember(int signal) { signalSeen = signal; }

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
  sigaction(signal, &action, nullptr);
}

}  // namespace

const char* Stopped::what() const noexcept {
  switch (code_) {
    case kOutOfTime:
      return "stopped by --max-wall";
    case kInterrupted:
      return "interrupted";
    default:
      return "terminated";
  }
}

std::string wayOn(bool restart) {
  return restart ? "the same command without --restart goes on" : "the same command goes on";
}

StopRequest::StopRequest(std::optional<double> wallSeconds) {
  using Clock = std::chrono::steady_clock;
  if (wallSeconds)
    deadline_ = Clock::now() +
                std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(*wallSeconds));
  signalSeen = 0;
  handle(SIGINT, remember);
  handle(SIGTERM, remember);
}

StopRequest::~StopRequest() {
  handle(SIGINT, SIG_DFL);
  handle(SIGTERM, SIG_DFL);
}

void StopRequest::check() const {
  if (signalSeen == SIGINT) throw Stopped(kInterrupted);
  if (signalSeen == SIGTERM) throw Stopped(kTerminated);
  if (deadline_ && std::chrono::steady_clock::now() >= *deadline_) throw Stopped(kOutOfTime);
}

}  // namespace spume::apps
