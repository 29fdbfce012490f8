#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace lightwell {

/// `bytes` rounded up to whole pages of memory.
std::size_t whole_pages(std::size_t bytes);

/// A file for rows that do not fit into memory. The file has no name once made, so the system frees
/// the disk space however the process ends. Pieces are mapped for reading at fixed addresses; pages
/// of the pieces brought in longest ago leave memory. Safe to use from many threads.
class SpillFile {
 public:
  /// `most_resident`: most bytes of pieces resident at a time, plus one piece. Throws
  /// std::runtime_error naming the folder if no file can be made there.
  SpillFile(std::filesystem::path folder, std::int64_t most_resident);
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  class Piece {
   public:
    const std::byte* data() const { return data_; }

   private:
    friend class SpillFile;
    const std::byte* data_ = nullptr;
    std::size_t size_ = 0;
    std::int64_t offset_ = 0;
    std::atomic<bool> is_resident_ = false;
  };

  /// Writes a copy of `bytes`. Throws std::runtime_error, naming the folder and the system's
  /// reason, if the disk does not take the bytes.
  std::unique_ptr<Piece> write(std::span<const std::byte> bytes);
  /// Makes a piece resident. To be called before a piece is read; pieces touched earlier remain
  /// readable.
  void touch(Piece& piece) {
    if (!piece.is_resident_.load(std::memory_order_relaxed)) bring_in(piece);
  }
  void erase(std::unique_ptr<Piece> piece);

  /// Peak of bytes in the file.
  std::int64_t most_used() const;

 private:
  void bring_in(Piece& piece);
  void put(std::span<const std::byte> bytes, std::int64_t offset) const;
  [[noreturn]] void fail(int error, std::int64_t bytes) const;

  std::filesystem::path folder_;
  std::int64_t most_resident_ = 0;
  int file_ = -1;
  mutable std::mutex mutex_;
  std::int64_t end_ = 0, used_ = 0, most_used_ = 0, resident_ = 0;
  std::map<std::size_t, std::vector<std::int64_t>> holes_;  // offsets by size
  std::deque<Piece*> recent_;                               // resident, oldest first
};

}  // namespace lightwell
