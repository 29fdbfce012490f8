#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstring>
#include <sstream>

#include "radiosity/journal/journal_format.h"

namespace lightwell {
namespace {

constexpr std::size_t longest_header = 1 << 16;
constexpr std::size_t checked_piece = RecordChecksum::piece;

[[noreturn]] void reject_damaged(const std::filesystem::path& path, std::int64_t offset) {
  reject_journal(path,
                 fmt::format("is damaged: what is at byte {} was safely on the disk, and is not "
                             "what was written. Use a copy of it, or remove it to start again",
                             offset));
}

// Reads the records of a file in order.
class Reader {
 public:
  Reader(int file, const std::filesystem::path& path) : file_(file), path_(path) {
    struct stat status {};
    ::fstat(file, &status);
    size_ = status.st_size;
    ::posix_fadvise(file, 0, 0, POSIX_FADV_SEQUENTIAL);
  }

  JournalContents read() {
    read_header();
    while (read_record()) {
    }
    contents_.torn = size_ - contents_.end;
    if (const auto confirmed = last_mark(contents_.end); confirmed > contents_.end) {
      reject_damaged(path_, contents_.end);
    }
    return std::move(contents_);
  }

 private:
  void read_header() {
    std::string text(std::min<std::size_t>(static_cast<std::size_t>(size_), longest_header), '\0');
    if (!read_at(file_, 0, std::as_writable_bytes(std::span(text)))) {
      reject_journal(path_, fmt::format("cannot be read: {}", std::strerror(errno)));
    }
    if (!text.starts_with(journal_first_words)) {
      reject_journal(path_,
                     text.empty()
                         ? "is an empty file; remove it, or give another name"
                         : "holds no checkpoint: the file is something else; give another name");
    }
    int format = 0;
    std::from_chars(text.data() + journal_first_words.size(), text.data() + text.size(), format);
    if (format != journal_format) {
      reject_journal(path_,
                     fmt::format("has format {}, and this program reads format {}; go on with the "
                                 "version that made it, or remove it to start again",
                                 format, journal_format));
    }
    const std::size_t last = text.find("\nchecksum: ");
    const std::string lines = text.substr(0, last == std::string::npos ? 0 : last + 1);
    const std::string seal = journal_checksum_line(lines);
    if (lines.empty() || text.compare(lines.size(), seal.size(), seal) != 0) {
      reject_journal(
          path_,
          "is damaged: its first lines are not as they were written. Use a copy of it, or "
          "remove it to start again");
    }
    std::istringstream in(lines);
    std::string hash;
    for (std::string line; std::getline(in, line);) {
      const std::size_t colon = std::min(line.find(": "), line.size());
      const std::string name = line.substr(0, colon);
      const std::string value = line.substr(std::min(colon + 2, line.size()));
      if (name == "version") contents_.of.version = value;
      if (name == "scene") contents_.of.scene_file = value;
      if (name == "options") contents_.of.options = value;
      if (name == "hash") hash = value;
    }
    std::from_chars(hash.data(), hash.data() + hash.size(), contents_.of.scene_hash, 16);
    contents_.end = static_cast<std::int64_t>(lines.size() + seal.size());
  }

  // Reads the next record. Returns false if the record is not whole.
  bool read_record() {
    RecordHead head;
    const std::int64_t at = contents_.end + static_cast<std::int64_t>(sizeof head);
    if (!read_at(file_, contents_.end, std::as_writable_bytes(std::span(&head, 1)))) return false;
    if (head.magic != RecordHead::right_magic) return false;
    if (at > size_ || head.size > static_cast<std::uint64_t>(size_ - at)) return false;
    RecordChecksum checksum(head);
    beginning_.clear();
    if (head.kind != RecordKind::slots && !add_file(checksum, at, head.size)) return false;
    if (checksum.value() != head.checksum || !note(head, at)) return false;
    contents_.end = at + static_cast<std::int64_t>(head.size);
    return true;
  }

