#include "cli/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <string_view>

#include "cli/commands.h"

namespace lightwell {
namespace {

volatile std::sig_atomic_t requested = 0;  // the type that a signal handler may write
std::atomic<bool> ends_early{false};
volatile std::sig_atomic_t ends_at_once = 0;

void request(int signal) {
  requested = signal;
  if (ends_at_once == 0) return;
  constexpr std::string_view sentence = "\ninterrupted; nothing is left half-written\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, sentence.data(), sentence.size());
  ::_exit(exit_interrupted);
}

// A write beyond the allowed file size fails with EFBIG and is reported, like a full disk.
void report_full_files() {
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = request;
  action.sa_flags = SA_RESTART | SA_RESETHAND;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
  report_full_files();
}

void ignore_interrupts() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, SIG_IGN);
  report_full_files();
}

bool interrupt_requested() {
  return requested != 0 && !early_end_requested();
}

bool early_end_requested() {
  return requested == SIGINT && ends_early;
}

InterruptEndsEarly::InterruptEndsEarly() {
  ends_early = true;
}

InterruptEndsEarly::~InterruptEndsEarly() {
  ends_early = false;
}

InterruptEndsAtOnce::InterruptEndsAtOnce() {
  ends_at_once = 1;
  stop_if_interrupted();
}

InterruptEndsAtOnce::~InterruptEndsAtOnce() {
  ends_at_once = 0;
}

void stop_if_interrupted() {
  if (interrupt_requested()) throw Interrupted();
}

}  // namespace lightwell
