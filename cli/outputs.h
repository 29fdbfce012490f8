#pragma once

#include <filesystem>
#include <vector>

namespace lightwell {

/// Throws std::runtime_error, saying why, unless the file could be created or replaced now. Asked
/// before the long work whose result it is to hold.
void require_writable(const std::filesystem::path& file);

/// A folder for results: made if it is missing, and removed again if nothing has come into it.
class OutputFolder {
 public:
  /// Throws std::runtime_error, saying why, if it cannot be made.
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
