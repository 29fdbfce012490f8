#pragma once

#include <filesystem>

namespace lightwell {

/// A file that appears under its name only when it is complete: it is written under a temporary
/// name in the same folder and renamed by commit(). Without commit() the temporary is removed.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Throws std::runtime_error naming the target if it cannot take its name.
  void commit();

 private:
  std::filesystem::path target_, temporary_;
  bool committed_ = false;
};

}  // namespace lightwell
