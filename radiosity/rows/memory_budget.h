#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>

namespace lightwell {

class SpillFile;

/// Limits of memory, and the folder of rows beyond the limits.
struct MemoryOptions {
  /// Most resident bytes of the process. 0: three quarters of the memory of the machine or of its
  /// container.
  std::int64_t limit = 0;
  /// Most resident bytes of rows within `limit`; below 0: as many as the limit leaves room for.
  std::int64_t rows = -1;
  /// Folder of the file that holds the other rows; empty: the working folder. A folder that is
  /// itself kept in memory (often /tmp) saves nothing.
  std::filesystem::path folder{};
};

/// Storage of rows, in bytes at one time.
struct StorageReport {
  std::int64_t limit = 0;
  std::int64_t most_in_memory = 0, most_on_disk = 0;
  std::filesystem::path folder{};
};

/// Decides which rows stay in memory and which go to disk. Shared by all that store rows while form
/// factors of a scene are computed and used. Results do not depend on where rows are stored. Safe
/// to use from many threads, except for plan().
class MemoryBudget {
 public:
  explicit MemoryBudget(MemoryOptions options = {});
  ~MemoryBudget();
  MemoryBudget(const MemoryBudget&) = delete;
  MemoryBudget& operator=(const MemoryBudget&) = delete;

  /// Reserves `other` bytes beside rows. To be called before the first row is stored. Throws
  /// InputError with the required amount if a limit was given and resident memory, `other` and a
  /// slice of rows exceed the limit.
  void plan(std::int64_t other);

  /// Approximate bytes of the chunks in which rows are stored and moved.
  std::size_t chunk_bytes() const { return static_cast<std::size_t>(chunk_); }
  /// Most bytes of a block of a transposed matrix.
  std::int64_t block_bytes() const { return block_; }

  /// True if `bytes` of rows that are already resident may stay resident. Give the bytes back
  /// afterwards.
  bool take(std::int64_t bytes);
  void give_back(std::int64_t bytes);

  /// The file for rows on disk, made at the first call. Throws std::runtime_error if the file
  /// cannot be made.
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

/// Resident bytes of this process: at present, and the peak so far.
struct ResidentMemory {
  std::int64_t now = 0, most = 0;
};
ResidentMemory resident_memory();

/// Returns free pages that the C library still holds to the system.
void give_back_free_pages();

/// Bytes of memory of the machine or, if less, the limit of the process's control group.
std::int64_t usable_memory();

}  // namespace lightwell
