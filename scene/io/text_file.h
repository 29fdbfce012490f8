#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace lightwell {

/// An input file, whole in memory. Lines end in LF or CRLF and are numbered from 1.
class TextFile {
 public:
  /// Throws InputError naming the file if it is missing, no regular file, or unreadable.
  explicit TextFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const std::string& text() const { return text_; }
  /// Visits every line. The views point into text() and live as long as the TextFile.
  void for_each_line(const std::function<void(int line, std::string_view text)>& visit) const;
  /// Throws InputError "file:line: problem".
  [[noreturn]] void fail(int line, std::string_view problem) const;

 private:
  std::filesystem::path path_;
  std::string text_;
};

/// Throws InputError naming the file unless `path` is a readable regular file.
void require_readable(const std::filesystem::path& path);

/// True if `path` is a regular file. Every look at a file that a scene names passes here or through
/// require_readable(). Throws LimitError for files that FilesRead refuses.
bool is_file(const std::filesystem::path& path);

/// The beginning of a word of a file, short enough for a message.
std::string excerpt(std::string_view word);

/// The files that this thread opens by require_readable() while the object exists. Of nested
/// objects each has all of them.
class FilesRead {
 public:
  FilesRead();
  /// Refuses, as long as the object exists, all files outside of the folder of `scene` but `scene`
  /// itself. Symbolic links are followed before the comparison.
  static FilesRead inside_folder_of(const std::filesystem::path& scene) { return FilesRead(scene); }
  ~FilesRead();
  FilesRead(const FilesRead&) = delete;
  FilesRead& operator=(const FilesRead&) = delete;

  /// Files in the order of reading, once each.
  const std::vector<std::filesystem::path>& files() const { return files_; }
  static void add(const std::filesystem::path& path);
  /// Throws LimitError for a file that an object of this thread refuses.
  static void refuse_outside(const std::filesystem::path& path);
  /// Bytes of all files that the outermost object of this thread lists; 0 without one.
  static std::int64_t bytes();

 private:
  explicit FilesRead(const std::filesystem::path& scene);

  FilesRead* outer_;
  std::filesystem::path scene_{}, folder_{};  // of a scene that may name files in its folder only
  std::vector<std::filesystem::path> files_{};
  std::set<std::filesystem::path> known_{};
  std::int64_t bytes_ = 0;
};

/// `text` with its capitals A to Z in lower case.
std::string lower_case(std::string_view text);

/// The extension in lower case: ".obj".
std::string lower_extension(const std::filesystem::path& path);

/// `text` without blanks at either end.
std::string_view trimmed(std::string_view text);

/// Removes the next word from `text` and returns the word; empty at the end.
std::string_view next_word(std::string_view& text);

/// Value of `text` as a finite number; empty if `text` is none.
std::optional<double> parse_finite(std::string_view text);

}  // namespace lightwell
