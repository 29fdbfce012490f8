#include "radiosity/journal/journal_phase.h"

#include <cstring>
#include <mutex>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "radiosity/journal/journal.h"
#include "radiosity/processes/processes.h"

namespace lightwell {
namespace {

// Blocks of a piece, one after another: the number of bytes, or `none` for a block that was not
// kept, and the bytes.
constexpr std::int64_t none = -1;

void append_block(const std::vector<std::byte>* block, Bytes& piece) {
  const std::int64_t size = block ? static_cast<std::int64_t>(block->size()) : none;
  const auto head = std::as_bytes(std::span(&size, 1));
  piece.insert(piece.end(), head.begin(), head.end());
  if (block) piece.insert(piece.end(), block->begin(), block->end());
}

// Takes the next block off `left`; false if there was none.
bool take_block(std::span<const std::byte>& left, std::span<const std::byte>& block) {
  std::int64_t size = 0;
  if (left.size() < sizeof size) throw std::runtime_error("a piece of shared work is torn");
  std::memcpy(&size, left.data(), sizeof size);
  left = left.subspan(sizeof size);
  if (size == none) return false;
  if (size < 0 || static_cast<std::size_t>(size) > left.size()) {
    throw std::runtime_error("a piece of shared work is torn");
  }
  block = left.first(static_cast<std::size_t>(size));
  left = left.subspan(static_cast<std::size_t>(size));
  return true;
}

// Blocks by number, from many threads.
class BlockTable {
 public:
  void put(int block, std::span<const std::byte> bytes) {
    const std::lock_guard lock(mutex_);
    bytes_[block].assign(bytes.begin(), bytes.end());
  }
  bool take(int block, std::vector<std::byte>& bytes) {
    const std::lock_guard lock(mutex_);
    const auto at = bytes_.find(block);
    if (at == bytes_.end()) return false;
    bytes = std::move(at->second);
    bytes_.erase(at);
    return true;
  }

 private:
  std::mutex mutex_{};
  std::unordered_map<int, std::vector<std::byte>> bytes_{};
};

}  // namespace

struct JournalPhase::Sharing {
  Processes& processes;
  std::uint64_t fingerprint = 0;
  bool is_in_round = false;
  BlockTable arrived{}, computed{};
};

bool JournalPhase::is_needed(const RunControl& run) {
  return run.journal || (run.processes && run.processes->size() > 1);
}

void JournalPhase::begin(const RunControl& run, std::string_view name, std::uint64_t fingerprint) {
  journal_ = run.journal;
  if (journal_) phase_ = journal_->phase(name, fingerprint);
  if (!run.processes || run.processes->size() == 1) return;
  sharing_ = std::make_shared<Sharing>(*run.processes, fingerprint);
}

int JournalPhase::processes() const {
  return sharing_ ? sharing_->processes.size() : 1;
}

std::int64_t JournalPhase::least(std::int64_t value) const {
  return sharing_ ? sharing_->processes.least(value) : value;
}

bool JournalPhase::recall_bytes(int block, std::vector<std::byte>& bytes) const {
  const bool is_shared = sharing_ && sharing_->is_in_round;
  if (is_shared && sharing_->arrived.take(block, bytes)) return true;
  if (!journal_ || !journal_->recall(phase_, block, bytes)) return false;
  if (is_shared) sharing_->computed.put(block, bytes);
  return true;
}

void JournalPhase::keep_bytes(int block, std::span<const std::byte> bytes) const {
  if (sharing_ && sharing_->is_in_round) sharing_->computed.put(block, bytes);
  if (journal_) journal_->keep(phase_, block, bytes);
}

void JournalPhase::for_each(const Blocks& blocks, const std::function<void(int, int)>& body,
                            const std::function<void()>& waits) const {
  if (!sharing_) {
    parallel_for(blocks.count, blocks.grain, body);
    return;
  }
  share(blocks, false, body, [&](int) {
    if (waits) waits();
  });
}

void JournalPhase::for_each_in_turn(int count, const std::function<void(int)>& before,
                                    const std::function<void(int)>& body) const {
  if (!sharing_) {
    for (int block = 0; block < count; ++block) {
      before(block);
      body(block);
    }
    return;
  }
  if (count > 0) before(0);
  const auto each = [&](int low, int high) {
    for (int block = low; block < high; ++block) body(block);
  };
  share({.count = count}, true, each, before);
}

void JournalPhase::share(const Blocks& blocks, bool uses_all_threads,
                         const std::function<void(int, int)>& body,
                         const std::function<void(int)>& progress) const {
  // Others would only wait for a single piece, so each process computes it itself.
  if (blocks.count <= blocks.grain) {
    if (blocks.count > 0) body(0, blocks.count);
    return;
  }
  Sharing& sharing = *sharing_;
  SharedWork work{.count = blocks.count,
                  .grain = std::max(1, blocks.grain),
                  .uses_all_threads = uses_all_threads,
                  .progress = progress};
  Fingerprint print;
  print.add(sharing.fingerprint);
  print.add(blocks.first);
  print.add(blocks.count);
  work.fingerprint = print.value();
  if (journal_) {
    work.is_kept = [&](int begin, int end) {
      for (int k = begin; k < end; ++k) {
        if (!journal_->holds(phase_, blocks.first + k)) return false;
      }
      return true;
    };
  }
  work.compute = [&](int begin, int end) {
    body(begin, end);
    Bytes piece;
    std::vector<std::byte> block;
    for (int k = begin; k < end; ++k) {
      const bool is_kept = sharing.computed.take(blocks.first + k, block);
      append_block(is_kept ? &block : nullptr, piece);
    }
    return piece;
  };
  work.take = [&](int begin, int end, const Bytes& piece) {
    std::span<const std::byte> left(piece), block;
    for (int k = begin; k < end; ++k) {
      if (!take_block(left, block)) continue;
      const int number = blocks.first + k;
      sharing.arrived.put(number, block);
      if (journal_ && !journal_->holds(phase_, number)) journal_->keep(phase_, number, block);
    }
    body(begin, end);
  };
  sharing.is_in_round = true;
  sharing.processes.share(work);
  sharing.is_in_round = false;
}

bool JournalPhase::recall_state_bytes(std::vector<std::byte>& bytes) const {
  const bool is_found = journal_ && journal_->recall_state(phase_, bytes);
  if (!sharing_) return is_found;
  // A state is never empty, so an empty message says that there is none.
  if (!is_found) bytes.clear();
  bytes = sharing_->processes.from_first(std::move(bytes));
  return !bytes.empty();
}

void JournalPhase::keep_state_bytes(std::span<const std::byte> bytes) {
  journal_->keep_state(phase_, bytes);
  has_state_ = true;
  last_state_ = std::chrono::steady_clock::now();
}

bool JournalPhase::is_state_due() const {
  return journal_ &&
         std::chrono::duration<double>(std::chrono::steady_clock::now() - last_state_).count() >=
             journal_->every();
}

void JournalPhase::refuse_state() const {
  throw std::runtime_error("the checkpoint '" + (journal_ ? journal_->file().string() : "") +
                           "' holds a state of another kind; remove it to start again");
}

}  // namespace lightwell
