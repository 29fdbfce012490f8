#pragma once

#include <string>
#include <utility>

#include "scene/errors.h"

namespace lightwell {

/// Installs signal handling for the whole process:
/// - the first SIGINT or SIGTERM sets a flag, the second ends the program;
/// - SIGXFSZ is ignored, so that a file at the allowed size fails to be written with an error.
void catch_interrupts();

/// True once SIGINT or SIGTERM has arrived.
bool interrupt_requested();

/// An Interrupted with a message of its own in place of the usual one.
class InterruptedWith : public Interrupted {
 public:
  explicit InterruptedWith(std::string sentence) : sentence_(std::move(sentence)) {}
  const char* what() const noexcept override { return sentence_.c_str(); }

 private:
  std::string sentence_;
};

/// Throws Interrupted if interrupt_requested(); to be called between two pieces of work.
void stop_if_interrupted();

}  // namespace lightwell
