#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace lightwell {

using Bytes = std::vector<std::byte>;
using SharedBytes = std::shared_ptr<const Bytes>;

struct Message {
  int from = 0;  ///< rank of the sender
  int tag = 0;
  Bytes bytes{};
};

/// Messages between the processes of a run, whose ranks are 0 to size() - 1. Messages of one tag
/// from one process to another arrive in the order of sending. No call waits for another process,
/// except finish(). Safe to use from many threads.
class MessagePort {
 public:
  static constexpr int any_tag = -1;
  static constexpr int most_tag = 32767;  // that MPI promises

  virtual ~MessagePort() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;

  /// Sends `bytes` with `tag` in [0, most_tag] to process `to`. Throws std::runtime_error if the
  /// message is longer than 2 GB.
  virtual void send(int to, int tag, SharedBytes bytes) = 0;
  /// The next message of the tag, or of any tag; empty if none has arrived.
  virtual std::optional<Message> receive(int tag) = 0;
  /// Bytes of messages that are still being sent, at least 1 for each; 0: all have been sent.
  virtual std::int64_t unsent() = 0;

  /// Ends the messages of all processes, each of which calls this once, after its last message.
  virtual void finish() = 0;
  /// Ends all processes at once.
  [[noreturn]] virtual void abort(int code) = 0;
};

}  // namespace lightwell
