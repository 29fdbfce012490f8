#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "radiosity/processes/message_port.h"

namespace lightwell {

/// Kinds of messages that belong to no round.
enum ControlTag {
  request_tag,  ///< to the first process: asks for a piece
  failure_tag,  ///< to the first process: why this process ends
  dismiss_tag,  ///< from the first process: the run has failed, all are to end
  ended_tag,    ///< to the first process: this process has ended, and sends nothing more
  leave_tag,    ///< from the first process: all have ended
  control_tags,
};

/// Kinds of messages of a round, a call that all processes take part in.
enum class RoundTag { piece, results, verdict };

/// Tag of a message of a round. Processes are a few rounds apart at most, so tags may come again.
constexpr int tag_of(RoundTag kind, std::int64_t round) {
  constexpr std::int64_t rounds = 4096, kinds = 3;
  static_assert(control_tags + kinds * rounds <= MessagePort::most_tag);
  return static_cast<int>(control_tags + static_cast<int>(kind) + kinds * (round % rounds));
}

/// A plain value as a message.
template <class T>
SharedBytes message_of(const T& value) {
  auto bytes = std::make_shared<Bytes>(sizeof value);
  std::memcpy(bytes->data(), &value, sizeof value);
  return bytes;
}
template <class T>
T value_of(const Bytes& bytes) {
  T value{};
  if (bytes.size() != sizeof value) {
    throw std::runtime_error("a message between processes has the wrong size; please report this");
  }
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

inline Bytes bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}
inline std::string text_of(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace lightwell
