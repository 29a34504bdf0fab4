#include "apps/reproduce/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace spume::apps {
namespace {

// Lengths in pixels of the picture.
constexpr double kWidth = 760, kPanel = 350;
constexpr double kLeft = 78, kRight = 24, kTop = 60, kBottom = 52;
constexpr double kKey = 52, kLetter = 6.4;  // of the legend: its line and gaps; a letter, on average
constexpr int kTicks = 6;
constexpr int kMostDecades = 8;  ///< of a logarithmic axis: what lies lower is cut off

/// Told apart by eyes of every kind: the palette of Okabe and Ito.
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

std::string formatted(const char* format, double a, double b = 0, double c = 0, double d = 0) {
  char text[256];
  std::snprintf(text, sizeof text, format, a, b, c, d);
  return text;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text)
    safe += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
  return safe;
}

std::string textAt(double x, double y, const char* style, const std::string& words) {
  return formatted("<text x=\"%.1f\" y=\"%.1f\"", x, y) + " " + style + ">" + escaped(words) + "</text>\n";
}

std::string lineFrom(double x0, double y0, double x1, double y1, const std::string& stroke) {
  return formatted("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"", x0, y0, x1, y1) + " stroke=\"" +
         stroke + "\"/>\n";
}

/// A tick's words: thousands and millions as K and M.
std::string tickText(double value) {
  const double size = std::abs(value);
  if (size >= 1e6) return formatted("%.4gM", value / 1e6);
  if (size >= 1e4) return formatted("%.4gK", value / 1e3);
  return formatted("%.4g", value);
}

/// Maps values to pixels between two ends.
struct Axis {
  double lowest = 0, highest = 1, from = 0, to = 1;
  bool logarithmic = false;

  bool shows(double value) const { return std::isfinite(value) && (!logarithmic || value > 0); }
  double at(double value) const {
    const auto scaled = [this](double v) { return logarithmic ? std::log10(v) : v; };
    const double share = (scaled(value) - scaled(lowest)) / (scaled(highest) - scaled(lowest));
    return from + (to - from) * std::clamp(share, 0.0, 1.0);
  }
};

/// Powers of ten around the values.
std::vector<double> decades(double lowest, double highest) {
  const int top = static_cast<int>(std::ceil(std::log10(highest)));
  const int bottom = std::max(static_cast<int>(std::floor(std::log10(lowest))), top - kMostDecades);
  std::vector<double> ticks;
  for (int power = std::min(bottom, top - 1); power <= top; ++power) ticks.push_back(std::pow(10.0, power));
  return ticks;
}

/// The panel being drawn: its place, its axes and their ticks.
class Panel {
 public:
  Panel(const Plot& plot, double top) : plot_(plot), top_(top) {
    x_ = {0, 1, kLeft, kWidth - kRight, false};
    y_ = {0, 1, top + kPanel - kBottom, top + kTop, plot.logarithmic};
    xTicks_ = spread(x_, [](const Curve& c) -> const std::vector<double>& { return c.x; });
    yTicks_ = spread(y_, [](const Curve& c) -> const std::vector<double>& { return c.y; });
  }

  std::string svg() const {
    std::string text = frame();
    for (std::size_t c = 0; c < plot_.curves.size(); ++c) text += curve(c);
    return text + legend();
  }

 private:
  template <typename Column>
  std::vector<double> spread(Axis& axis, Column column) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Curve& c : plot_.curves)
      for (const double v : column(c))
        if (axis.shows(v)) low = std::min(low, v), high = std::max(high, v);
    if (low > high) low = axis.logarithmic ? 0.1 : 0, high = 1;
    if (!axis.logarithmic && low > 0 && low < 0.5 * high) low = 0;  // a share of nothing is seen from nothing
    const std::vector<double> ticks = axis.logarithmic ? decades(low, high) : ticksOver(low, high, kTicks);
    axis.lowest = ticks.front(), axis.highest = ticks.back();
    return ticks;
  }

  std::string frame() const {
    const char *centred = "text-anchor=\"middle\"", *ending = "text-anchor=\"end\"";
    std::string text = textAt(kLeft, top_ + 26, "font-size=\"15\" font-weight=\"bold\"", plot_.title);
    for (const double t : xTicks_) {
      text += lineFrom(x_.at(t), y_.from, x_.at(t), y_.to, "#e4e4e4");
      text += textAt(x_.at(t), y_.from + 18, centred, tickText(t));
    }
    for (const double t : yTicks_) {
      text += lineFrom(x_.from, y_.at(t), x_.to, y_.at(t), "#e4e4e4");
      text += textAt(x_.from - 8, y_.at(t) + 4, ending, tickText(t));
    }
    text += lineFrom(x_.from, y_.from, x_.to, y_.from, "#444") +
            lineFrom(x_.from, y_.from, x_.from, y_.to, "#444");
    text += textAt((x_.from + x_.to) / 2, y_.from + 40, centred, plot_.xLabel);
    const double middle = (y_.from + y_.to) / 2;
    const std::string turned = formatted("text-anchor=\"middle\" transform=\"rotate(-90 20 %.1f)\"", middle);
    return text + textAt(20, middle, turned.c_str(), plot_.yLabel);
  }

  std::string curve(std::size_t index) const {
    const Curve& c = plot_.curves[index];
    std::string path, dots;
    bool down = false;
    for (std::size_t n = 0; n < c.x.size(); ++n) {
      const bool shown = x_.shows(c.x[n]) && y_.shows(c.y[n]) && c.y[n] >= y_.lowest;
      if (shown) path += formatted(down ? "L%.1f %.1f" : "M%.1f %.1f", x_.at(c.x[n]), y_.at(c.y[n]));
      if (shown && c.dots)
        dots += formatted("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\"", x_.at(c.x[n]), y_.at(c.y[n])) +
                " fill=\"" + colour(index) + "\"/>\n";
      down = shown;
    }
    return "<path fill=\"none\" stroke-width=\"1.6\" stroke-linejoin=\"round\" stroke=\"" + colour(index) +
           "\" d=\"" + path + "\"/>\n" + dots;
  }

  /// The names of the curves in a row under the title.
  std::string legend() const {
    std::string text;
    double x = kLeft;
    for (std::size_t c = 0; c < plot_.curves.size(); ++c) {
      const std::string& name = plot_.curves[c].name;
      text += formatted("<rect x=\"%.1f\" y=\"%.1f\" width=\"22\" height=\"3\"", x, top_ + 42) + " fill=\"" +
              colour(c) + "\"/>\n" + textAt(x + 28, top_ + 47, "", name);
      x += kKey + kLetter * static_cast<double>(name.size());
    }
    return text;
  }

  static std::string colour(std::size_t index) { return kColours[index % std::size(kColours)]; }

  const Plot& plot_;
  double top_;
  Axis x_, y_;
  std::vector<double> xTicks_, yTicks_;
};

}  // namespace

std::vector<double> ticksOver(double lowest, double highest, int wanted) {
  if (!(highest > lowest)) highest = lowest + (lowest == 0 ? 1 : std::abs(lowest));
  const double rough = (highest - lowest) / wanted, power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= rough) step = factor * power;
  std::vector<double> ticks;
  // Whole multiples, so that no round-off piles up.
  const double first = std::floor(lowest / step), last = std::ceil(highest / step);
  for (double n = first; n <= last; ++n) ticks.push_back(n * step);
  return ticks;
}

std::string svgOf(const std::vector<Plot>& panels) {
  const double height = kPanel * static_cast<double>(panels.size());
  std::string text =
      formatted("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\"", kWidth, height) +
      formatted(" viewBox=\"0 0 %.0f %.0f\"", kWidth, height) +
      " font-family=\"sans-serif\" font-size=\"12\" fill=\"#222\">\n" +
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  for (std::size_t n = 0; n < panels.size(); ++n)
    text += Panel(panels[n], kPanel * static_cast<double>(n)).svg();
  return text + "</svg>\n";
}

}  // namespace spume::apps
