#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "radiosity/processes/message_port.h"
#include "radiosity/processes/processes.h"

namespace lightwell {

struct RoundMessages {
  MessagePort& port;
  std::int64_t round;
  Traffic& traffic;
  std::function<void()> check{};  ///< see Processes::check
};

/// One call of Processes::share. The calling thread sends and receives; others compute and take.
///
/// - A process asks the first one for a piece when a thread of its own has none.
/// - The first process hands out pieces in order, and keeps those that a checkpoint has.
/// - Results go from the process that computed them to all others.
/// - The first process ends the round when all pieces are there and all processes have come to the
///   round.
class RoundOfWork {
 public:
  RoundOfWork(const RoundMessages& messages, const SharedWork& work);
  /// See Processes::share.
  void run();

 private:
  struct Results {
    int piece;
    SharedBytes bytes;
  };
  int begin_of(int piece) const { return piece * work_.grain; }
  int end_of(int piece) const { return std::min(work_.count, (piece + 1) * work_.grain); }
  bool is_first() const { return messages_.port.rank() == 0; }
  // Threads that compute.
  void work_until_done();
  bool work_once(std::unique_lock<std::mutex>& lock);
  void compute(std::unique_lock<std::mutex>& lock);
  void take(std::unique_lock<std::mutex>& lock);
  void stop(std::exception_ptr error);

  // The calling thread. Each step returns whether there was anything to do.
  void talk();
  bool talk_once();
  void pause(std::chrono::microseconds time);
  bool deal();
  void note_request(const Message& message);
  int next_piece();
  bool ask();
  bool receive_results();
  bool send_results();
  bool is_over();
  void report_progress();
  void send(int to, int tag, SharedBytes bytes);
  std::optional<Message> receive(int tag);
  int missing_pieces();

  RoundMessages messages_;
  const SharedWork& work_;
  int pieces_, threads_;

  // Members that the calling thread alone uses.
  int next_ = 0;                  // first: next piece to hand out
  std::deque<int> waiting_{};     // first: processes without an answer
  std::vector<char> has_come_{};  // first: processes that have come to this round
  int asked_ = 0;                 // others: requests without an answer
  bool has_verdict_ = false;      // others
  std::chrono::steady_clock::time_point last_progress_{};

  std::mutex mutex_{};
  std::condition_variable to_compute_{}, to_talk_{};
  std::deque<int> own_{};          // pieces to compute
  std::deque<Results> arrived_{};  // pieces to take
  std::int64_t arrived_bytes_ = 0;
  std::deque<Results> computed_{};  // pieces to send
  int started_ = 0, finished_ = 0;  // pieces computed or taken
  int idle_ = 0;                    // threads without a piece
  bool is_stopped_ = false, is_sending_enough_ = false;
  std::exception_ptr error_{};
};

}  // namespace lightwell
