#pragma once

#include <stdexcept>
#include <string>

namespace spume::foam {

/// A parameter or a set-up object that cannot be simulated. `what()` names the field or object, its value,
/// the allowed range with its unit, and the remedy.
class InvalidParameter : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// A step that could not be completed. The state is as it was before the step.
class NumericalFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace spume::foam
