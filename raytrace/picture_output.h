#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "raytrace/image.h"
#include "scene/atomic_file.h"

namespace lightwell {

/// Throws std::runtime_error with the file's name and the reason.
[[noreturn]] void fail_write(const std::filesystem::path& path, const std::string& why);

/// Output file of a picture. The file has a temporary name until finish() renames it, and is
/// removed without finish().
class PictureOutput {
 public:
  /// Throws as fail_write if the file cannot be created.
  explicit PictureOutput(const std::filesystem::path& path);
  std::ofstream& stream() { return stream_; }
  /// Closes and renames the file. Throws as fail_write if a write failed.
  void finish();

 private:
  std::filesystem::path path_;
  AtomicFile file_;
  std::ofstream stream_;
};

/// Returns an attribute as text: numbers with 9 significant digits, vectors as three numbers.
std::string to_text(const ImageAttribute& value);

}  // namespace lightwell
