#include "apps/progress.h"

#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <numeric>

#include "apps/duration.h"

namespace spume::apps {

Progress::Progress(int frames, bool terminal) : frames_(frames), terminal_(terminal) {}

Progress::~Progress() {
  if (open_) std::cout << std::endl;
}

bool Progress::onTerminal() { return isatty(STDOUT_FILENO) == 1; }

double Progress::secondsPerFrame() const {
  return seconds_.empty() ? 0 : std::accumulate(seconds_.begin(), seconds_.end(), 0.0) / seconds_.size();
}

std::string Progress::line(int frame, const coupling::StepReport& report) const {
  char text[160];
  std::snprintf(text, sizeof text, "frame %d/%d  step %d  dt %.2f ms  %zu bubbles", frame, frames_,
                report.step, 1e3 * report.dt, report.foam.bubbles);
  std::string line = text;
  if (seconds_.empty()) return line;
  std::snprintf(text, sizeof text, "  %.2f s/frame  ", secondsPerFrame());
  return line + text + formatDuration(secondsPerFrame() * (frames_ - done_)) + " left";
}

void Progress::step(int frame, const coupling::StepReport& report) {
  if (!terminal_) return;
  std::cout << '\r' << line(frame, report) << "\x1b[K" << std::flush;  // the code erases the rest of the line
  open_ = true;
}

void Progress::frame(const coupling::FrameReport& report, double seconds) {
  done_ = report.frame;
  seconds_.push_back(seconds);
  if (seconds_.size() > kRemembered) seconds_.pop_front();
  if (report.steps.empty()) return;
  if (terminal_)
    step(report.frame, report.steps.back());
  else
    std::cout << line(report.frame, report.steps.back()) << std::endl;
}

}  // namespace spume::apps
