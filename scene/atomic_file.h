#pragma once

#include <filesystem>

namespace lightwell {

/// A file that appears under its name only when complete. The caller writes a temporary file in the
/// same folder, and commit() renames it. Without commit() the destructor removes the temporary
/// file. The constructor removes temporary files for the same target that processes left which were
/// killed.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The temporary file, for the caller to write.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Renames the temporary file to the target. Throws std::runtime_error naming the target if the
  /// renaming fails.
  void commit();

 private:
  std::filesystem::path target_, temporary_;
  bool committed_ = false;
};

}  // namespace lightwell
