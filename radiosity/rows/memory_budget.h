#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>

namespace lightwell {

class SpillFile;

struct MemoryOptions {
  /// Bytes that the process may have resident. 0: three quarters of what the machine or, in a
  /// container, the container has.
  std::int64_t limit = 0;
  /// Of these, bytes of rows at most; below 0: as many as the limit leaves room for.
  std::int64_t rows = -1;
  /// Where the file goes that holds the rest of the rows; empty: the working folder. A folder that
  /// is itself kept in memory (often /tmp) saves nothing.
  std::filesystem::path folder{};
};

/// Where rows were kept, in bytes at once.
struct StorageReport {
  std::int64_t limit = 0;
  std::int64_t most_in_memory = 0, most_on_disk = 0;
  std::filesystem::path folder{};
};

/// Decides what rows are kept in memory and what goes to disk. Shared by all that store rows while
/// a scene's form factors are computed and used. What is where changes no result. Safe to use from
/// many threads, but for plan().
class MemoryBudget {
 public:
  explicit MemoryBudget(MemoryOptions options = {});
  ~MemoryBudget();
  MemoryBudget(const MemoryBudget&) = delete;
  MemoryBudget& operator=(const MemoryBudget&) = delete;

  /// Says that `other` bytes beside rows are still to come, before the first row does. Throws
  /// InputError, with the amount that is needed, if a limit was given and what is resident already,
  /// `other` and a slice of rows do not fit into it.
  void plan(std::int64_t other);

  /// Rows are kept and moved in pieces of about this size.
  std::size_t chunk_bytes() const { return static_cast<std::size_t>(chunk_); }
  /// What a block of a transposed matrix may take (see ColumnBlock).
  std::int64_t block_bytes() const { return block_; }

  /// Whether `bytes` of rows, resident already, may stay so. Give them back afterwards.
  bool take(std::int64_t bytes);
  void give_back(std::int64_t bytes);

  /// Made when it is first asked for; throws std::runtime_error if that fails.
  SpillFile& spill_file();

  StorageReport report() const;

 private:
  void share_out(std::int64_t resident, std::int64_t other);

  MemoryOptions options_;
  std::int64_t limit_ = 0, headroom_ = 0;
  std::int64_t chunk_ = 0, block_ = 0, window_ = 0;

  mutable std::mutex mutex_;
  std::int64_t in_memory_ = 0, most_in_memory_ = 0;
  std::unique_ptr<SpillFile> spill_file_;
};

/// Bytes of this process that are in memory now, and at most up to now.
struct ResidentMemory {
  std::int64_t now = 0, most = 0;
};
ResidentMemory resident_memory();

/// Gives back pages in which nothing is kept any more, if the C library has them still.
void give_back_free_pages();

/// Bytes of memory that the machine has or that the process's control group may use.
std::int64_t usable_memory();

}  // namespace lightwell
