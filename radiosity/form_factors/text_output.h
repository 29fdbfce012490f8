#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <utility>

#include "scene/atomic_file.h"

namespace lightwell {

/// Text output in large pieces, to a temporary file that commit() renames. Throws
/// std::runtime_error naming the file and the system's reason if writing fails.
class TextOutput {
 public:
  explicit TextOutput(const std::filesystem::path& target) : file_(target) {}
  template <typename... T>
  void add(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(buffer_), format, std::forward<T>(values)...);
    constexpr std::size_t piece = 1 << 20;
    if (buffer_.size() >= piece) flush();
  }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  void flush() {
    file_.stream().write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    buffer_.clear();
    if (!file_.stream()) file_.close();  // throws with the reason, before more rows are made
  }

  AtomicStream file_;
  fmt::memory_buffer buffer_;
};

}  // namespace lightwell
