#include "radiosity/journal/journal_writer.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <system_error>
#include <utility>

namespace lightwell {
namespace {

// Large enough to avoid a write per row, small enough that a kill loses little.
constexpr std::size_t written_at_once = 1 << 18;
constexpr std::chrono::milliseconds longest_unwritten{500};

}  // namespace

int write_at(int file, std::int64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(file, bytes.data(), bytes.size(), offset);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += written;
  }
  return 0;
}

int confirm(int file) {
  while (::fdatasync(file) != 0) {
    // EINVAL: the file does not support syncing.
    if (errno != EINTR) return errno == EINVAL ? 0 : errno;
  }
  return 0;
}

JournalWriter::JournalWriter(int file, std::int64_t end, std::map<int, StateSlots> slots,
                             double every)
    : file_(file),
      every_(every),
      end_(end),
      slots_(std::move(slots)),
      next_confirmation_(Clock::now() + interval()),
      thread_([this] { write_on(); }) {}

void JournalWriter::append(std::span<const std::byte> record) {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [this] { return buffer_.size() < most_buffered || has_failed_ || is_closing_; });
  if (has_failed_ || is_closing_) return;
  buffer_.insert(buffer_.end(), record.begin(), record.end());
  if (buffer_.size() >= written_at_once) work_.notify_one();
}

void JournalWriter::keep_state(int phase, std::span<const std::byte> state) {
  {
    const std::lock_guard lock(mutex_);
    if (has_failed_ || is_closing_) return;
    states_[phase].assign(state.begin(), state.end());
  }
  work_.notify_one();
}

std::string JournalWriter::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void JournalWriter::close() {
  {
    const std::lock_guard lock(mutex_);
    is_closing_ = true;
  }
  work_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void JournalWriter::write_on() {
  try {
    while (write_some() && !has_failed_) {
    }
  } catch (const std::bad_alloc&) {
    give_up(ENOMEM);
  }
  room_.notify_all();
}

// Writes all buffered records and states. Returns false after the last ones.
bool JournalWriter::write_some() {
  std::unique_lock lock(mutex_);
  work_.wait_until(lock, std::min(next_confirmation_, Clock::now() + longest_unwritten), [this] {
    return is_closing_ || buffer_.size() >= written_at_once || !states_.empty();
  });
  const bool is_last = is_closing_;
  std::vector<std::byte> records;
  records.swap(buffer_);
  const auto new_states = std::exchange(states_, {});
  lock.unlock();
  room_.notify_all();
  int error = append_to_file(records);
  for (auto s = new_states.begin(); error == 0 && s != new_states.end(); ++s) {
    error = write_state(s->first, s->second);
  }
  if (error == 0 && (is_last || !new_states.empty() || Clock::now() >= next_confirmation_)) {
    error = confirm_all();
    next_confirmation_ = Clock::now() + interval();
  }
  if (error != 0) give_up(error);
  return !is_last;
}

JournalWriter::Clock::duration JournalWriter::interval() const {
  constexpr double longest = 1e8;  // years, without overflow
  return std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(std::min(every_, longest)));
}

int JournalWriter::append_to_file(std::span<const std::byte> bytes) {
  if (bytes.empty()) return 0;
  is_unconfirmed_ = true;
  const int error = write_at(file_, end_, bytes);
  if (error == 0) end_ += static_cast<std::int64_t>(bytes.size());
  return error;
}

int JournalWriter::confirm_all() {
  if (!is_unconfirmed_) return 0;
  if (const int error = confirm(file_)) return error;
  const auto upto = static_cast<std::uint64_t>(end_);
  const int error = append_to_file(journal_record({.kind = RecordKind::mark, .size = sizeof upto},
                                                  std::as_bytes(std::span(&upto, 1))));
  is_unconfirmed_ = false;  // except for the mark, on which nothing depends
  return error;
}

int JournalWriter::write_state(int phase, std::span<const std::byte> state) {
  StateSlots& at = slots_[phase];
  if (at.place.size < 2 * (sizeof(StateHead) + state.size())) {
    if (const int error = make_slots(phase, at, state.size())) return error;
  }
  StateHead head{.number = ++at.number, .size = state.size()};
  head.checksum = state_checksum(head, state);
  const std::int64_t place =
      at.place.offset + static_cast<std::int64_t>(head.number % 2 * (at.place.size / 2));
  is_unconfirmed_ = true;
  const int error = write_at(file_, place + static_cast<std::int64_t>(sizeof head), state);
  if (error != 0) return error;
  return write_at(file_, place, std::as_bytes(std::span(&head, 1)));
}

int JournalWriter::make_slots(int phase, StateSlots& at, std::size_t state) {
  const std::uint64_t half = sizeof(StateHead) + state + state / 2;  // room for growth
  const RecordHead head{
      .kind = RecordKind::slots, .phase = static_cast<std::uint32_t>(phase), .size = 2 * half};
  if (const int error = append_to_file(journal_record(head, {}))) return error;
  at.place = {end_, head.size};
  // Zeros that take no disk space yet.
  if (::ftruncate(file_, end_ + static_cast<std::int64_t>(head.size)) != 0) return errno;
  end_ += static_cast<std::int64_t>(head.size);
  return 0;
}

void JournalWriter::give_up(int error) {
  const std::lock_guard lock(mutex_);
  has_failed_ = true;
  failure_ = std::generic_category().message(error);
  buffer_.clear();
  states_.clear();
}

}  // namespace lightwell
