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

/// A file with the finished work of a solve, from which an interrupted solve resumes. A resumed
/// solve runs from the beginning and recalls finished blocks instead of computing them: the result
/// has the same bits.
///
/// Work has phases, each with a name and a fingerprint of all that affects the phase's result.
/// Phases have blocks, appended once with checksums. The file is valid up to some record at any
/// moment, and a torn record at the end does no harm. Iterations have a state, of which only the
/// latest is kept: states alternate between two slots.
///
/// A thread of the journal's own writes, and syncs to disk at intervals. After the first error of
/// the disk nothing more is kept, and failure() gives the reason; the solve goes on undisturbed.
/// All functions except construction, close() and remove() may be called from many threads.
class Journal {
 public:
  /// Resumes from `file` if it exists, otherwise makes the file. `every`: seconds after which
  /// finished work is safe on disk, > 0.
  ///
  /// Throws InputError if the file is damaged, in use by another process, or not `of` the same
  /// scene, options and version; std::runtime_error if the file cannot be written;
  /// std::invalid_argument unless `every` > 0.
  Journal(std::filesystem::path file, const Provenance& of, double every = 10.0);

  /// Opens `file`, of any scene and options, for a solve that recalls all it shares with the
  /// earlier solve. Nothing is kept in the file. Throws InputError if the file cannot be read, is
  /// damaged, of another version, or in use by a running solve.
  static std::unique_ptr<Journal> of_another_solve(std::filesystem::path file,
                                                   const std::string& version);
  /// The journal for work that begins, or that is resumed where the file has any. A file without
  /// finished work is begun anew. Throws InputError for one that holds finished work unless
  /// `resumes`, and as the constructor does.
  static std::unique_ptr<Journal> open(const std::filesystem::path& file, const Provenance& of,
                                       double every, bool resumes);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// True if an existing file holds any work. Throws InputError if the file is no journal, or
  /// damaged.
  static bool holds_work(const std::filesystem::path& file);

  const std::filesystem::path& file() const;
  const Provenance& of() const;
  /// True for the journal of another solve, in which nothing is kept.
  bool is_read_only() const;
  double every() const;
  /// Bytes of finished work at the time of opening, and bytes of a torn record behind them.
  std::int64_t found() const;
  std::int64_t torn() const;
  /// Bytes of blocks recalled so far.
  std::int64_t recalled() const;
  /// Bytes in the file at present.
  std::int64_t size() const;
  /// Most bytes of memory taken by buffers beyond those in use at present.
  static constexpr std::int64_t most_buffered = 4 << 20;  // equal to JournalWriter::most_buffered

  /// Number of a phase, begun if it is new.
  int phase(std::string_view name, std::uint64_t fingerprint);

  /// True if recall() finds the block.
  bool holds(int phase, int block) const;
  /// Reads a block that an earlier process kept. Returns false if there is none.
  bool recall(int phase, int block, std::vector<std::byte>& bytes) const;
  /// Keeps a block, at most once each unless recalled.
  void keep(int phase, int block, std::span<const std::byte> bytes);

  bool recall_state(int phase, std::vector<std::byte>& state) const;
  /// Replaces the latest state, on disk at once.
  void keep_state(int phase, std::span<const std::byte> state);

  /// Reason why nothing more is kept; empty without an error.
  std::string failure() const;

  /// Writes all remaining data, waits until the data are on disk, and closes the file. Nothing is
  /// kept or recalled afterwards.
  void close();
  /// Closes and deletes the file.
  void remove();

 private:
  struct Impl;
  explicit Journal(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightwell
