#pragma once

#include <string>
#include <utility>

#include "scene/errors.h"

namespace lightwell {

/// Installs signal handling for the whole process:
/// - the first SIGINT, SIGTERM or SIGHUP sets a flag, the second ends the program;
/// - SIGXFSZ is ignored, so that a file at the allowed size fails to be written with an error.
void catch_interrupts();

/// The same for the others of several processes, which the first one ends: ignores SIGINT, SIGTERM,
/// SIGHUP and SIGXFSZ.
void ignore_interrupts();

/// True once SIGTERM or SIGHUP has arrived, or SIGINT while no InterruptEndsEarly lives.
bool interrupt_requested();

/// True once SIGINT has arrived while an InterruptEndsEarly lives.
bool early_end_requested();

/// While one lives, SIGINT asks for an early end with the best result so far, which is written. One
/// lives at a time.
class InterruptEndsEarly {
 public:
  InterruptEndsEarly();
  ~InterruptEndsEarly();
  InterruptEndsEarly(const InterruptEndsEarly&) = delete;
  InterruptEndsEarly& operator=(const InterruptEndsEarly&) = delete;
};

/// While one lives, SIGINT, SIGTERM and SIGHUP end the process at once: for work of libraries that
/// nothing can stop, and that writes nothing. One lives at a time.
class InterruptEndsAtOnce {
 public:
  InterruptEndsAtOnce();
  ~InterruptEndsAtOnce();
  InterruptEndsAtOnce(const InterruptEndsAtOnce&) = delete;
  InterruptEndsAtOnce& operator=(const InterruptEndsAtOnce&) = delete;
};

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
