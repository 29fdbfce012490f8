#include "radiosity/journal_format.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>

#include "radiosity/fingerprint.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

constexpr std::string_view first_words = "lightwell-checkpoint ";
constexpr std::size_t longest_header = 1 << 16;
constexpr std::size_t piece = 1 << 16;  // bytes that a checksum takes at a time
constexpr std::uint32_t most_blocks = 1U << 30U;

[[noreturn]] void reject(const std::filesystem::path& path, const std::string& reason) {
  throw InputError(fmt::format("the checkpoint '{}' {}", path.string(), reason));
}

[[noreturn]] void reject_damaged(const std::filesystem::path& path, std::int64_t offset) {
  reject(path, fmt::format("is damaged: what is at byte {} was safely on the disk, and is not what "
                           "was written. Use a copy of it, or remove it to start again",
                           offset));
}

std::string checksum_line(std::string_view lines) {
  Fingerprint print;
  print.add(lines);
  return fmt::format("checksum: {:016x}\n", print.value());
}

Fingerprint begun_checksum(const RecordHead& head) {
  Fingerprint print;
  print.add(head.magic);
  print.add(head.kind);
  print.add(head.phase);
  print.add(head.block);
  print.add(head.size);
  return print;
}

void add_pieces(Fingerprint& print, std::span<const std::byte> bytes) {
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    print.add_bytes(bytes.subspan(at, std::min(piece, bytes.size() - at)));
  }
}

// "--rays 512 --discontinuity" by option.
std::map<std::string, std::string> by_option(const std::string& text) {
  std::map<std::string, std::string> options;
  std::istringstream words(text);
  std::string option;
  for (std::string word; words >> word;) {
    if (word.starts_with("--")) {
      option = word;
      options[option];
    } else {
      std::string& value = options[option];
      value += (value.empty() ? "" : " ") + word;
    }
  }
  return options;
}

std::string option_text(const std::map<std::string, std::string>& options,
                        const std::string& option) {
  const auto at = options.find(option);
  if (at == options.end()) return "no " + option;
  return at->second.empty() ? option : option + " " + at->second;
}

std::vector<std::string> differences(const std::string& then, const std::string& now) {
  const auto before = by_option(then), after = by_option(now);
  auto all = before;
  all.insert(after.begin(), after.end());
  std::vector<std::string> found;
  for (const auto& [option, value] : all) {
    const std::string a = option_text(before, option), b = option_text(after, option);
    if (a != b) found.push_back(fmt::format("{}, now it is {}", a, b));
  }
  return found;
}

