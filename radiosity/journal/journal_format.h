#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/journal/fingerprint.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

// A journal is a few lines of text, which say whose it is, and then records, one after another.

/// Raised whenever a reader of the older format could misread the newer.
inline constexpr int journal_format = 1;

enum class RecordKind : std::uint32_t {
  phase = 1,  ///< begins phase number `phase`: its fingerprint, and its name
  block = 2,  ///< finished work: block `block` of phase `phase`
  slots = 3,  ///< room for two states of `phase`, which are replaced in turn
  mark = 4    ///< the disk has confirmed all that lies before this offset
};

/// What is before the bytes of every record, in the machine's byte order.
struct RecordHead {
  std::uint32_t magic = right_magic;
  RecordKind kind = RecordKind::block;
  std::uint32_t phase = 0, block = 0;
  std::uint64_t size = 0;      ///< bytes that follow
  std::uint64_t checksum = 0;  ///< of what is above and of these, but for slots of the former alone

  static constexpr std::uint32_t right_magic = 0x4a574c1f;
};

/// What is before a state in each half of a record of slots.
struct StateHead {
  std::uint64_t number = 0;  ///< the higher one is the later one; 0: none
  std::uint64_t size = 0, checksum = 0;
};

/// The checksum of a record: of its head, then of its bytes.
class RecordChecksum {
 public:
  explicit RecordChecksum(const RecordHead& head);
  /// What comes next: pieces of `piece` bytes, but for the last.
  void add(std::span<const std::byte> bytes) { print_.add_bytes(bytes); }
  void add_in_pieces(std::span<const std::byte> bytes);
  std::uint64_t value() const { return print_.value(); }

  static constexpr std::size_t piece = 1 << 16;

 private:
  Fingerprint print_;
};

/// A whole record of the bytes; of slots, which have none yet, the head.
std::vector<std::byte> journal_record(RecordHead head, std::span<const std::byte> bytes);
std::uint64_t state_checksum(const StateHead& head, std::span<const std::byte> bytes);

struct JournalRange {
  std::int64_t offset = 0;  ///< of the bytes; 0: not there
  std::uint64_t size = 0;
};

/// What a journal file holds.
struct JournalContents {
  struct Phase {
    std::string name{};
    std::uint64_t fingerprint = 0;
    std::vector<JournalRange> blocks{};
    JournalRange slots{};  ///< both
  };
  Provenance of{};
  std::vector<Phase> phases{};
  std::int64_t blocks = 0, states = 0;
  std::int64_t end = 0;   ///< of the last whole record
  std::int64_t torn = 0;  ///< bytes behind it, of records that a sudden end left unfinished
};

/// The lines a journal begins with, of which the last is the checksum of the others.
std::string journal_header(const Provenance& of);
std::string journal_checksum_line(std::string_view lines);
inline constexpr std::string_view journal_first_words = "lightwell-checkpoint ";

/// Throws the InputError that says "the checkpoint 'path' " and the reason.
[[noreturn]] void reject_journal(const std::filesystem::path& path, const std::string& reason);

/// Reads all of an open file once, in small pieces. What lies behind the last whole record is torn,
/// unless the disk had confirmed it. Throws InputError naming `path`, with the reason: no journal,
/// another format, damaged.
JournalContents read_journal(int file, const std::filesystem::path& path);

/// Throws InputError, saying which option or what else differs, unless a journal of `found` serves
/// `wanted`. Where the scene's file lies does not matter.
void check_journal_of(const std::filesystem::path& path, const Provenance& found,
                      const Provenance& wanted);

/// The latest whole state in a record of slots; false if there is none. `number` is its
/// StateHead's.
bool read_state(int file, const JournalRange& slots, std::vector<std::byte>& state,
                std::uint64_t& number);

/// All of `bytes` from `offset` on; false if the file ends before, or cannot be read.
bool read_at(int file, std::int64_t offset, std::span<std::byte> bytes);

}  // namespace lightwell
