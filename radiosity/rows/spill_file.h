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

/// `bytes`, rounded up to the pages of memory they take.
std::size_t whole_pages(std::size_t bytes);

/// A file for what does not fit into memory. It has no name once it is made, so nothing is left of
/// it however the process ends. Pieces are mapped for reading and stay where they are; pages of
/// those that were not touched for long leave memory. Safe to use from many threads.
class SpillFile {
 public:
  /// `most_resident`: bytes of pieces that are kept in memory at once, and one piece more. Throws
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

  /// Keeps a copy of `bytes`. Throws std::runtime_error, naming the folder and the system's reason,
  /// if the disk does not take it.
  std::unique_ptr<Piece> write(std::span<const std::byte> bytes);
  /// To be called before a piece is read; what was read before may be read on.
  void touch(Piece& piece) {
    if (!piece.is_resident_.load(std::memory_order_relaxed)) bring_in(piece);
  }
  void erase(std::unique_ptr<Piece> piece);

  /// Bytes held at once, at most.
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
