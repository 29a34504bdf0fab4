#include "apps/trade/trade_text.h"

#include <cmath>
#include <cstdio>

namespace spume::apps {
namespace {

/// What is smaller is no reference for a percentage.
constexpr double kNothing = 1e-12;

}  // namespace

std::string number(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

bool isShare(const TradeFigure& figure) { return figure.share > 0; }

std::string differenceText(std::size_t figure, double difference, double of) {
  if (!isShare(kTradeFigures[figure])) return number("%+.2f", difference);
  if (std::abs(of) < kNothing) return number("%+.3g", difference);
  return number("%+.1f %%", 100 * difference / of);
}

std::string lengthOf(const Trade& trade) {
  std::string text = std::to_string(trade.scene.time.frames) + " frames";
  if (trade.scene.solvesLiquid()) text += ", " + std::to_string(trade.scene.domain.resolution) + " cells";
  return text;
}

}  // namespace spume::apps
