#include "fluid/pocket_unknowns.h"

#include <algorithm>
#include <cmath>

namespace spume::fluid {

void PocketUnknowns::clear(std::size_t pockets) {
  surfaces.clear();
  for (std::vector<double>* values : {&diagonal, &residual, &solution, &direction_, &image_})
    values->assign(pockets, 0);
}

void PocketUnknowns::finish() {
  for (const PocketSurface& s : surfaces) diagonal[s.pocket] += s.coefficient;
}

double PocketUnknowns::largestResidual() const {
  double largest = 0;
  for (const double r : residual) largest = std::max(largest, std::abs(r));
  return largest;
}

double PocketUnknowns::largestResidual(double diagonalLimit) const {
  double largest = 0;
  for (std::size_t p = 0; p < residual.size(); ++p)
    largest = std::max(
        largest, diagonal[p] > 0 ? std::abs(residual[p]) * std::min(1.0, diagonalLimit / diagonal[p]) : 0);
  return largest;
}

double PocketUnknowns::dot(const std::vector<float>& preconditioned) const {
  double product = 0;
  for (std::size_t p = 0; p < residual.size(); ++p) product += residual[p] * preconditioned[p];
  return product;
}

void PocketUnknowns::turn(double scale, const std::vector<float>& preconditioned, double factor) {
  for (std::size_t p = 0; p < residual.size(); ++p)
    direction_[p] = scale * preconditioned[p] + factor * direction_[p];
}

double PocketUnknowns::multiply(const DenseField<double>& direction, DenseField<double>& image) {
  double energy = 0;
  for (std::size_t p = 0; p < diagonal.size(); ++p) image_[p] = diagonal[p] * direction_[p];
  for (const PocketSurface& s : surfaces) {
    const double across = s.coefficient * direction(s.cell), back = s.coefficient * direction_[s.pocket];
    image_[s.pocket] -= across;
    image(s.cell) -= back;
    energy -= back * direction(s.cell);
  }
  for (std::size_t p = 0; p < diagonal.size(); ++p) energy += direction_[p] * image_[p];
  return energy;
}

void PocketUnknowns::advance(double step) {
  for (std::size_t p = 0; p < diagonal.size(); ++p) {
    solution[p] += step * direction_[p];
    residual[p] -= step * image_[p];
  }
}

}  // namespace spume::fluid
