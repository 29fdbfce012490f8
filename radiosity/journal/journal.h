#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/solution/solution.h"

namespace lightwell {

/// A file that collects the finished work of a solve, so that it can be gone on with after it was
/// ended, in whatever way. Whoever goes on runs the same program again from the beginning and,
/// block by block, takes what is here instead of computing it: the result has the same bits.
///
/// Work has phases, told apart by a name and a fingerprint of all that decides their result, and
/// phases have blocks, which are written once, behind each other, with checksums. So the file is
/// good up to some record at any moment, and a torn one at its end does no harm. Iterations rather
/// have a state, of which only the latest is kept: in one of two places in turn.
///
/// A thread of its own writes, and asks the disk to confirm every so often. Once the disk does not
/// take something, nothing more is kept, and failure() says why; the work is not disturbed. But for
/// construction, close() and remove() everything may be called from many threads.
class Journal {
 public:
  /// Goes on with `file` if there is one, else makes it. `every`: seconds after which finished work
  /// is safe on the disk, > 0. Throws InputError if it is damaged, or not `of` the same scene,
  /// options and version, or in use by another process; std::runtime_error if it cannot be written.
  Journal(std::filesystem::path file, const Provenance& of, double every = 10.0);

  /// What there is in `file`, of whatever scene and options, for a solve that may take from it all
  /// that it shares with the one before: nothing more is kept. Throws InputError if it cannot be
  /// read, is damaged, of another version, or in use by a solve that goes on.
  static std::unique_ptr<Journal> of_another_solve(std::filesystem::path file,
                                                   const std::string& version);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Whether an existing file holds any work. Throws InputError if it is no journal, or damaged.
  static bool holds_work(const std::filesystem::path& file);

  const std::filesystem::path& file() const;
  const Provenance& of() const;
  /// Whether nothing is kept: it is another solve's.
  bool is_read_only() const;
  double every() const;
  /// Bytes of finished work that were there at first, and behind them, of a torn record.
  std::int64_t found() const;
  std::int64_t torn() const;
  /// Bytes of blocks that have been recalled up to now.
  std::int64_t recalled() const;
  /// Bytes in the file now.
  std::int64_t size() const;
  /// Bytes of memory that are taken up at most, beside what is taken already.
  static constexpr std::int64_t most_buffered = 4 << 20;  // as JournalWriter's

  /// The number of a phase, which is begun if it is new.
  int phase(std::string_view name, std::uint64_t fingerprint);

  /// What was kept before this process began. False if nothing was.
  bool recall(int phase, int block, std::vector<std::byte>& bytes) const;
  /// Each block of a phase at most once, unless it is recalled.
  void keep(int phase, int block, std::span<const std::byte> bytes);

  bool recall_state(int phase, std::vector<std::byte>& state) const;
  /// Replaces the state that was kept before. Goes to the disk at once.
  void keep_state(int phase, std::span<const std::byte> state);

  /// Why nothing is kept any more; empty while all is well.
  std::string failure() const;

  /// Writes what is left, waits until it is safe, and lets go of the file: nothing is kept or
  /// recalled afterwards.
  void close();
  /// Closes and deletes the file.
  void remove();

 private:
  struct Impl;
  explicit Journal(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightwell
