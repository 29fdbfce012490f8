#pragma once

#include <filesystem>
#include <functional>
#include <optional>
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

/// The files that this thread opens by require_readable() while the object exists. Of nested
/// objects each has all of them.
class FilesRead {
 public:
  FilesRead();
  ~FilesRead();
  FilesRead(const FilesRead&) = delete;
  FilesRead& operator=(const FilesRead&) = delete;

  /// In the order of reading, once each.
  const std::vector<std::filesystem::path>& files() const { return files_; }
  static void add(const std::filesystem::path& path);

 private:
  FilesRead* outer_;
  std::vector<std::filesystem::path> files_{};
};

/// The extension in lower case: ".obj".
std::string lower_extension(const std::filesystem::path& path);

/// `text` without blanks at either end.
std::string_view trimmed(std::string_view text);

/// Removes the next word from `text` and returns the word; empty at the end.
std::string_view next_word(std::string_view& text);

/// Value of `text` as a finite number; empty if `text` is none.
std::optional<double> parse_finite(std::string_view text);

}  // namespace lightwell
