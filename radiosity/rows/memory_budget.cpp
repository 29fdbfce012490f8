#include "radiosity/rows/memory_budget.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <fstream>
#include <string>

#include "radiosity/rows/spill_file.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

constexpr std::int64_t kibibyte = 1 << 10, mebibyte = 1 << 20;
// With less room, rows would be moved to and fro page by page.
constexpr std::int64_t least_room = 16 * mebibyte;
// Runs of one command differ by a few megabytes, by the pages of shared libraries that the system
// maps in. A budget that was asked for must do in the next run too.
constexpr std::int64_t spread_of_runs = 8 * mebibyte;
constexpr std::int64_t largest_chunk = 4 * mebibyte, largest_block = 64 * mebibyte;

std::int64_t in_megabytes(std::int64_t bytes) {
  return (bytes + mebibyte - 1) / mebibyte;
}

}  // namespace

ResidentMemory resident_memory() {
  // VmHWM is the peak of this process alone; the peak of getrusage starts with the parent process's
  // memory.
  std::ifstream status("/proc/self/status");
  ResidentMemory memory;
  for (std::string word; status >> word;) {
    if (word == "VmHWM:") status >> memory.most;
    if (word == "VmRSS:") {
      status >> memory.now;
      break;
    }
  }
  if (memory.now == 0) {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    memory.now = memory.most = usage.ru_maxrss;
  }
  return {.now = memory.now * kibibyte, .most = memory.most * kibibyte};
}

void give_back_free_pages() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

std::int64_t usable_memory() {
  const std::int64_t physical =
      static_cast<std::int64_t>(::sysconf(_SC_PHYS_PAGES)) * ::sysconf(_SC_PAGESIZE);
  std::int64_t usable = physical;
  for (const char* file :
       {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::int64_t limit = 0;
    if (std::ifstream(file) >> limit && limit > 0) usable = std::min(usable, limit);
  }
  return usable;
}

MemoryBudget::MemoryBudget(MemoryOptions options) : options_(std::move(options)) {
  limit_ = options_.limit > 0 ? options_.limit : usable_memory() / 4 * 3;
  if (options_.folder.empty()) options_.folder = ".";
  share_out(resident_memory().now, 0);
}

MemoryBudget::~MemoryBudget() = default;

void MemoryBudget::plan(std::int64_t other) {
  const ResidentMemory memory = resident_memory();
  const std::int64_t needed = memory.now + other + least_room;
  if (options_.limit > 0 && std::max(needed, memory.most) > limit_) {
    throw InputError(fmt::format(
        "a memory budget of {} MB is too small: the scene, its mesh and its tree take {} MB ({} MB "
        "while they were made), work {} MB more, and a slice of rows {} MB. Allow {} MB or more, "
        "or make patches larger",
        limit_ / mebibyte, in_megabytes(memory.now), in_megabytes(memory.most), in_megabytes(other),
        in_megabytes(least_room), in_megabytes(std::max(needed, memory.most) + spread_of_runs)));
  }
  share_out(memory.now, other);
}

void MemoryBudget::share_out(std::int64_t resident, std::int64_t other) {
  std::int64_t room = std::max(limit_ - resident - other, least_room);
  if (options_.rows >= 0) room = std::min(room, options_.rows);
  const auto page = static_cast<std::int64_t>(whole_pages(1));
  chunk_ = std::clamp(room / 64 / page * page, page, largest_chunk);
  block_ = std::clamp(room / 8, page, largest_block);
  window_ = block_;
  // A block, the mapped part of the file, and the chunks being filled.
  headroom_ = other + block_ + window_ + 4 * chunk_;
}

bool MemoryBudget::take(std::int64_t bytes) {
  const std::lock_guard lock(mutex_);
  if (options_.rows >= 0 && in_memory_ + bytes > options_.rows) return false;
  if (resident_memory().now + headroom_ > limit_) return false;
  in_memory_ += bytes;
  most_in_memory_ = std::max(most_in_memory_, in_memory_);
  return true;
}

void MemoryBudget::give_back(std::int64_t bytes) {
  const std::lock_guard lock(mutex_);
  in_memory_ -= bytes;
}

SpillFile& MemoryBudget::spill_file() {
  const std::lock_guard lock(mutex_);
  if (!spill_file_) spill_file_ = std::make_unique<SpillFile>(options_.folder, window_);
  return *spill_file_;
}

StorageReport MemoryBudget::report() const {
  const std::lock_guard lock(mutex_);
  return {.limit = limit_,
          .most_in_memory = most_in_memory_,
          .most_on_disk = spill_file_ ? spill_file_->most_used() : 0,
          .folder = options_.folder};
}

}  // namespace lightwell
