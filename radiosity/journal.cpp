#include "radiosity/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <map>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "radiosity/journal_format.h"
#include "scene/atomic_file.h"
#include "scene/errors.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

// Enough that the disk is not asked for every row, little enough to be lost by a kill.
constexpr std::size_t written_at_once = 1 << 18;
constexpr std::chrono::milliseconds longest_unwritten{500};

std::string reason(int error) {
  return std::generic_category().message(error);
}

[[noreturn]] void fail_to_write(const fs::path& file, int error) {
  throw std::runtime_error(
      fmt::format("the checkpoint '{}' cannot be written: {}", file.string(), reason(error)));
}

class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags)
      : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_ = -1;
};

// 0, or the error.
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
    if (errno != EINTR) return errno == EINVAL ? 0 : errno;  // EINVAL: nothing to wait for here
  }
  return 0;
}

// Header and name are on the disk before any work is: a power loss leaves no torn beginning.
void make_file(const fs::path& file, const Provenance& of) {
  const std::string header = journal_header(of);
  AtomicFile atomic(file);
  Descriptor out(atomic.temporary(), O_CREAT | O_TRUNC | O_WRONLY);
  if (out.number() < 0) fail_to_write(file, errno);
  int error = write_at(out.number(), 0, std::as_bytes(std::span(header)));
  if (error == 0) error = confirm(out.number());
  if (error != 0) fail_to_write(file, error);
  atomic.commit();
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const Descriptor names(folder, O_RDONLY | O_DIRECTORY);
  if (names.number() >= 0) ::fsync(names.number());  // some file systems cannot
}

}  // namespace

struct Journal::Impl {
  Impl(fs::path path, const Provenance& provenance, double seconds)
      : name(std::move(path)), every(seconds), file(open(name, provenance)) {
    if (file.number() < 0) fail_to_write(name, errno);
    // Not by two at a time; nor may one have put a new file in this one's place.
    const bool is_locked = ::flock(file.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    struct stat opened {
    }, named{};
    ::fstat(file.number(), &opened);
    if (is_locked || ::stat(name.c_str(), &named) != 0 || opened.st_ino != named.st_ino) {
      throw InputError(fmt::format(
          "the checkpoint '{}' is in use by another process; give another name", name.string()));
    }
    contents = read_journal(file.number(), name);
    check_journal_of(name, contents.of, provenance);
    if (::ftruncate(file.number(), contents.end) != 0) fail_to_write(name, errno);
    end = contents.end;
    std::vector<std::byte> state;
    for (std::size_t p = 0; p < contents.phases.size(); ++p) {
      const JournalContents::Phase& phase = contents.phases[p];
      numbers[{phase.name, phase.fingerprint}] = static_cast<int>(p);
      if (phase.slots.size == 0) continue;
      Slots& at = slots[static_cast<int>(p)];
      at.place = phase.slots;
      read_state(file.number(), at.place, state, at.number);
    }
    writer = std::thread([this] { write_on(); });
  }

  static fs::path made(const fs::path& path, const Provenance& provenance) {
    std::error_code error;
    if (!fs::exists(path, error)) make_file(path, provenance);
    return path;
  }
  static Descriptor open(const fs::path& path, const Provenance& provenance) {
    return {made(path, provenance), O_RDWR};
  }

  // Once there is room for it.
  void append(std::unique_lock<std::mutex>& lock, const std::vector<std::byte>& record) {
    room.wait(lock, [this] {
      return buffer.empty() || buffer.size() < most_buffered || has_failed || is_closing;
    });
    if (has_failed || is_closing) return;
    buffer.insert(buffer.end(), record.begin(), record.end());
    if (buffer.size() >= written_at_once) work.notify_one();
  }

  // The writer's thread.
  void write_on() {
    try {
      while (write_some() && !has_failed) {
      }
    } catch (const std::bad_alloc&) {
      give_up(ENOMEM);
    }
    room.notify_all();
  }

  // What has come together, or what is left; false after that.
  bool write_some() {
    std::unique_lock lock(mutex);
    work.wait_until(lock, std::min(next_confirmation, Clock::now() + longest_unwritten), [this] {
      return is_closing || buffer.size() >= written_at_once || !states.empty();
    });
    const bool is_last = is_closing;
    std::vector<std::byte> records;
    records.swap(buffer);
    const auto new_states = std::exchange(states, {});
    lock.unlock();
    room.notify_all();
    int error = append_to_file(records);
    for (auto s = new_states.begin(); error == 0 && s != new_states.end(); ++s) {
      error = write_state(s->first, s->second);
    }
    if (error == 0 && (is_last || !new_states.empty() || Clock::now() >= next_confirmation)) {
      error = confirm_all();
      next_confirmation = Clock::now() + interval();
    }
    if (error != 0) give_up(error);
    return !is_last;
  }
  Clock::duration interval() const {
    constexpr double longest = 1e8;  // years, and no overflow
    return std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(std::min(every, longest)));
  }

