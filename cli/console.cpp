#include "cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/interrupt.h"
#include "scene/utf8.h"

namespace lightwell {
namespace {

constexpr double redraw_seconds = 0.1;  // faster flickers and costs time
// An estimate of the time left is unstable below this share of a phase.
constexpr double least_share_for_guess = 0.02;
// Work that is done within this time may come from a checkpoint, so its speed is not that of the
// rest.
constexpr double recall_seconds = 0.5;

bool is_silent = false;

}  // namespace

std::string plain_lines(std::string_view text) {
  std::string lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (begin > 0) lines += '\n';
    lines += plain_text(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

void be_silent() {
  is_silent = true;
  static_cast<void>(std::freopen("/dev/null", "w", stdout));
}

void print_error(std::string_view text) {
  if (is_silent) return;
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

Console::Console(const CommonOptions& options)
    : options_(options), on_terminal_(isatty(STDERR_FILENO) != 0) {}

Console::~Console() {
  finish_phase();
}

Progress Console::progress() {
  return [this](std::string_view phase, double share) {
    if (early_end_requested() && !has_said_early_end_) {
      has_said_early_end_ = true;
      say("ending with what there is; another Ctrl-C ends at once");
    }
    show(phase, share);
    if (processes_) processes_->check();
    return !interrupt_requested();
  };
}

void Console::draw(const std::string& line) {
  // Carriage return, then the ANSI sequence that clears to the end of the line.
  print_error("\r\033[K" + line);
}

void Console::begin(std::string_view phase) {
  if (options_.quiet) return;
  finish_phase();
  phase_ = phase;
  is_without_progress_ = true;
  phase_time_ = Stopwatch();
  if (on_terminal_) draw(phase_ + " ...");
}

void Console::show(std::string_view phase, double share) {
  if (options_.quiet) return;
  if (phase != phase_) {
    finish_phase();
    phase_ = phase;
    is_without_progress_ = false;
    phase_time_ = Stopwatch();
    last_drawn_ = -redraw_seconds;
  }
  const double seconds = phase_time_.seconds();
  if (seconds < recall_seconds) {
    start_ = {.share = share, .seconds = seconds};
  }
  if (!on_terminal_ || seconds - last_drawn_ < redraw_seconds) return;
  last_drawn_ = seconds;
  std::string left;
  const double done = share - start_.share;
  if (done > least_share_for_guess && share < 1.0) {
    const double left_seconds = (seconds - start_.seconds) * (1.0 - share) / done;
    left = fmt::format(", {:.0f} s left", std::ceil(left_seconds));
  }
  const double of_limit = time_left_ ? time_left_() : 0.0;
  if (of_limit > 0.0 && std::isfinite(of_limit)) {
    left += fmt::format(" ({:.0f} s of the time left)", of_limit);
  }
  draw(fmt::format("{}: {:.0f} %{}", phase_, std::floor(100.0 * share), left));
}

void Console::finish_phase() {
  if (phase_.empty()) return;
  if (on_terminal_) print_error("\r\033[K");
  constexpr double worth_a_line = 1.0;
  const double seconds = phase_time_.seconds();
  if (!is_without_progress_ || seconds > worth_a_line) {
    print_error(fmt::format("{}: {:.1f} s\n", phase_, seconds));
  }
  phase_.clear();
}

void Console::say(std::string_view line) {
  if (options_.quiet) return;
  finish_phase();
  print_error(plain_lines(line) + "\n");
}

void Console::say_notes(const Scene& scene) {
  for (const std::string& note : scene.notes) say("note: " + note);
}

void Console::say_verbose(std::string_view line) {
  if (options_.verbose) say(line);
}

}  // namespace lightwell
