#include "scene/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace lightwell {

namespace {

namespace fs = std::filesystem;

// The process that writes NAME.PID.part for the file `name`; 0: that is no such file.
pid_t writer_of(const std::string& file, const std::string& name) {
  constexpr std::string_view end = ".part";
  if (!file.starts_with(name + ".") || !file.ends_with(end)) return 0;
  const char* const first = file.data() + name.size() + 1;
  const char* const last = file.data() + file.size() - end.size();
  pid_t process = 0;
  const auto parsed = std::from_chars(first, last, process);
  return parsed.ec == std::errc() && parsed.ptr == last && process > 0 ? process : 0;
}

// Removes what killed processes left. A process of another machine that writes into the same folder
// is unknown here, so recent files stay.
void remove_leftovers(const fs::path& target) {
  constexpr std::chrono::minutes recent{10};
  std::error_code error;
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const pid_t writer = writer_of(at->path().filename().string(), target.filename().string());
    const bool is_running = writer > 0 && (::kill(writer, 0) == 0 || errno != ESRCH);
    if (writer == 0 || is_running) continue;
    std::error_code ignored;
    const auto written = fs::last_write_time(at->path(), ignored);
    if (ignored || fs::file_time_type::clock::now() - written < recent) continue;
    fs::remove(at->path(), ignored);
  }
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& target) : target_(target), temporary_(target) {
  remove_leftovers(target);
  // The process number keeps two programs that write the same file from sharing a temporary.
  temporary_ += fmt::format(".{}.part", ::getpid());
}

AtomicFile::~AtomicFile() {
  if (committed_) return;
  std::error_code ignored;  // a temporary that never existed is no error
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("{}: cannot be replaced: {}", target_.string(), error.message()));
  }
  committed_ = true;
}

}  // namespace lightwell
