#include "radiosity/rows/row_store.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <new>

#include "radiosity/rows/spill_file.h"

namespace lightwell {
namespace {

// Memory mapped directly from the system, since an allocator may keep freed memory.
class Pages {
 public:
  Pages() = default;
  explicit Pages(std::size_t bytes) : size_(whole_pages(bytes)) {
    void* const at =
        ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (at == MAP_FAILED) throw std::bad_alloc();
    data_ = static_cast<std::byte*>(at);
  }
  Pages(Pages&& other) noexcept { swap(other); }
  Pages& operator=(Pages&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Pages() {
    if (data_) ::munmap(data_, size_);
  }
  std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }
  // Frees all pages beyond `bytes`.
  void trim(std::size_t bytes) {
    const std::size_t kept = whole_pages(bytes);
    if (kept >= size_) return;
    ::munmap(data_ + kept, size_ - kept);
    size_ = kept;
  }

 private:
  void swap(Pages& other) {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

struct RowRange {
  int chunk = -1;
  std::uint32_t first = 0, count = 0;  // in records of the chunk
};

// Rows in memory or in the file; neither once all are released.
struct Chunk {
  Pages memory{};
  std::unique_ptr<SpillFile::Piece> piece{};
  std::size_t used = 0;
  std::int64_t taken = 0;  // bytes taken from the budget
  int rows = 0;
};

}  // namespace

std::size_t RecordSpan::lower_bound(int patch) const {
  std::size_t low = 0, high = count_;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (this->patch(middle) < patch) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

struct RecordStore::Impl {
  std::shared_ptr<MemoryBudget> budget;  // outlives the assembly of the rows
  SpillFile* file = nullptr;             // the budget's file, null before its first use
  std::size_t record_bytes = 0;
  Count count = Count::none;
  std::mutex mutex{};
  std::vector<RowRange> ranges{};
  std::vector<int> column_sizes{};
  std::vector<Chunk> chunks{};
  std::int64_t records = 0;
  bool is_filling = false;  // true while rows are added to the last chunk

  ~Impl() {
    for (Chunk& chunk : chunks) drop(chunk);
  }

  void open_chunk(std::size_t bytes) {
    const std::size_t usual = budget->chunk_bytes();
    chunks.push_back({.memory = Pages(std::max(usual, bytes))});
    is_filling = true;
  }

  // Ends the last chunk, which stays in memory or goes to disk.
  void close_chunk() {
    if (!is_filling) return;
    is_filling = false;
    Chunk& chunk = chunks.back();
    chunk.memory.trim(chunk.used);
    const auto bytes = static_cast<std::int64_t>(chunk.memory.size());
    if (budget->take(bytes)) {
      chunk.taken = bytes;
      return;
    }
    file = &budget->spill_file();
    chunk.piece = file->write({chunk.memory.data(), chunk.used});
    chunk.memory = Pages();
  }

  void drop(Chunk& chunk) {
    if (chunk.piece) file->erase(std::move(chunk.piece));
    chunk.memory = Pages();
    budget->give_back(chunk.taken);
    chunk.taken = 0;
  }

  void count_columns(int i, RecordSpan row) {
    const std::size_t first = count == Count::above_diagonal ? row.lower_bound(i + 1) : 0;
    const std::size_t last = count == Count::below_diagonal ? row.lower_bound(i) : row.size();
    for (std::size_t k = first; k < last; ++k) ++column_sizes[row.patch(k)];
  }
};

RecordStore::RecordStore(std::shared_ptr<MemoryBudget> budget, int rows, std::size_t record_bytes,
                         Count count)
    : impl_(std::make_unique<Impl>()) {
  impl_->budget = budget ? std::move(budget) : std::make_shared<MemoryBudget>();
  impl_->record_bytes = record_bytes;
  impl_->count = count;
  impl_->ranges.resize(static_cast<std::size_t>(rows));
  if (count != Count::none) impl_->column_sizes.resize(static_cast<std::size_t>(rows));
}

RecordStore::RecordStore(RecordStore&&) noexcept = default;
RecordStore& RecordStore::operator=(RecordStore&&) noexcept = default;
RecordStore::~RecordStore() = default;

void RecordStore::append(int i, const void* records, std::size_t count) {
  if (count == 0) return;
  const std::size_t bytes = count * impl_->record_bytes;
  const std::lock_guard lock(impl_->mutex);
  if (impl_->is_filling && impl_->chunks.back().used + bytes > impl_->chunks.back().memory.size()) {
    impl_->close_chunk();
  }
  if (!impl_->is_filling) impl_->open_chunk(bytes);
  Chunk& chunk = impl_->chunks.back();
  std::memcpy(chunk.memory.data() + chunk.used, records, bytes);
  impl_->ranges[i] = {.chunk = static_cast<int>(impl_->chunks.size()) - 1,
                      .first = static_cast<std::uint32_t>(chunk.used / impl_->record_bytes),
                      .count = static_cast<std::uint32_t>(count)};
  chunk.used += bytes;
  ++chunk.rows;
  impl_->records += static_cast<std::int64_t>(count);
  if (impl_->count != Count::none) {
    impl_->count_columns(i, {static_cast<const std::byte*>(records), count, impl_->record_bytes});
  }
}

void RecordStore::close() {
  const std::lock_guard lock(impl_->mutex);
  impl_->close_chunk();
}

int RecordStore::row_count() const {
  return static_cast<int>(impl_->ranges.size());
}

std::size_t RecordStore::record_bytes() const {
  return impl_->record_bytes;
}

std::int64_t RecordStore::record_count() const {
  return impl_->records;
}

std::size_t RecordStore::row_size(int i) const {
  return impl_->ranges[i].count;
}

RecordSpan RecordStore::row(int i) const {
  const RowRange& range = impl_->ranges[i];
  if (range.count == 0) return {};
  const Chunk& chunk = impl_->chunks[range.chunk];
  const std::byte* data = chunk.memory.data();
  if (chunk.piece) {
    impl_->file->touch(*chunk.piece);
    data = chunk.piece->data();
  }
  return {data + range.first * impl_->record_bytes, range.count, impl_->record_bytes};
}

void RecordStore::release(int i) {
  RowRange& range = impl_->ranges[i];
  if (range.count == 0) return;
  Chunk& chunk = impl_->chunks[range.chunk];
  range.count = 0;
  if (--chunk.rows == 0) impl_->drop(chunk);
}

RecordStore::Count RecordStore::counted() const {
  return impl_->count;
}

int RecordStore::column_size(int j) const {
  return impl_->column_sizes[j];
}

MemoryBudget& RecordStore::budget() const {
  return *impl_->budget;
}

}  // namespace lightwell
