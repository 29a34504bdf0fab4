#pragma once

#include <deque>
#include <string>

#include "coupling/simulation.h"

namespace spume::apps {

/// How far a run is: one line redrawn after every step on a terminal, one line a frame elsewhere.
class Progress {
 public:
  /// `frames` = the run's last frame.
  Progress(int frames, bool terminal);
  /// Ends the redrawn line.
  ~Progress();

  void step(int frame, const coupling::StepReport& report);
  /// `seconds` = wall time of the frame with its output [s].
  void frame(const coupling::FrameReport& report, double seconds);

  /// True if standard output is a terminal.
  static bool onTerminal();

 private:
  std::string line(int frame, const coupling::StepReport& report) const;
  double secondsPerFrame() const;

  static constexpr std::size_t kRemembered = 10;  ///< frames the time left is estimated from
  int frames_, done_ = 0;
  bool terminal_, open_ = false;
  std::deque<double> seconds_;
};

}  // namespace spume::apps
