#include "radiosity/journal/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "radiosity/journal/journal_format.h"
#include "radiosity/journal/journal_writer.h"
#include "scene/atomic_file.h"
#include "scene/errors.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

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

// AtomicFile has header and directory entry on disk before any work is, so a power loss leaves no
// torn header.
void make_file(const fs::path& file, const Provenance& of) {
  const std::string header = journal_header(of);
  AtomicFile atomic(file);
  Descriptor out(atomic.temporary(), O_CREAT | O_TRUNC | O_WRONLY);
  if (out.number() < 0) fail_to_write(file, errno);
  const int error = write_at(out.number(), 0, std::as_bytes(std::span(header)));
  if (error != 0) fail_to_write(file, error);
  atomic.commit();
}

}  // namespace

struct Journal::Impl {
  Impl(fs::path path, const Provenance& provenance, double seconds)
      : name(std::move(path)), every(seconds), file(open(name, provenance)) {
    if (file.number() < 0) fail_to_write(name, errno);
    // The file must not be open in two processes, nor replaced by another process since it was
    // opened.
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
    std::map<int, StateSlots> slots;
    std::vector<std::byte> state;
    for (std::size_t p = 0; p < contents.phases.size(); ++p) {
      const JournalContents::Phase& phase = contents.phases[p];
      numbers[{phase.name, phase.fingerprint}] = static_cast<int>(p);
      if (phase.slots.size == 0) continue;
      StateSlots& at = slots[static_cast<int>(p)];
      at.place = phase.slots;
      read_state(file.number(), at.place, state, at.number);
    }
    writer.emplace(file.number(), contents.end, std::move(slots), every);
  }

  // Opens the file read-only.
  Impl(fs::path path, const std::string& version)
      : name(std::move(path)), every(forever), file(name, O_RDONLY) {
    if (file.number() < 0) {
      throw InputError(
          fmt::format("the checkpoint '{}' cannot be read: {}", name.string(), reason(errno)));
    }
    if (::flock(file.number(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      throw InputError(fmt::format(
          "the checkpoint '{}' is in use by a solve that goes on; wait for it", name.string()));
    }
    contents = read_journal(file.number(), name);
    Provenance wanted = contents.of;
    wanted.version = version;
    check_journal_of(name, contents.of, wanted);
    for (std::size_t p = 0; p < contents.phases.size(); ++p) {
      numbers[{contents.phases[p].name, contents.phases[p].fingerprint}] = static_cast<int>(p);
    }
  }

  static Descriptor open(const fs::path& path, const Provenance& provenance) {
    std::error_code error;
    if (!fs::exists(path, error)) make_file(path, provenance);
    return {path, O_RDWR};
  }

  void close() {
    if (writer) writer->close();
    file.close();
  }

  static constexpr double forever = 1e9;  // seconds
  const fs::path name;
  const double every;
  Descriptor file;
  JournalContents contents{};  // contents at the time of opening
  std::mutex mutex{};
  std::map<std::pair<std::string, std::uint64_t>, int> numbers{};  // of phases
  std::optional<JournalWriter> writer{};                           // none for a read-only journal
  std::atomic<std::int64_t> recalled{0};
};

Journal::Journal(fs::path file, const Provenance& of, double every) {
  if (!(every > 0.0)) {
    throw std::invalid_argument(fmt::format("a journal is written every {} seconds", every));
  }
  impl_ = std::make_unique<Impl>(std::move(file), of, every);
}

Journal::Journal(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

std::unique_ptr<Journal> Journal::of_another_solve(fs::path file, const std::string& version) {
  return std::unique_ptr<Journal>(new Journal(std::make_unique<Impl>(std::move(file), version)));
}

std::unique_ptr<Journal> Journal::open(const fs::path& file, const Provenance& of, double every,
                                       bool resumes) {
  if (!resumes && fs::exists(file)) {
    if (holds_work(file)) {
      throw InputError(fmt::format(
          "the checkpoint '{}' holds finished work already; add --resume to continue from it (in "
          "Python resume=True), or remove it to start again",
          file.string()));
    }
    fs::remove(file);
  }
  return std::make_unique<Journal>(file, of, every);
}

Journal::~Journal() = default;

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

bool Journal::is_read_only() const {
  return !impl_->writer;
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

std::int64_t Journal::recalled() const {
  return impl_->recalled;
}

std::int64_t Journal::size() const {
  return impl_->writer ? impl_->writer->end() : impl_->contents.end;
}

int Journal::phase(std::string_view name, std::uint64_t fingerprint) {
  // The lock lasts until the writer has the record: no block of the phase may precede it.
  const std::lock_guard lock(impl_->mutex);
  const auto [at, is_new] =
      impl_->numbers.try_emplace({std::string(name), fingerprint}, impl_->numbers.size());
  const int number = at->second;
  if (!is_new || !impl_->writer) return number;
  std::vector<std::byte> bytes(sizeof fingerprint + name.size());
  std::memcpy(bytes.data(), &fingerprint, sizeof fingerprint);
  std::memcpy(bytes.data() + sizeof fingerprint, name.data(), name.size());
  impl_->writer->append(journal_record({.kind = RecordKind::phase,
                                        .phase = static_cast<std::uint32_t>(number),
                                        .size = bytes.size()},
                                       bytes));
  return number;
}

bool Journal::holds(int phase, int block) const {
  const auto& phases = impl_->contents.phases;
  const auto p = static_cast<std::size_t>(phase);
  return p < phases.size() && phases[p].blocks.contains(static_cast<std::uint32_t>(block));
}

bool Journal::recall(int phase, int block, std::vector<std::byte>& bytes) const {
  if (!holds(phase, block)) return false;
  const JournalContents::Phase& of = impl_->contents.phases[static_cast<std::size_t>(phase)];
  const JournalRange& place = of.blocks.at(static_cast<std::uint32_t>(block));
  bytes.resize(place.size);
  if (!read_at(impl_->file.number(), place.offset, bytes)) return false;
  impl_->recalled += static_cast<std::int64_t>(place.size);
  return true;
}

void Journal::keep(int phase, int block, std::span<const std::byte> bytes) {
  if (!impl_->writer || impl_->writer->has_failed()) return;
  impl_->writer->append(journal_record({.kind = RecordKind::block,
                                        .phase = static_cast<std::uint32_t>(phase),
                                        .block = static_cast<std::uint32_t>(block),
                                        .size = bytes.size()},
                                       bytes));
}

bool Journal::recall_state(int phase, std::vector<std::byte>& state) const {
  const auto& phases = impl_->contents.phases;
  const auto p = static_cast<std::size_t>(phase);
  if (p >= phases.size() || phases[p].slots.size == 0) return false;
  std::uint64_t number = 0;
  return read_state(impl_->file.number(), phases[p].slots, state, number);
}

void Journal::keep_state(int phase, std::span<const std::byte> state) {
  if (impl_->writer) impl_->writer->keep_state(phase, state);
}

std::string Journal::failure() const {
  if (!impl_->writer || !impl_->writer->has_failed()) return {};
  return fmt::format("the checkpoint '{}' cannot be written any more: {}", impl_->name.string(),
                     impl_->writer->failure());
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
