#include "radiosity/processes/processes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <thread>
#include <utility>

#include "radiosity/processes/round_of_work.h"
#include "radiosity/processes/tags.h"

namespace lightwell {
namespace {

// "2 and 5", "1, 2 and 5".
std::string list_of(const std::vector<int>& ranks) {
  if (ranks.size() == 1) return fmt::format("{}", ranks[0]);
  const std::vector<int> most(ranks.begin(), ranks.end() - 1);
  return fmt::format("{} and {}", fmt::join(most, ", "), ranks.back());
}

std::string host_name() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

// Waits between two looks for messages: a moment at first, longer when nothing comes for a while.
class Patience {
 public:
  void wait() {
    std::this_thread::sleep_for(next_);
    next_ = std::min(2 * next_, longest);
  }

 private:
  static constexpr std::chrono::microseconds longest{1000};
  std::chrono::microseconds next_{20};
};

constexpr char input_error_mark = 'i', other_error_mark = 'o';

}  // namespace

struct Processes::Impl {
  explicit Impl(std::unique_ptr<MessagePort> messages) : port(std::move(messages)) {}

  bool is_first() const { return port->rank() == 0; }

  // The next message of the tag, which must come.
  Message wait_for(int tag) {
    for (Patience patience;; patience.wait()) {
      check();
      if (auto message = port->receive(tag)) {
        traffic.received += static_cast<std::int64_t>(message->bytes.size());
        return std::move(*message);
      }
    }
  }

  void send(int to, int tag, SharedBytes bytes) {
    traffic.sent += static_cast<std::int64_t>(bytes->size());
    port->send(to, tag, std::move(bytes));
  }
  void send_to_others(int tag, const SharedBytes& bytes) {
    for (int r = 0; r < port->size(); ++r) {
      if (r != port->rank()) send(r, tag, bytes);
    }
  }

  void check() {
    if (is_first()) {
      if (const auto failure = port->receive(failure_tag)) throw_failure(*failure);
    } else if (is_dismissed || port->receive(dismiss_tag)) {
      is_dismissed = true;
      throw Dismissed();
    }
  }

  [[noreturn]] static void throw_failure(const Message& failure) {
    const std::string text = text_of(failure.bytes);  // begins with a mark
    const std::string sentence = fmt::format("process {}: {}", failure.from, text.substr(1));
    if (text[0] == input_error_mark) throw InputError(sentence);
    throw std::runtime_error(sentence);
  }

  std::unique_ptr<MessagePort> port;
  std::int64_t round = 0;
  std::atomic<bool> is_dismissed = false;  // check() may be called from any thread
  bool is_closed = false;
  Traffic traffic{};
};

Processes::Processes(std::unique_ptr<MessagePort> port)
    : impl_(std::make_unique<Impl>(std::move(port))) {}

Processes::~Processes() = default;

int Processes::rank() const {
  return impl_->port->rank();
}

int Processes::size() const {
  return impl_->port->size();
}

const Traffic& Processes::traffic() const {
  return impl_->traffic;
}

void Processes::check() {
  impl_->check();
}

void Processes::share(const SharedWork& work) {
  const std::int64_t round = impl_->round++;
  ++impl_->traffic.rounds;
  RoundOfWork({*impl_->port, round, impl_->traffic, [this] { impl_->check(); }}, work).run();
}

Bytes Processes::from_first(Bytes mine) {
  const int tag = tag_of(RoundTag::verdict, impl_->round++);
  ++impl_->traffic.rounds;
  if (!is_first()) return impl_->wait_for(tag).bytes;
  impl_->send_to_others(tag, std::make_shared<Bytes>(mine));
  return mine;
}

std::vector<std::string> Processes::gather(std::string_view mine) {
  const int tag = tag_of(RoundTag::results, impl_->round++);
  ++impl_->traffic.rounds;
  if (!is_first()) {
    impl_->send(0, tag, std::make_shared<Bytes>(bytes_of(mine)));
    return {};
  }
  std::vector<std::string> texts(static_cast<std::size_t>(size()));
  texts[0] = mine;
  for (int r = 1; r < size(); ++r) {
    const Message message = impl_->wait_for(tag);
    texts[static_cast<std::size_t>(message.from)] = text_of(message.bytes);
  }
  return texts;
}

std::int64_t Processes::least(std::int64_t mine) {
  const SharedBytes bytes = message_of(mine);
  std::int64_t least = mine;
  for (const std::string& text : gather(text_of(*bytes))) {
    least = std::min(least, value_of<std::int64_t>(bytes_of(text)));
  }
  return value_of<std::int64_t>(from_first(*message_of(least)));
}

void Processes::require_same(std::string_view what, std::string_view mine) {
  const std::vector<std::string> texts = gather(mine);
  std::vector<int> others;
  for (int r = 0; r < static_cast<int>(texts.size()); ++r) {
    if (texts[static_cast<std::size_t>(r)] != mine) others.push_back(r);
  }
  std::string fault;
  if (!others.empty()) {
    fault = fmt::format(
        "{} of process{} {} is not that of process 0 ('{}' instead of '{}'); give all processes "
        "the same program, files and options",
        what, others.size() > 1 ? "es" : "", list_of(others),
        texts[static_cast<std::size_t>(others[0])], mine);
  }
  if (const std::string found = text_of(from_first(bytes_of(fault))); !found.empty()) {
    throw InputError(found);
  }
}

namespace {

// Ends messages so that none is under way when the port is finished: each process says when it has
// ended and all it sent has arrived, and the first lets all leave. What still comes meanwhile is
// dropped. Aborts the run if some process has not ended after `patience` seconds.
void end_messages(MessagePort& port, double patience) {
  const bool is_first = port.rank() == 0;
  const auto start = std::chrono::steady_clock::now();
  int ended = 0;
  bool has_said_ended = is_first, may_leave = false;
  for (Patience pause; !may_leave; pause.wait()) {
    const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - start;
    if (is_first && waited.count() > patience) port.abort(1);
    while (const auto message = port.receive(MessagePort::any_tag)) {
      if (message->tag == ended_tag) ++ended;
      if (message->tag == leave_tag) may_leave = true;
    }
    if (port.unsent() > 0) continue;
    if (!has_said_ended) port.send(0, ended_tag, std::make_shared<Bytes>());
    has_said_ended = true;
    if (is_first) may_leave = ended == port.size() - 1;
  }
  for (int r = 1; is_first && r < port.size(); ++r) {
    port.send(r, leave_tag, std::make_shared<Bytes>());
  }
  while (port.unsent() > 0) std::this_thread::yield();
  port.finish();
}

}  // namespace

void Processes::close(std::string_view failure, bool is_input_error, double patience) {
  if (std::exchange(impl_->is_closed, true)) return;
  const bool has_failed = !failure.empty();
  if (has_failed && is_first()) impl_->send_to_others(dismiss_tag, std::make_shared<Bytes>());
  if (has_failed && !is_first() && !impl_->is_dismissed) {
    const char mark = is_input_error ? input_error_mark : other_error_mark;
    impl_->send(
        0, failure_tag,
        std::make_shared<Bytes>(bytes_of(fmt::format("{}{} (on {})", mark, failure, host_name()))));
  }
  end_messages(*impl_->port, has_failed ? patience : std::numeric_limits<double>::infinity());
}

}  // namespace lightwell