  // Adds the bytes of a record to its checksum, and keeps the first piece in beginning_.
  bool add_file(RecordChecksum& checksum, std::int64_t at, std::uint64_t size) {
    for (std::uint64_t done = 0; done < size; done += checked_piece) {
      buffer_.resize(std::min<std::uint64_t>(checked_piece, size - done));
      if (!read_at(file_, at + static_cast<std::int64_t>(done), buffer_)) return false;
      checksum.add(buffer_);
      if (done == 0) beginning_ = buffer_;
    }
    return true;
  }

  bool note(const RecordHead& head, std::int64_t at) {
    auto& phases = contents_.phases;
    if (head.kind == RecordKind::mark) return head.size == sizeof(std::uint64_t);
    if (head.kind == RecordKind::phase) {
      std::uint64_t fingerprint = 0;
      if (head.phase != phases.size() || head.size < sizeof fingerprint ||
          head.size > checked_piece) {
        return false;
      }
      std::memcpy(&fingerprint, beginning_.data(), sizeof fingerprint);
      phases.push_back({.name{reinterpret_cast<const char*>(beginning_.data()) + sizeof fingerprint,
                              beginning_.size() - sizeof fingerprint},
                        .fingerprint = fingerprint});
      return true;
    }
    if (head.phase >= phases.size()) return false;
    JournalContents::Phase& phase = phases[head.phase];
    if (head.kind == RecordKind::slots) {
      phase.slots = {at, head.size};
      ++contents_.states;
      return true;
    }
    if (head.kind != RecordKind::block) return false;
    phase.blocks[head.block] = {at, head.size};
    ++contents_.blocks;
    return true;
  }

  // Offset up to which marks behind `begin` state that the file is on disk.
  std::int64_t last_mark(std::int64_t begin) {
    struct Mark {
      RecordHead head;
      std::uint64_t confirmed;
    };
    RecordHead wanted{.kind = RecordKind::mark, .size = sizeof(std::uint64_t)};
    constexpr std::size_t same = offsetof(RecordHead, checksum);
    std::int64_t confirmed = 0;
    for (std::int64_t from = begin; size_ - from >= static_cast<std::int64_t>(sizeof(Mark));) {
      buffer_.resize(
          std::min<std::size_t>(static_cast<std::size_t>(size_ - from), 16 * checked_piece));
      if (!read_at(file_, from, buffer_)) break;
      for (std::size_t at = 0; at + sizeof(Mark) <= buffer_.size(); ++at) {
        if (std::memcmp(buffer_.data() + at, &wanted, same) != 0) continue;
        Mark mark;
        std::memcpy(&mark, buffer_.data() + at, sizeof mark);
        RecordChecksum checksum(mark.head);
        checksum.add(std::as_bytes(std::span(&mark.confirmed, 1)));
        if (checksum.value() == mark.head.checksum) {
          confirmed = std::max(confirmed, static_cast<std::int64_t>(mark.confirmed));
        }
      }
      from += static_cast<std::int64_t>(buffer_.size() - sizeof(Mark) + 1);
    }
    return confirmed;
  }

  int file_ = -1;
  const std::filesystem::path& path_;
  std::int64_t size_ = 0;
  std::vector<std::byte> buffer_, beginning_;
  JournalContents contents_;
};

}  // namespace

bool read_at(int file, std::int64_t offset, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t got = ::pread(file, bytes.data(), bytes.size(), offset);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    offset += got;
  }
  return true;
}

bool read_state(int file, const JournalRange& slots, std::vector<std::byte>& state,
                std::uint64_t& number) {
  const std::uint64_t half = slots.size / 2;
  number = 0;
  std::vector<std::byte> bytes;
  for (std::uint64_t i = 0; i < 2; ++i) {
    const std::int64_t at = slots.offset + static_cast<std::int64_t>(i * half);
    StateHead head;
    if (!read_at(file, at, std::as_writable_bytes(std::span(&head, 1)))) continue;
    if (head.number <= number || half < sizeof head || head.size > half - sizeof head) continue;
    bytes.resize(head.size);
    if (!read_at(file, at + static_cast<std::int64_t>(sizeof head), bytes)) continue;
    if (state_checksum(head, bytes) != head.checksum) continue;
    number = head.number;
    state.swap(bytes);
  }
  return number > 0;
}

JournalContents read_journal(int file, const std::filesystem::path& path) {
  return Reader(file, path).read();
}

}  // namespace lightwell