// Goes through a file's records.
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
      reject(path_, fmt::format("cannot be read: {}", std::strerror(errno)));
    }
    if (!text.starts_with(first_words)) {
      reject(path_, text.empty() ? "is an empty file; remove it, or give another name"
                                 : "is none: the file is something else; give another name");
    }
    int format = 0;
    std::from_chars(text.data() + first_words.size(), text.data() + text.size(), format);
    if (format != journal_format) {
      reject(path_, fmt::format("has format {}, and this program reads format {}; go on with the "
                                "version that made it, or remove it to start again",
                                format, journal_format));
    }
    const std::size_t last = text.find("\nchecksum: ");
    const std::string lines = text.substr(0, last == std::string::npos ? 0 : last + 1);
    const std::string seal = checksum_line(lines);
    if (lines.empty() || text.compare(lines.size(), seal.size(), seal) != 0) {
      reject(path_,
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

  // The next record, if it is whole.
  bool read_record() {
    RecordHead head;
    const std::int64_t at = contents_.end + static_cast<std::int64_t>(sizeof head);
    if (!read_at(file_, contents_.end, std::as_writable_bytes(std::span(&head, 1)))) return false;
    if (head.magic != RecordHead::right_magic) return false;
    if (at > size_ || head.size > static_cast<std::uint64_t>(size_ - at)) return false;
    Fingerprint print = begun_checksum(head);
    beginning_.clear();
    if (head.kind != RecordKind::slots && !add_file(print, at, head.size)) return false;
    if (print.value() != head.checksum || !note(head, at)) return false;
    contents_.end = at + static_cast<std::int64_t>(head.size);
    return true;
  }

  // Keeps the first piece.
  bool add_file(Fingerprint& print, std::int64_t at, std::uint64_t size) {
    for (std::uint64_t done = 0; done < size; done += piece) {
      buffer_.resize(std::min<std::uint64_t>(piece, size - done));
      if (!read_at(file_, at + static_cast<std::int64_t>(done), buffer_)) return false;
      print.add_bytes(buffer_);
      if (done == 0) beginning_ = buffer_;
    }
    return true;
  }

  bool note(const RecordHead& head, std::int64_t at) {
    auto& phases = contents_.phases;
    if (head.kind == RecordKind::mark) return head.size == sizeof(std::uint64_t);
    if (head.kind == RecordKind::phase) {
      std::uint64_t fingerprint = 0;
      if (head.phase != phases.size() || head.size < sizeof fingerprint || head.size > piece) {
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
    if (head.kind != RecordKind::block || head.block >= most_blocks) return false;
    if (head.block >= phase.blocks.size()) phase.blocks.resize(head.block + 1);
    phase.blocks[head.block] = {at, head.size};
    ++contents_.blocks;
    return true;
  }

  // Up to where marks behind `begin` say that the disk has confirmed.
  std::int64_t last_mark(std::int64_t begin) {
    struct Mark {
      RecordHead head;
      std::uint64_t confirmed;
    };
    RecordHead wanted{.kind = RecordKind::mark, .size = sizeof(std::uint64_t)};
    constexpr std::size_t same = offsetof(RecordHead, checksum);
    std::int64_t confirmed = 0;
    for (std::int64_t from = begin; size_ - from >= static_cast<std::int64_t>(sizeof(Mark));) {
      buffer_.resize(std::min<std::size_t>(static_cast<std::size_t>(size_ - from), 16 * piece));
      if (!read_at(file_, from, buffer_)) break;
      for (std::size_t at = 0; at + sizeof(Mark) <= buffer_.size(); ++at) {
        if (std::memcmp(buffer_.data() + at, &wanted, same) != 0) continue;
        Mark mark;
        std::memcpy(&mark, buffer_.data() + at, sizeof mark);
        Fingerprint print = begun_checksum(mark.head);
        add_pieces(print, std::as_bytes(std::span(&mark.confirmed, 1)));
        if (print.value() == mark.head.checksum) {
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

std::vector<std::byte> journal_record(RecordHead head, std::span<const std::byte> bytes) {
  Fingerprint print = begun_checksum(head);
  if (head.kind != RecordKind::slots) add_pieces(print, bytes);
  head.checksum = print.value();
  std::vector<std::byte> record(sizeof head + bytes.size());
  std::memcpy(record.data(), &head, sizeof head);
  if (!bytes.empty()) std::memcpy(record.data() + sizeof head, bytes.data(), bytes.size());
  return record;
}

std::uint64_t state_checksum(const StateHead& head, std::span<const std::byte> bytes) {
  Fingerprint print;
  print.add(head.number);
  print.add(head.size);
  add_pieces(print, bytes);
  return print.value();
}

bool read_state(int file, const JournalPlace& slots, std::vector<std::byte>& state,
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

std::string journal_header(const Provenance& of) {
  // Names of files may hold line ends.
  const auto one_line = [](std::string text) {
    for (char& c : text) {
      if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    }
    return text;
  };
  const std::string lines = fmt::format(
      "{}{}\nversion: {}\nscene: {}\nhash: {:016x}\noptions: {}\n", first_words, journal_format,
      one_line(of.version), one_line(of.scene_file), of.scene_hash, one_line(of.options));
  return lines + checksum_line(lines);
}

JournalContents read_journal(int file, const std::filesystem::path& path) {
  return Reader(file, path).read();
}

void check_journal_of(const std::filesystem::path& path, const Provenance& found,
                      const Provenance& wanted) {
  if (found.version != wanted.version) {
    reject(path,
           fmt::format("was made by version {}, and this is version {}, which may compute other "
                       "digits; go on with that version, or remove it to start again",
                       found.version, wanted.version));
  }
  if (found.scene_hash != wanted.scene_hash) {
    reject(path,
           fmt::format("is of another scene: of '{}' (hash {:016x}), while '{}' has hash "
                       "{:016x}. Give the scene as it was, or remove it to start again",
                       found.scene_file, found.scene_hash, wanted.scene_file, wanted.scene_hash));
  }
  if (const auto differing = differences(found.options, wanted.options); !differing.empty()) {
    reject(path, fmt::format("was made with other options: with {}. Give the options as they "
                             "were, or remove it to start again",
                             fmt::join(differing, "; with ")));
  }
}

}  // namespace lightwell
