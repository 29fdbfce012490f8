#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/journal/fingerprint.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

// A journal is a header of a few lines of text with the solve's provenance, followed by records.

/// Version of the format. Raised whenever a reader of an older version could misread a newer file.
inline constexpr int journal_format = 1;

enum class RecordKind : std::uint32_t {
  phase = 1,  ///< begins phase number `phase`; bytes: fingerprint and name
  block = 2,  ///< finished work: block `block` of phase `phase`
  slots = 3,  ///< slots for two states of `phase`, replaced alternately
  mark = 4    ///< all bytes before this offset are synced to disk
};

/// Head before the bytes of every record, in the machine's byte order.
struct RecordHead {
  std::uint32_t magic = right_magic;
  RecordKind kind = RecordKind::block;
  std::uint32_t phase = 0, block = 0;
  std::uint64_t size = 0;  ///< bytes after the head
  /// Checksum of the fields above and the bytes; for slots, of the fields alone.
  std::uint64_t checksum = 0;

  static constexpr std::uint32_t right_magic = 0x4a574c1f;
};

/// Head before a state in each half of a record of slots.
struct StateHead {
  std::uint64_t number = 0;  ///< the higher number is the later state; 0: none
  std::uint64_t size = 0, checksum = 0;
};

/// Checksum of a record: of its head, then of its bytes.
class RecordChecksum {
 public:
  explicit RecordChecksum(const RecordHead& head);
  /// Adds the next bytes: pieces of `piece` bytes except for the last.
  void add(std::span<const std::byte> bytes) { print_.add_bytes(bytes); }
  void add_in_pieces(std::span<const std::byte> bytes);
  std::uint64_t value() const { return print_.value(); }

  static constexpr std::size_t piece = 1 << 16;

 private:
  Fingerprint print_;
};

/// A record of `bytes`; for slots, which have no bytes yet, the head alone.
std::vector<std::byte> journal_record(RecordHead head, std::span<const std::byte> bytes);
std::uint64_t state_checksum(const StateHead& head, std::span<const std::byte> bytes);

struct JournalRange {
  std::int64_t offset = 0;  ///< offset of the bytes; 0: absent
  std::uint64_t size = 0;
};

/// Contents of a journal file.
struct JournalContents {
  struct Phase {
    std::string name{};
    std::uint64_t fingerprint = 0;
    /// Blocks by number, in a map: a damaged number takes no memory for the numbers below.
    std::map<std::uint32_t, JournalRange> blocks{};
    JournalRange slots{};  ///< both slots
  };
  Provenance of{};
  std::vector<Phase> phases{};
  std::int64_t blocks = 0, states = 0;
  std::int64_t end = 0;   ///< end of the last whole record
  std::int64_t torn = 0;  ///< bytes of unfinished records behind `end`
};

/// Header of a journal. The last line is the checksum of the others.
std::string journal_header(const Provenance& of);
std::string journal_checksum_line(std::string_view lines);
inline constexpr std::string_view journal_first_words = "lightwell-checkpoint ";

/// Throws InputError "the checkpoint 'path' " followed by the reason.
[[noreturn]] void reject_journal(const std::filesystem::path& path, const std::string& reason);

/// Reads an open file once, in small pieces. Bytes behind the last whole record are torn, unless
/// they were synced to disk. Throws InputError naming `path`, with the reason: no journal, another
/// format, or damaged.
JournalContents read_journal(int file, const std::filesystem::path& path);

/// Throws InputError naming the options or other differences unless a journal of `found` serves
/// `wanted`. The path of the scene's file does not matter.
void check_journal_of(const std::filesystem::path& path, const Provenance& found,
                      const Provenance& wanted);

/// Reads the latest whole state in a record of slots; `number` is the number in its StateHead.
/// Returns false if there is no whole state.
bool read_state(int file, const JournalRange& slots, std::vector<std::byte>& state,
                std::uint64_t& number);

/// Reads `bytes` from `offset` on. Returns false if the file ends before, or cannot be read.
bool read_at(int file, std::int64_t offset, std::span<std::byte> bytes);

}  // namespace lightwell
