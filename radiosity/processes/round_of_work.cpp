#include "radiosity/processes/round_of_work.h"

#include <cstring>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

#include "radiosity/processes/tags.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

using Clock = std::chrono::steady_clock;

// Bytes that wait to be taken, and to be sent, before a process receives or computes more.
constexpr std::int64_t most_arrived = 64 << 20, most_unsent = 256 << 20;

struct Request {
  std::int64_t round = 0;
  std::uint64_t fingerprint = 0;
};

// Results carry the number of their piece at the end.
SharedBytes numbered(Bytes bytes, std::int32_t piece) {
  const std::size_t size = bytes.size();
  bytes.resize(size + sizeof piece);
  std::memcpy(bytes.data() + size, &piece, sizeof piece);
  return std::make_shared<Bytes>(std::move(bytes));
}
std::int32_t take_number(Bytes& bytes) {
  std::int32_t piece = -1;
  if (bytes.size() < sizeof piece) return piece;
  const std::size_t size = bytes.size() - sizeof piece;
  std::memcpy(&piece, bytes.data() + size, sizeof piece);
  bytes.resize(size);
  return piece;
}

}  // namespace

RoundOfWork::RoundOfWork(const RoundMessages& messages, const SharedWork& work)
    : messages_(messages),
      work_(work),
      pieces_((work.count + work.grain - 1) / work.grain),
      threads_(work.uses_all_threads ? 1 : std::max(1, std::min(thread_count(), pieces_))),
      has_come_(static_cast<std::size_t>(messages.port.size()), 0) {
  if (!is_first() || !work.is_kept) return;
  for (int p = 0; p < pieces_; ++p) {
    if (work.is_kept(begin_of(p), end_of(p))) own_.push_back(p);
  }
}

void RoundOfWork::run() {
  std::thread crew([this] {
    try {
      if (threads_ == 1) {
        work_until_done();
      } else {
        parallel_for(threads_, 1, [this](int, int) { work_until_done(); });
      }
    } catch (...) {
      stop(std::current_exception());
    }
  });
  try {
    talk();
  } catch (...) {
    stop(std::current_exception());
  }
  crew.join();
  if (error_) std::rethrow_exception(error_);
}

void RoundOfWork::stop(std::exception_ptr error) {
  const std::lock_guard lock(mutex_);
  if (!error_) error_ = std::move(error);
  is_stopped_ = true;
  to_compute_.notify_all();
  to_talk_.notify_all();
}

void RoundOfWork::work_until_done() {
  std::unique_lock lock(mutex_);
  while (work_once(lock)) {
  }
}

bool RoundOfWork::work_once(std::unique_lock<std::mutex>& lock) {
  const auto may_compute = [&] { return !own_.empty() && !is_sending_enough_; };
  ++idle_;
  to_talk_.notify_all();
  to_compute_.wait(lock, [&] {
    return is_stopped_ || started_ == pieces_ || !arrived_.empty() || may_compute();
  });
  --idle_;
  if (is_stopped_) return false;
  if (!arrived_.empty()) {
    take(lock);
  } else if (may_compute()) {
    compute(lock);
  } else {
    return false;
  }
  ++finished_;
  to_talk_.notify_all();
  return true;
}

void RoundOfWork::take(std::unique_lock<std::mutex>& lock) {
  const Results results = std::move(arrived_.front());
  arrived_.pop_front();
  arrived_bytes_ -= static_cast<std::int64_t>(results.bytes->size());
  if (++started_ == pieces_) to_compute_.notify_all();
  lock.unlock();
  work_.take(begin_of(results.piece), end_of(results.piece), *results.bytes);
  lock.lock();
}

void RoundOfWork::compute(std::unique_lock<std::mutex>& lock) {
  const int piece = own_.front();
  own_.pop_front();
  if (++started_ == pieces_) to_compute_.notify_all();
  lock.unlock();
  const auto start = Clock::now();
  const SharedBytes bytes = numbered(work_.compute(begin_of(piece), end_of(piece)), piece);
  const std::chrono::duration<double> taken = Clock::now() - start;
  lock.lock();
  computed_.push_back({piece, bytes});
  messages_.traffic.busy += taken.count();
  ++messages_.traffic.pieces;
}

void RoundOfWork::talk() {
  using std::chrono::microseconds;
  constexpr microseconds shortest{50}, longest{1000};
  last_progress_ = Clock::now();
  if (!is_first()) {
    send(0, request_tag, message_of(Request{messages_.round, work_.fingerprint}));
    asked_ = 1;
  }
  for (microseconds time = shortest;;) {
    messages_.check();
    const bool was_busy = talk_once();
    report_progress();
    if (is_over()) return;
    time = was_busy ? shortest : std::min(2 * time, longest);
    if (!was_busy) pause(time);
    const std::lock_guard lock(mutex_);
    if (is_stopped_) return;
  }
}

bool RoundOfWork::talk_once() {
  bool was_busy = is_first() ? deal() : ask();
  was_busy = receive_results() || was_busy;
  return send_results() || was_busy;
}

// Until another thread has results or no piece, but at most for `time`: messages wake no one.
void RoundOfWork::pause(std::chrono::microseconds time) {
  std::unique_lock lock(mutex_);
  const int idle = idle_, finished = finished_;
  to_talk_.wait_for(lock, time, [&] {
    return is_stopped_ || !computed_.empty() || idle_ > idle || finished_ != finished;
  });
}

