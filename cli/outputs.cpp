#include "cli/outputs.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "scene/atomic_file.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), why));
}

// The files of the command that this process runs.
struct CommandFiles {
  std::vector<fs::path> inputs{}, outputs{};
};

CommandFiles& command_files() {
  static CommandFiles files;
  return files;
}

void refuse_same(const fs::path& output, const fs::path& input) {
  std::error_code error;  // of files that do not exist, which are not the same
  if (!fs::equivalent(output, input, error) || error) return;
  refuse(output, fmt::format("the command reads the same file{}; name another output",
                             output == input ? "" : fmt::format(" as '{}'", input.string())));
}

}  // namespace

void note_input(const fs::path& file) {
  command_files().inputs.push_back(file);
  for (const fs::path& output : command_files().outputs) refuse_same(output, file);
}

void require_writable(const fs::path& file) {
  command_files().outputs.push_back(file);
  for (const fs::path& input : command_files().inputs) refuse_same(file, input);
  std::error_code error;
  const fs::path written = written_file(file);
  const fs::path folder = written.has_parent_path() ? written.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) {
    refuse(file, fmt::format("there is no folder '{}'; make it first", folder.string()));
  }
  const fs::file_status status = fs::status(file, error);
  if (fs::is_directory(status)) refuse(file, "it is a folder");
  // Results are written beside `file` and renamed, which would replace a device by a plain file.
  if (fs::exists(status) && !fs::is_regular_file(status)) refuse(file, "it is not a plain file");

  // The trial has the name of a part, so that what a kill leaves of the trial goes like a part.
  const AtomicFile trial(file);
  const int descriptor =
      ::open(trial.temporary().c_str(), O_CREAT | O_WRONLY | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (descriptor < 0) refuse(file, std::generic_category().message(errno));
  ::close(descriptor);
}

void require_different(const std::vector<fs::path>& files) {
  std::vector<fs::path> seen;
  for (const fs::path& file : files) {
    if (file.empty()) continue;
    const fs::path whole = fs::weakly_canonical(fs::absolute(file));
    if (std::ranges::count(seen, whole) > 0) {
      refuse(file, "the command writes another result into the same file; name another output");
    }
    seen.push_back(whole);
  }
}

OutputFolder::OutputFolder(const fs::path& folder) : folder_(folder) {
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path p = fs::absolute(folder).lexically_normal();
       !p.empty() && !fs::exists(p, error) && p != p.parent_path(); p = p.parent_path()) {
    if (p.has_filename()) missing.push_back(p);
  }
  for (auto p = missing.rbegin(); p != missing.rend(); ++p) {
    if (!fs::create_directory(*p, error) && error) {
      const std::string why = error.message();
      for (auto made = made_.rbegin(); made != made_.rend(); ++made) fs::remove(*made, error);
      throw std::runtime_error(
          fmt::format("{}: the folder cannot be made: {}", folder.string(), why));
    }
    made_.push_back(*p);
  }
  if (!fs::is_directory(folder, error)) {
    throw std::runtime_error(
        fmt::format("{}: the folder cannot be used: it is a file", folder.string()));
  }
}

OutputFolder::~OutputFolder() {
  std::error_code not_empty;  // a folder with results stays
  for (auto p = made_.rbegin(); p != made_.rend(); ++p) fs::remove(*p, not_empty);
}

}  // namespace lightwell
