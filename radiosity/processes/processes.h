#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/processes/message_port.h"
#include "scene/errors.h"

namespace lightwell {

/// Thrown in all processes but the first once the first has ended the run, whose reason only the
/// first reports.
class Dismissed : public Interrupted {};

/// Work of which each piece is computed by one process and taken by all others.
struct SharedWork {
  std::uint64_t fingerprint = 0;  ///< of all that affects the results; must agree
  int count = 0;                  ///< indices [0, count)
  int grain = 1;                  ///< indices of a piece
  bool uses_all_threads = false;  ///< `compute` is parallel itself, and runs once at a time
  /// True if the first process need not compute the piece, since a checkpoint has it. Asked in the
  /// first process only.
  std::function<bool(int begin, int end)> is_kept{};
  /// Results of the indices [begin, end), as bytes. Called from many threads.
  std::function<Bytes(int begin, int end)> compute{};
  /// Takes what another process has computed. Called from many threads.
  std::function<void(int begin, int end, const Bytes& results)> take{};
  /// Called again and again by the calling thread, with the number of indices that are finished; an
  /// exception ends the work in all processes.
  std::function<void(int finished)> progress{};
};

/// Work and messages of one process since the start.
struct Traffic {
  std::int64_t sent = 0, received = 0;  ///< bytes
  std::int64_t pieces = 0;              ///< computed by this process
  std::int64_t rounds = 0;              ///< calls that all processes take part in
  double busy = 0.0;                    ///< seconds of all threads in `compute`
};

/// The processes of one run, which all run the same program on the same input. A piece of shared
/// work is handed out when a process asks for it (self-scheduling; Dongarra et al., Sourcebook of
/// Parallel Computing, 2003, section 3.3), so a slow process computes fewer pieces. Results do not
/// depend on the process that computes them.
///
/// Functions that say "collective" must be called by all processes in the same order, from one
/// thread. The first process, rank 0, decides, reports and writes. Collective functions throw
/// std::runtime_error or InputError in the first process if another one has failed, and Dismissed
/// in the others once the first has ended the run.
class Processes {
 public:
  explicit Processes(std::unique_ptr<MessagePort> port);
  ~Processes();
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  int rank() const;
  int size() const;
  bool is_first() const { return rank() == 0; }

  /// Computes all pieces of `work`. Collective. Throws what a piece or `progress` throws, in the
  /// process where that happened.
  void share(const SharedWork& work);
  /// Bytes of the first process, in all processes. Collective.
  Bytes from_first(Bytes mine);
  /// The least value of all processes. Collective.
  std::int64_t least(std::int64_t mine);
  /// Texts of all processes by rank in the first process; none in the others. Collective.
  std::vector<std::string> gather(std::string_view mine);
  /// Collective. Throws InputError unless `mine` is the same text in all processes; `what` ("the
  /// scene") names the text in the message.
  void require_same(std::string_view what, std::string_view mine);

  /// Throws std::runtime_error or InputError in the first process if another has failed; Dismissed
  /// in the others once the first has ended the run. To be called now and then in long work.
  void check();

  /// Ends the run of this process, with the reason if it failed, and returns once all have ended.
  /// If the first process has failed, the others are dismissed, and all are aborted unless they end
  /// within `patience` seconds: they look between pieces of work, which take a second or two. To be
  /// called once, also after Dismissed.
  void close(std::string_view failure, bool is_input_error, double patience = 20.0);

  const Traffic& traffic() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightwell
