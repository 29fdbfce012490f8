#pragma once

#include <filesystem>
#include <vector>

namespace lightwell {

/// Throws std::runtime_error with the reason if `file` can be neither created nor replaced, or is a
/// file that note_input() named. To be called before the long work whose result goes into `file`.
void require_writable(const std::filesystem::path& file);

/// Throws std::runtime_error if two of a command's outputs, of which empty ones are none, are the
/// same file.
void require_different(const std::vector<std::filesystem::path>& files);

/// Names a file that the command reads. Throws std::runtime_error if require_writable() named the
/// same file, by whatever name, as an output: results never replace what they were made from.
void note_input(const std::filesystem::path& file);

/// A folder for results: the constructor makes missing folders of its path, the destructor removes
/// those of them that are empty.
class OutputFolder {
 public:
  /// Throws std::runtime_error with the reason if the folder cannot be made.
  explicit OutputFolder(const std::filesystem::path& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  std::filesystem::path operator/(const std::filesystem::path& name) const {
    return folder_ / name;
  }

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> made_{};  // innermost last
};

}  // namespace lightwell
