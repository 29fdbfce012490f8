#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "radiosity/journal/journal_format.h"

namespace lightwell {

/// Two places in a journal's file that states go to in turn.
struct StateSlots {
  JournalRange place{};
  std::uint64_t number = 0;  ///< of the latest state
};

/// Writes to a journal's file from a thread of its own, and asks the disk to confirm every so
/// often. After the first error nothing is written any more. Safe to use from many threads, but for
/// close().
class JournalWriter {
 public:
  /// Appends from `end` on, and replaces states in `slots`, by phase. `every`: seconds.
  JournalWriter(int file, std::int64_t end, std::map<int, StateSlots> slots, double every);
  ~JournalWriter() { close(); }
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;

  /// A record. Waits while `most_buffered` bytes or more have not been written yet.
  void append(std::span<const std::byte> record);
  void keep_state(int phase, std::span<const std::byte> state);

  bool has_failed() const { return has_failed_; }
  /// The system's reason.
  std::string failure() const;
  /// Of what is written.
  std::int64_t end() const { return end_; }

  /// Writes what is left and waits until the disk has confirmed it.
  void close();

  static constexpr std::size_t most_buffered = 4 << 20;

 private:
  using Clock = std::chrono::steady_clock;
  void write_on();
  bool write_some();
  Clock::duration interval() const;
  int append_to_file(std::span<const std::byte> bytes);
  int confirm_all();
  int write_state(int phase, std::span<const std::byte> state);
  int make_slots(int phase, StateSlots& slots, std::size_t state);
  void give_up(int error);

  const int file_;
  const double every_;

  mutable std::mutex mutex_;
  std::condition_variable work_, room_;
  std::vector<std::byte> buffer_;
  std::map<int, std::vector<std::byte>> states_;
  bool is_closing_ = false;
  std::atomic<bool> has_failed_ = false;
  std::string failure_;

  // The thread's own.
  std::atomic<std::int64_t> end_;
  std::map<int, StateSlots> slots_;
  bool is_unconfirmed_ = false;
  Clock::time_point next_confirmation_;
  std::thread thread_;
};

/// 0, or the error.
int write_at(int file, std::int64_t offset, std::span<const std::byte> bytes);
/// Waits until all that was written is on the disk; 0, or the error.
int confirm(int file);

}  // namespace lightwell
