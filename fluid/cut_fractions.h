#pragma once

#include <array>

namespace spume::fluid {

/// Fraction of a square in which the field given at its corners, in cyclic order, is positive: marching
/// squares with linear crossings; a saddle is joined if the mean of the corners is positive. Exact for a
/// linear field [-].
double squareFraction(const std::array<double, 4>& corner);

/// Fraction of a cube in which the field is positive, linear on the six tetrahedra around the diagonal from
/// corner 0 to 7; bit a of a corner's number tells its side along axis a. Exact for a linear field [-].
double cubeFraction(const std::array<double, 8>& corner);

}  // namespace spume::fluid