  int append_to_file(std::span<const std::byte> bytes) {
    if (bytes.empty()) return 0;
    is_unconfirmed = true;
    const int error = write_at(file.number(), end, bytes);
    if (error == 0) end += static_cast<std::int64_t>(bytes.size());
    return error;
  }

  int confirm_all() {
    if (!is_unconfirmed) return 0;
    if (const int error = confirm(file.number())) return error;
    const auto upto = static_cast<std::uint64_t>(end);
    const int error = append_to_file(journal_record({.kind = RecordKind::mark, .size = sizeof upto},
                                                    std::as_bytes(std::span(&upto, 1))));
    is_unconfirmed = false;  // but for the mark, which nothing depends on
    return error;
  }

  struct Slots {
    JournalPlace place{};
    std::uint64_t number = 0;  // of the latest state
  };

  int write_state(int phase, const std::vector<std::byte>& state) {
    Slots& at = slots[phase];
    if (at.place.size < 2 * (sizeof(StateHead) + state.size())) {
      if (const int error = make_slots(phase, at, state.size())) return error;
    }
    StateHead head{.number = ++at.number, .size = state.size()};
    head.checksum = state_checksum(head, state);
    const std::int64_t place =
        at.place.offset + static_cast<std::int64_t>(head.number % 2 * (at.place.size / 2));
    is_unconfirmed = true;
    const int error =
        write_at(file.number(), place + static_cast<std::int64_t>(sizeof head), state);
    if (error != 0) return error;
    return write_at(file.number(), place, std::as_bytes(std::span(&head, 1)));
  }

  int make_slots(int phase, Slots& at, std::size_t state) {
    const std::uint64_t half = sizeof(StateHead) + state + state / 2;  // states may grow
    const RecordHead head{
        .kind = RecordKind::slots, .phase = static_cast<std::uint32_t>(phase), .size = 2 * half};
    if (const int error = append_to_file(journal_record(head, {}))) return error;
    at.place = {end, head.size};
    // Zeros that take no room yet.
    if (::ftruncate(file.number(), end + static_cast<std::int64_t>(head.size)) != 0) return errno;
    end += static_cast<std::int64_t>(head.size);
    return 0;
  }

  void give_up(int error) {
    const std::lock_guard lock(mutex);
    has_failed = true;
    failure = reason(error);
    buffer.clear();
    states.clear();
  }

  void close() {
    {
      const std::lock_guard lock(mutex);
      is_closing = true;
    }
    work.notify_one();
    if (writer.joinable()) writer.join();
    file.close();
  }

  const fs::path name;
  const double every;
  Descriptor file;
  JournalContents contents{};  // as they were at first

  mutable std::mutex mutex{};
  std::condition_variable work{}, room{};
  std::map<std::pair<std::string, std::uint64_t>, int> numbers{};
  std::vector<std::byte> buffer{};
  std::map<int, std::vector<std::byte>> states{};
  bool is_closing = false;
  std::atomic<bool> has_failed = false;
  std::string failure{};

  // The writer's.
  std::atomic<std::int64_t> end = 0;
  bool is_unconfirmed = false;
  Clock::time_point next_confirmation = Clock::now() + interval();
  std::map<int, Slots> slots{};
  std::thread writer{};
};

