#pragma once

#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>

namespace lightwell {

/// The file that is written under the name `path`: where `path` is a symbolic link, that to which
/// the link leads, which need not exist.
std::filesystem::path written_file(const std::filesystem::path& path);

/// A file that appears under its name only when complete. The caller writes a temporary file in the
/// same folder, and commit() renames it. Symbolic links stay (see written_file()). Without commit()
/// the destructor removes the temporary file. The constructor removes temporary files for the same
/// target that processes left which were killed.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The temporary file, for the caller to write.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Renames the temporary file to the target once its content is on the disk, so that the target
  /// is whole after a power cut, too. Throws std::runtime_error with the target and the reason.
  void commit();

 private:
  std::filesystem::path target_, temporary_;
  bool committed_ = false;
};

/// An AtomicFile with a stream that remembers why a write failed. std::ofstream forgets the reason.
class AtomicStream {
 public:
  /// Throws std::runtime_error with the target and the reason if the file cannot be made.
  explicit AtomicStream(const std::filesystem::path& target);
  std::ostream& stream() { return stream_; }
  /// Reason of the first write that failed.
  std::string failure() const;
  /// Throws std::runtime_error with the target and the reason if a write has failed.
  void close();
  /// close(), and AtomicFile::commit().
  void commit();

 private:
  class Buffer : public std::filebuf {
   public:
    int error() const { return error_; }

   protected:
    int_type overflow(int_type c) override;
    std::streamsize xsputn(const char* text, std::streamsize size) override;
    int sync() override;

   private:
    void note_error();
    int error_ = 0;  // errno of the first failure
  };

  std::filesystem::path target_;
  AtomicFile file_;
  Buffer buffer_;
  std::ostream stream_;
};

}  // namespace lightwell
