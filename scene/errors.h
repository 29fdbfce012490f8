#pragma once

#include <stdexcept>

namespace lightwell {

/// Wrong input: a file, a line, an object or a value. The message names the fault, its place and
/// the remedy.
class InputError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Input beyond a limit on size or work, or input that includes itself. Readers leave out parts
/// that cannot be used, but do not go on after this error.
class LimitError : public InputError {
  using InputError::InputError;
};

/// Thrown when the caller requests a stop (see Progress). Nothing half-written is left.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace lightwell