Journal::Journal(fs::path file, const Provenance& of, double every) {
  if (!(every > 0.0)) {
    throw std::invalid_argument(fmt::format("a journal is written every {} seconds", every));
  }
  impl_ = std::make_unique<Impl>(std::move(file), of, every);
}

Journal::~Journal() {
  impl_->close();
}

bool Journal::holds_work(const fs::path& file) {
  const Descriptor in(file, O_RDONLY);
  if (in.number() < 0) {
    throw InputError(
        fmt::format("the checkpoint '{}' cannot be read: {}", file.string(), reason(errno)));
  }
  const JournalContents contents = read_journal(in.number(), file);
  return contents.blocks + contents.states > 0;
}

const fs::path& Journal::file() const {
  return impl_->name;
}

const Provenance& Journal::of() const {
  return impl_->contents.of;
}

double Journal::every() const {
  return impl_->every;
}

std::int64_t Journal::found() const {
  const JournalContents& contents = impl_->contents;
  return contents.blocks + contents.states > 0 ? contents.end : 0;
}

std::int64_t Journal::torn() const {
  return impl_->contents.torn;
}

std::int64_t Journal::size() const {
  return impl_->end;
}

int Journal::phase(std::string_view name, std::uint64_t fingerprint) {
  std::unique_lock lock(impl_->mutex);
  const auto [at, is_new] =
      impl_->numbers.try_emplace({std::string(name), fingerprint}, impl_->numbers.size());
  const int number = at->second;
  if (!is_new) return number;
  std::vector<std::byte> bytes(sizeof fingerprint + name.size());
  std::memcpy(bytes.data(), &fingerprint, sizeof fingerprint);
  std::memcpy(bytes.data() + sizeof fingerprint, name.data(), name.size());
  impl_->append(lock, journal_record({.kind = RecordKind::phase,
                                      .phase = static_cast<std::uint32_t>(number),
                                      .size = bytes.size()},
                                     bytes));
  return number;
}

bool Journal::recall(int phase, int block, std::vector<std::byte>& bytes) const {
  const auto& phases = impl_->contents.phases;
  const auto p = static_cast<std::size_t>(phase), b = static_cast<std::size_t>(block);
  if (p >= phases.size() || b >= phases[p].blocks.size()) return false;
  const JournalPlace& place = phases[p].blocks[b];
  if (place.offset == 0) return false;
  bytes.resize(place.size);
  return read_at(impl_->file.number(), place.offset, bytes);
}

void Journal::keep(int phase, int block, std::span<const std::byte> bytes) {
  if (impl_->has_failed) return;
  const std::vector<std::byte> record = journal_record({.kind = RecordKind::block,
                                                        .phase = static_cast<std::uint32_t>(phase),
                                                        .block = static_cast<std::uint32_t>(block),
                                                        .size = bytes.size()},
                                                       bytes);
  std::unique_lock lock(impl_->mutex);
  impl_->append(lock, record);
}

bool Journal::recall_state(int phase, std::vector<std::byte>& state) const {
  const auto& phases = impl_->contents.phases;
  const auto p = static_cast<std::size_t>(phase);
  if (p >= phases.size() || phases[p].slots.size == 0) return false;
  std::uint64_t number = 0;
  return read_state(impl_->file.number(), phases[p].slots, state, number);
}

void Journal::keep_state(int phase, std::span<const std::byte> state) {
  {
    const std::lock_guard lock(impl_->mutex);
    if (impl_->has_failed || impl_->is_closing) return;
    impl_->states[phase].assign(state.begin(), state.end());
  }
  impl_->work.notify_one();
}

std::string Journal::failure() const {
  if (!impl_->has_failed) return {};
  const std::lock_guard lock(impl_->mutex);
  return fmt::format("the checkpoint '{}' cannot be written any more: {}", impl_->name.string(),
                     impl_->failure);
}

void Journal::close() {
  impl_->close();
}

void Journal::remove() {
  impl_->close();
  std::error_code error;
  if (!fs::remove(impl_->name, error) && error) {
    throw std::runtime_error(fmt::format("the checkpoint '{}' cannot be removed: {}",
                                         impl_->name.string(), error.message()));
  }
}

}  // namespace lightwell
