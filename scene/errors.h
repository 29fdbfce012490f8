#pragma once

#include <stdexcept>

namespace lightwell {

/// The input is wrong (a file, a line, an object, a value). The message says what, where and what
/// to do.
class InputError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The caller's stop request was honoured (see Progress); nothing half-written is left.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace lightwell
