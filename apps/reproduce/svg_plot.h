#pragma once

#include <string>
#include <vector>

namespace spume::apps {

/// A line of a plot; x and y have equal length. Points that are not finite (on a logarithmic axis: not
/// positive) break the line.
struct Curve {
  std::string name;  ///< in the legend
  std::vector<double> x, y;
  bool dots = false;  ///< marks every point: for few of them
};

/// One panel: axes with ticks, a legend and curves. Labels carry the units.
struct Plot {
  std::string title, xLabel, yLabel;
  std::vector<Curve> curves;
  bool logarithmic = false;  ///< of the y axis
};

/// The panels one below the other as an SVG file. Text stays text.
std::string svgOf(const std::vector<Plot>& panels);

/// Ticks at 1, 2 or 5 times a power of ten that cover [lowest, highest], about `wanted` of them. A range
/// without extent is given one.
std::vector<double> ticksOver(double lowest, double highest, int wanted);

}  // namespace spume::apps
