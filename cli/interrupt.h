#pragma once

#include <string>
#include <utility>

#include "scene/errors.h"

namespace lightwell {

/// From now on SIGINT and SIGTERM raise a flag instead of ending the program; a second one ends it.
/// Files that reach the size that is allowed fail to be written, with an error as on a full disk.
void catch_interrupts();

/// Whether one of them has arrived.
bool interrupt_requested();

/// An Interrupted with a sentence for people, that takes the place of the usual one.
class InterruptedWith : public Interrupted {
 public:
  explicit InterruptedWith(std::string sentence) : sentence_(std::move(sentence)) {}
  const char* what() const noexcept override { return sentence_.c_str(); }

 private:
  std::string sentence_;
};

/// Throws Interrupted if one has: for moments between two pieces of work.
void stop_if_interrupted();

}  // namespace lightwell
