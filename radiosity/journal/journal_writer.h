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

/// Two slots in a journal's file for alternating states.
struct StateSlots {
  JournalRange place{};
  std::uint64_t number = 0;  ///< number of the latest state
};

/// Writes to a journal's file from a thread of its own, and syncs to disk at intervals. Nothing is
/// written after the first error. Safe to use from many threads, except for close().
class JournalWriter {
 public:
  /// Appends from offset `end` on, and replaces states in `slots`, by phase. `every`: seconds
  /// between syncs.
  JournalWriter(int file, std::int64_t end, std::map<int, StateSlots> slots, double every);
  ~JournalWriter() { close(); }
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;

  /// Appends a record. Blocks while `most_buffered` bytes or more are unwritten.
  void append(std::span<const std::byte> record);
  void keep_state(int phase, std::span<const std::byte> state);

  bool has_failed() const { return has_failed_; }
  /// The system's reason for the first error.
  std::string failure() const;
  /// End of the written records, bytes.
  std::int64_t end() const { return end_; }

  /// Writes all remaining data and waits until the data are on disk.
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

  // Used by the writing thread alone.
  std::atomic<std::int64_t> end_;
  std::map<int, StateSlots> slots_;
  bool is_unconfirmed_ = false;
  Clock::time_point next_confirmation_;
  std::thread thread_;
};

/// Writes `bytes` at `offset`. Returns 0 or the error number.
int write_at(int file, std::int64_t offset, std::span<const std::byte> bytes);
/// Waits until all written data are on disk. Returns 0 or the error number.
int confirm(int file);

}  // namespace lightwell
