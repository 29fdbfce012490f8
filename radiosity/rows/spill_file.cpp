#include "radiosity/rows/spill_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

namespace lightwell {
std::size_t whole_pages(std::size_t bytes) {
  static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  return (bytes + page - 1) / page * page;
}

SpillFile::SpillFile(std::filesystem::path folder, std::int64_t most_resident)
    : folder_(std::move(folder)), most_resident_(most_resident) {
  std::string name = (folder_ / ".lightwell-rows-XXXXXX").string();
  file_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (file_ < 0) {
    throw std::runtime_error(
        fmt::format("{}: no file can be made here for rows that do not fit into memory: {}",
                    folder_.string(), std::generic_category().message(errno)));
  }
  ::unlink(name.c_str());
}

SpillFile::~SpillFile() {
  ::close(file_);
}

std::unique_ptr<SpillFile::Piece> SpillFile::write(std::span<const std::byte> bytes) {
  auto piece = std::make_unique<Piece>();
  piece->size_ = whole_pages(bytes.size());
  const auto size = static_cast<std::int64_t>(piece->size_);
  {
    const std::lock_guard lock(mutex_);
    auto& same_size = holes_[piece->size_];
    if (same_size.empty()) {
      piece->offset_ = end_;
      end_ += size;
    } else {
      piece->offset_ = same_size.back();
      same_size.pop_back();
    }
    used_ += size;
    most_used_ = std::max(most_used_, used_);
  }
  // Reserves the disk space first: access to a mapped page without disk space raises a signal, not
  // an error.
  int error = EINTR;
  while (error == EINTR) error = ::posix_fallocate(file_, piece->offset_, size);
  if (error != 0) fail(error, size);
  put(bytes, piece->offset_);
  void* const at = ::mmap(nullptr, piece->size_, PROT_READ, MAP_SHARED, file_, piece->offset_);
  if (at == MAP_FAILED) fail(errno, size);
  piece->data_ = static_cast<const std::byte*>(at);
  return piece;
}

void SpillFile::put(std::span<const std::byte> bytes, std::int64_t offset) const {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(file_, bytes.data(), bytes.size(), offset);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      fail(written < 0 ? errno : ENOSPC, static_cast<std::int64_t>(bytes.size()));
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += written;
  }
}

void SpillFile::bring_in(Piece& piece) {
  const std::lock_guard lock(mutex_);
  if (piece.is_resident_) return;
  ::madvise(const_cast<std::byte*>(piece.data_), piece.size_, MADV_WILLNEED);
  piece.is_resident_ = true;
  recent_.push_back(&piece);
  resident_ += static_cast<std::int64_t>(piece.size_);
  while (resident_ > most_resident_ && recent_.front() != &piece) {
    Piece& oldest = *recent_.front();
    recent_.pop_front();
    resident_ -= static_cast<std::int64_t>(oldest.size_);
    oldest.is_resident_ = false;
    // The mapping and its contents remain: reading on brings pages back.
    ::madvise(const_cast<std::byte*>(oldest.data_), oldest.size_, MADV_DONTNEED);
  }
}

void SpillFile::erase(std::unique_ptr<Piece> piece) {
  ::munmap(const_cast<std::byte*>(piece->data_), piece->size_);
#ifdef FALLOC_FL_PUNCH_HOLE
  // Spares writing erased pages to disk. On file systems that cannot punch holes the space is only
  // reused.
  [[maybe_unused]] const int ignored =
      ::fallocate(file_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, piece->offset_,
                  static_cast<off_t>(piece->size_));
#endif
  const std::lock_guard lock(mutex_);
  used_ -= static_cast<std::int64_t>(piece->size_);
  if (piece->is_resident_) {
    resident_ -= static_cast<std::int64_t>(piece->size_);
    recent_.erase(std::find(recent_.begin(), recent_.end(), piece.get()));
  }
  holes_[piece->size_].push_back(piece->offset_);
}

std::int64_t SpillFile::most_used() const {
  const std::lock_guard lock(mutex_);
  return most_used_;
}

void SpillFile::fail(int error, std::int64_t bytes) const {
  throw std::runtime_error(fmt::format(
      "{}: {:.1f} MB of rows that do not fit into memory could not be written to a file here: {}; "
      "{:.1f} MB have been. Make room, allow more memory, or write the output to another disk",
      folder_.string(), static_cast<double>(bytes) / (1 << 20),
      std::generic_category().message(error),
      static_cast<double>(most_used() - bytes) / (1 << 20)));
}

}  // namespace lightwell
