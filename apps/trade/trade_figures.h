#pragma once

#include <array>
#include <string>

#include "apps/reproduce/scene_run.h"

namespace spume::apps {

/// What a scene is judged by: a figure of its run.
struct TradeFigure {
  const char *name, *unit;
  double share;   ///< smallest difference anybody would see, of the figure itself [-]
  double amount;  ///< the same in the figure's unit; the larger of both counts
  bool isError;   ///< of the method: best at 0, and no figure of the scene
};

/// Figures of the last third of a run are means over its frames, or over the cached ones.
inline constexpr std::array<TradeFigure, 9> kTradeFigures{{
    {"bubbles alive", "", 0.01, 0, false},
    {"births", "", 0.01, 0, false},
    {"contacts", "", 0.01, 0, false},
    {"mean height of the gas", "mm", 0.01, 0, false},
    {"height 95 % of the gas lies below", "mm", 0.01, 0, false},
    {"floating bubbles in contact", "%", 0, 1, false},
    {"gas in bubbles", "ml", 0.01, 0, false},
    {"liquid off, worst frame", "%", 0, 0.1, true},
    {"cell volume off, worst late frame", "%", 0, 0.1, true},
}};

/// Places of the two errors.
inline constexpr std::size_t kLiquidOff = 7, kCellsOff = 8;
static_assert(kTradeFigures[kLiquidOff].isError && kTradeFigures[kCellsOff].isError);

/// What a run cost.
struct TradeCost {
  double seconds = 0, liquidSeconds = 0, foamSeconds = 0;  ///< a frame, mean over all [s]
  double pressureIterations = 0, foamIterations = 0;       ///< the same [-]
};

struct TradeFigures {
  std::array<double, kTradeFigures.size()> values{};  ///< in the units of kTradeFigures
  TradeCost cost;
};

/// Reads what a finished run left. Throws coupling::SceneError where it cached none of its last frames.
TradeFigures tradeFiguresOf(const SceneRun& run);

}  // namespace spume::apps
