#pragma once

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "radiosity/journal/fingerprint.h"
#include "radiosity/journal/journal.h"
#include "radiosity/journal/packed.h"
#include "scene/parallel.h"

namespace lightwell {

/// One phase of a solve in a journal. Without a journal nothing is recalled or kept, at no cost.
/// Values are of the types that Packed takes.
class JournalPhase {
 public:
  JournalPhase() = default;
  /// `print(Fingerprint&)` adds all that affects the phase's result.
  template <class Print>
  JournalPhase(Journal* journal, std::string_view name, Print print) : journal_(journal) {
    if (!journal) return;
    Fingerprint fingerprint;
    print(fingerprint);
    phase_ = journal->phase(name, fingerprint.value());
  }

  bool is_kept() const { return journal_ != nullptr; }

  /// Recalls a block. Returns false if the block was not kept; `values` are undefined then. Safe to
  /// call from many threads.
  template <class... T>
  bool recall(int block, T&&... values) const {
    if (!journal_) return false;
    std::vector<std::byte> bytes;
    return journal_->recall(phase_, block, bytes) && unpack(bytes, values...);
  }
  template <class... T>
  void keep(int block, const T&... values) const {
    if (!journal_) return;
    Packed packed;
    (packed.add(values), ...);
    journal_->keep(phase_, block, packed.bytes());
  }

  /// Recalls the latest state of an iteration. Returns false if there is none. Throws
  /// std::runtime_error if the state does not fit `values`.
  template <class... T>
  bool recall_state(T&&... values) {
    if (!journal_) return false;
    std::vector<std::byte> bytes;
    if (!journal_->recall_state(phase_, bytes)) return false;
    if (!unpack(bytes, values...)) refuse_state();
    has_state_ = true;
    return true;
  }
  template <class... T>
  void keep_state(const T&... values) {
    if (!journal_) return;
    Packed packed;
    (packed.add(values), ...);
    journal_->keep_state(phase_, packed.bytes());
    has_state_ = true;
    last_state_ = std::chrono::steady_clock::now();
  }
  /// True if the journal's interval has passed since the last state.
  bool is_state_due() const {
    return journal_ &&
           std::chrono::duration<double>(std::chrono::steady_clock::now() - last_state_).count() >=
               journal_->every();
  }
  /// True if any state was kept or recalled. The end of an iteration that took so long is worth
  /// keeping.
  bool has_state() const { return has_state_; }

 private:
  [[noreturn]] void refuse_state() const {
    throw std::runtime_error("the checkpoint '" + journal_->file().string() +
                             "' holds a state of another kind; remove it to start again");
  }
  template <class... T>
  static bool unpack(std::span<const std::byte> bytes, T&... values) {
    Unpacked packed(bytes);
    return (packed.take(values) && ...) && packed.is_empty();
  }

  Journal* journal_ = nullptr;
  int phase_ = 0;
  bool has_state_ = false;
  std::chrono::steady_clock::time_point last_state_ = std::chrono::steady_clock::now();
};

/// parallel_for over [0, count) in slices, which are blocks of a phase. Kept slices are recalled;
/// others are computed by `body(begin, end)` and kept. `values(begin, size)` is a tuple of all that
/// a slice fills. `before(begin)` is called before each slice, from the calling thread.
template <class Values, class Before, class Body>
void for_each_slice(const JournalPhase& phase, int count, int slice, int grain, Values values,
                    Before before, Body body) {
  for (int begin = 0, block = 0; begin < count; begin += slice, ++block) {
    before(begin);
    const int size = std::min(slice, count - begin);
    auto filled = values(begin, size);
    if (phase.recall(block, filled)) continue;
    parallel_for(size, grain, [&](int low, int high) { body(begin + low, begin + high); });
    phase.keep(block, filled);
  }
}

}  // namespace lightwell