void RoundOfWork::report_progress() {
  constexpr double every = 0.1;  // seconds
  const auto now = Clock::now();
  if (!work_.progress || std::chrono::duration<double>(now - last_progress_).count() < every) {
    return;
  }
  last_progress_ = now;
  int finished = 0;
  {
    const std::lock_guard lock(mutex_);
    finished = finished_;
  }
  work_.progress(std::min(finished * work_.grain, work_.count));
}

// Pieces that the threads of this process want now: one for each idle thread, and one for the next,
// unless a piece takes long.
int RoundOfWork::missing_pieces() {
  const std::lock_guard lock(mutex_);
  const int wanted = idle_ + (work_.uses_all_threads ? 0 : 1);
  return wanted - static_cast<int>(own_.size());
}

int RoundOfWork::next_piece() {
  while (next_ < pieces_ && work_.is_kept && work_.is_kept(begin_of(next_), end_of(next_))) ++next_;
  return next_ < pieces_ ? next_++ : -1;
}

bool RoundOfWork::deal() {
  while (const auto request = receive(request_tag)) note_request(*request);
  bool was_busy = false;
  for (; !waiting_.empty(); waiting_.pop_front()) {
    const int piece = next_piece();
    if (piece < 0) break;
    send(waiting_.front(), tag_of(RoundTag::piece, messages_.round), message_of(piece));
    was_busy = true;
  }
  for (int missing = missing_pieces(); missing > 0; --missing) {
    const int piece = next_piece();
    if (piece < 0) break;
    const std::lock_guard lock(mutex_);
    own_.push_back(piece);
    to_compute_.notify_one();
    was_busy = true;
  }
  return was_busy;
}

void RoundOfWork::note_request(const Message& message) {
  const auto request = value_of<Request>(message.bytes);
  if (request.round < messages_.round) return;  // of a round that is over
  if (request.round > messages_.round || request.fingerprint != work_.fingerprint) {
    throw std::runtime_error(
        "process " + std::to_string(message.from) +
        " does other work than process 0, although program, scene and options agree; use machines "
        "with the same kind of processor and the same libraries (docs/cluster.md)");
  }
  has_come_[static_cast<std::size_t>(message.from)] = 1;
  waiting_.push_back(message.from);
}

bool RoundOfWork::ask() {
  bool was_busy = false;
  while (const auto message = receive(tag_of(RoundTag::piece, messages_.round))) {
    const std::lock_guard lock(mutex_);
    own_.push_back(value_of<int>(message->bytes));
    --asked_;
    to_compute_.notify_one();
    was_busy = true;
  }
  for (int missing = missing_pieces() - asked_; missing > 0; --missing, ++asked_) {
    send(0, request_tag, message_of(Request{messages_.round, work_.fingerprint}));
  }
  return was_busy;
}

bool RoundOfWork::receive_results() {
  bool was_busy = false;
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      if (arrived_bytes_ > most_arrived) return was_busy;
    }
    auto message = receive(tag_of(RoundTag::results, messages_.round));
    if (!message) return was_busy;
    const int piece = take_number(message->bytes);
    if (piece < 0 || piece >= pieces_) {
      throw std::runtime_error("results of an unknown piece arrived; please report this");
    }
    const std::lock_guard lock(mutex_);
    arrived_bytes_ += static_cast<std::int64_t>(message->bytes.size());
    arrived_.push_back({piece, std::make_shared<Bytes>(std::move(message->bytes))});
    to_compute_.notify_one();
    was_busy = true;
  }
}

bool RoundOfWork::send_results() {
  std::deque<Results> computed;
  {
    const std::lock_guard lock(mutex_);
    computed.swap(computed_);
  }
  for (const Results& results : computed) {
    for (int r = 0; r < messages_.port.size(); ++r) {
      if (r != messages_.port.rank()) {
        send(r, tag_of(RoundTag::results, messages_.round), results.bytes);
      }
    }
  }
  const bool is_enough = messages_.port.unsent() > most_unsent;
  const std::lock_guard lock(mutex_);
  if (std::exchange(is_sending_enough_, is_enough) != is_enough) to_compute_.notify_all();
  return !computed.empty();
}

bool RoundOfWork::is_over() {
  if (!is_first() && !has_verdict_) {
    has_verdict_ = receive(tag_of(RoundTag::verdict, messages_.round)).has_value();
  }
  {
    const std::lock_guard lock(mutex_);
    if (finished_ < pieces_ || !computed_.empty()) return false;
  }
  if (messages_.port.unsent() > 0) return false;
  if (!is_first()) return has_verdict_;
  if (std::count(has_come_.begin() + 1, has_come_.end(), 0) > 0) return false;
  for (int r = 1; r < messages_.port.size(); ++r) {
    send(r, tag_of(RoundTag::verdict, messages_.round), std::make_shared<Bytes>());
  }
  return true;
}

void RoundOfWork::send(int to, int tag, SharedBytes bytes) {
  messages_.traffic.sent += static_cast<std::int64_t>(bytes->size());
  messages_.port.send(to, tag, std::move(bytes));
}

std::optional<Message> RoundOfWork::receive(int tag) {
  auto message = messages_.port.receive(tag);
  if (message) messages_.traffic.received += static_cast<std::int64_t>(message->bytes.size());
  return message;
}

}  // namespace lightwell
