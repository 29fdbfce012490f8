#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "raytrace/image.h"
#include "scene/atomic_file.h"

namespace lightwell {

/// Throws std::runtime_error that names the file.
[[noreturn]] void fail_write(const std::filesystem::path& path, const std::string& why);

/// A picture's file on its way: written under a temporary name, which is removed unless finish()
/// gave it its own.
class PictureOutput {
 public:
  /// Throws as fail_write if it cannot be made.
  explicit PictureOutput(const std::filesystem::path& path);
  std::ofstream& stream() { return stream_; }
  /// Throws as fail_write if not everything has been written.
  void finish();

 private:
  std::filesystem::path path_;
  AtomicFile file_;
  std::ofstream stream_;
};

/// An attribute as people read it.
std::string to_text(const ImageAttribute& value);

}  // namespace lightwell
