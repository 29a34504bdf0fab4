#pragma once

#include <cmath>

namespace spume::apps {

/// Fit of y = factor x^exponent through points with x, y > 0: least squares of the logarithms.
class PowerLaw {
 public:
  void add(double x, double y) {
    const double lx = std::log(x), ly = std::log(y);
    ++count_, sumX_ += lx, sumY_ += ly, sumXX_ += lx * lx, sumXY_ += lx * ly;
  }
  /// NaN of fewer than two points.
  double exponent() const { return (count_ * sumXY_ - sumX_ * sumY_) / (count_ * sumXX_ - sumX_ * sumX_); }
  /// The factor that fits best if the exponent is known.
  double factorOf(double exponent) const { return std::exp((sumY_ - exponent * sumX_) / count_); }

 private:
  double count_ = 0, sumX_ = 0, sumY_ = 0, sumXX_ = 0, sumXY_ = 0;
};

}  // namespace spume::apps
