#include "cli/interrupt.h"

#include <csignal>

namespace lightwell {
namespace {

volatile std::sig_atomic_t requested = 0;  // the type that a signal handler may write

void request(int) {
  requested = 1;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = request;
  action.sa_flags = SA_RESTART | SA_RESETHAND;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A write beyond the allowed file size fails with EFBIG and is reported, like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupt_requested() {
  return requested != 0;
}

void stop_if_interrupted() {
  if (interrupt_requested()) throw Interrupted();
}

}  // namespace lightwell
