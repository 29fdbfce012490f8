#include "scene/atomic_file.h"

#include <fcntl.h>
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

// Waits until the content of a file, or the names in a folder, are on the disk. Returns errno.
int wait_for_disk(const fs::path& path, int flags) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | flags);
  if (file < 0) return errno;
  int error = 0;
  while ((error = ::fsync(file) == 0 ? 0 : errno) == EINTR) {
  }
  ::close(file);
  return error;
}

[[noreturn]] void fail(const fs::path& target, int error) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", target.string(),
                                       std::generic_category().message(error)));
}

}  // namespace

std::filesystem::path written_file(const std::filesystem::path& path) {
  constexpr int most_links = 40;  // as Linux follows
  fs::path file = path;
  for (int links = 0; links < most_links; ++links) {
    std::error_code error;
    const fs::path next = fs::read_symlink(file, error);
    if (error) return file;  // no link
    file = file.parent_path() / next;
  }
  return path;
}

AtomicFile::AtomicFile(const std::filesystem::path& target)
    : target_(written_file(target)), temporary_(target_) {
  remove_leftovers(target_);
  // The process number keeps two programs that write the same file from sharing a temporary.
  temporary_ += fmt::format(".{}.part", ::getpid());
}

AtomicFile::~AtomicFile() {
  if (committed_) return;
  std::error_code ignored;  // a temporary that never existed is no error
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  // EINVAL: the file system has nothing to wait for.
  const int unwritten = wait_for_disk(temporary_, 0);
  if (unwritten != 0 && unwritten != EINVAL) fail(target_, unwritten);
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("{}: cannot be replaced: {}", target_.string(), error.message()));
  }
  committed_ = true;
  // Some file systems cannot wait for names; the file is whole under either name there, too.
  wait_for_disk(target_.has_parent_path() ? target_.parent_path() : fs::path("."), O_DIRECTORY);
}

AtomicStream::AtomicStream(const fs::path& target)
    : target_(target), file_(target), stream_(&buffer_) {
  errno = 0;
  if (!buffer_.open(file_.temporary(), std::ios::out | std::ios::binary | std::ios::trunc)) {
    fail(target, errno != 0 ? errno : EIO);
  }
}

std::string AtomicStream::failure() const {
  return std::generic_category().message(buffer_.error() != 0 ? buffer_.error() : EIO);
}

void AtomicStream::close() {
  if (buffer_.is_open() && !buffer_.close()) stream_.setstate(std::ios::failbit);
  if (!stream_ || buffer_.error() != 0) fail(target_, buffer_.error() != 0 ? buffer_.error() : EIO);
}

void AtomicStream::commit() {
  close();
  file_.commit();
}

void AtomicStream::Buffer::note_error() {
  if (error_ == 0) error_ = errno != 0 ? errno : EIO;
}

AtomicStream::Buffer::int_type AtomicStream::Buffer::overflow(int_type c) {
  errno = 0;
  const int_type written = std::filebuf::overflow(c);
  if (traits_type::eq_int_type(written, traits_type::eof())) note_error();
  return written;
}

std::streamsize AtomicStream::Buffer::xsputn(const char* text, std::streamsize size) {
  errno = 0;
  const std::streamsize written = std::filebuf::xsputn(text, size);
  if (written < size) note_error();
  return written;
}

int AtomicStream::Buffer::sync() {
  errno = 0;
  const int result = std::filebuf::sync();
  if (result != 0) note_error();
  return result;
}

}  // namespace lightwell
