#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "radiosity/journal/fingerprint.h"
#include "radiosity/journal/packed.h"
#include "radiosity/journal/run_control.h"
#include "scene/parallel.h"

namespace lightwell {

/// One phase of a solve, whose work consists of blocks or of iterations. A journal keeps the work,
/// and several processes share its blocks: a block that another process has computed is recalled
/// like one of a journal. With neither, nothing is recalled or kept, at no cost.
///
/// Values are of the types that Packed takes.
class JournalPhase {
 public:
  JournalPhase() = default;
  /// `print(Fingerprint&)` adds all that affects the phase's result.
  template <class Print>
  JournalPhase(const RunControl& run, std::string_view name, Print print) {
    if (!is_needed(run)) return;
    Fingerprint fingerprint;
    print(fingerprint);
    begin(run, name, fingerprint.value());
  }

  bool is_kept() const { return journal_ != nullptr || sharing_ != nullptr; }
  /// Number of processes that share the work.
  int processes() const;
  /// The least value of all processes, for a decision that must be the same in all.
  std::int64_t least(std::int64_t value) const;

  /// Recalls a block. Returns false if the block was not kept; `values` are undefined then. Safe to
  /// call from many threads.
  template <class... T>
  bool recall(int block, T&&... values) const {
    std::vector<std::byte> bytes;
    return is_kept() && recall_bytes(block, bytes) && unpack(bytes, values...);
  }
  template <class... T>
  void keep(int block, const T&... values) const {
    if (!is_kept()) return;
    Packed packed;
    (packed.add(values), ...);
    keep_bytes(block, packed.bytes());
  }

  /// Range of blocks that for_each() goes through.
  struct Blocks {
    int first = 0, count = 0, grain = 1;
  };
  /// parallel_for(count, grain, body), whose body(low, high) recalls each block from `first` + low
  /// to `first` + high - 1, or computes and keeps the block. With several processes each block is
  /// computed in one of them, except the blocks of a single grain, which each computes. `waits` is
  /// called now and then by the calling thread while other processes work; an exception of it ends
  /// the work.
  void for_each(const Blocks& blocks, const std::function<void(int low, int high)>& body,
                const std::function<void()>& waits = {}) const;
  /// The same for blocks 0 to count - 1 whose `body(block)` is parallel itself. `before(block)` is
  /// called by the calling thread, without several processes before each block.
  void for_each_in_turn(int count, const std::function<void(int block)>& before,
                        const std::function<void(int block)>& body) const;

  /// Recalls the latest state of an iteration, in all processes. Returns false if there is none.
  /// Throws std::runtime_error if the state does not fit `values`.
  template <class... T>
  bool recall_state(T&&... values) {
    std::vector<std::byte> bytes;
    if (!is_kept() || !recall_state_bytes(bytes)) return false;
    if (!unpack(bytes, values...)) refuse_state();
    has_state_ = true;
    return true;
  }
  template <class... T>
  void keep_state(const T&... values) {
    if (!journal_) return;
    Packed packed;
    (packed.add(values), ...);
    keep_state_bytes(packed.bytes());
  }
  /// True if the journal's interval has passed since the last state.
  bool is_state_due() const;
  /// True if any state was kept or recalled. The end of an iteration that took so long is worth
  /// keeping.
  bool has_state() const { return has_state_; }

 private:
  struct Sharing;

  static bool is_needed(const RunControl& run);
  void begin(const RunControl& run, std::string_view name, std::uint64_t fingerprint);
  void share(const Blocks& blocks, bool uses_all_threads,
             const std::function<void(int low, int high)>& body,
             const std::function<void(int finished)>& progress) const;
  bool recall_bytes(int block, std::vector<std::byte>& bytes) const;
  void keep_bytes(int block, std::span<const std::byte> bytes) const;
  bool recall_state_bytes(std::vector<std::byte>& bytes) const;
  void keep_state_bytes(std::span<const std::byte> bytes);
  [[noreturn]] void refuse_state() const;
  template <class... T>
  static bool unpack(std::span<const std::byte> bytes, T&... values) {
    Unpacked packed(bytes);
    return (packed.take(values) && ...) && packed.is_empty();
  }

  Journal* journal_ = nullptr;
  std::shared_ptr<Sharing> sharing_{};  // null in a single process
  int phase_ = 0;
  bool has_state_ = false;
  std::chrono::steady_clock::time_point last_state_ = std::chrono::steady_clock::now();
};

/// parallel_for over [0, count) in slices, which are blocks of a phase. Kept slices are recalled;
/// others are computed by `body(begin, end)` and kept. `values(begin, size)` is a tuple of all that
/// a slice fills. `before(begin)` is called from the calling thread: see for_each_in_turn().
template <class Values, class Before, class Body>
void for_each_slice(const JournalPhase& phase, int count, int slice, int grain, Values values,
                    Before before, Body body) {
  phase.for_each_in_turn(
      (count + slice - 1) / slice, [&](int block) { before(std::min(count, block * slice)); },
      [&](int block) {
        const int begin = block * slice, size = std::min(slice, count - begin);
        auto filled = values(begin, size);
        if (phase.recall(block, filled)) return;
        parallel_for(size, grain, [&](int low, int high) { body(begin + low, begin + high); });
        phase.keep(block, filled);
      });
}

}  // namespace lightwell
