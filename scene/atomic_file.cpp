#include "scene/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>
#include <system_error>

namespace lightwell {

AtomicFile::AtomicFile(const std::filesystem::path& target) : target_(target), temporary_(target) {
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
