#include "scene/io/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "scene/errors.h"

namespace lightwell {
namespace {

constexpr std::string_view line_blanks = " \t\r\f\v";

thread_local FilesRead* innermost = nullptr;

}  // namespace

FilesRead::FilesRead() : outer_(innermost) {
  innermost = this;
}

FilesRead::FilesRead(const std::filesystem::path& scene) : outer_(innermost), scene_(scene) {
  const std::filesystem::path folder = scene.has_parent_path() ? scene.parent_path() : ".";
  std::error_code error;
  folder_ = std::filesystem::canonical(folder, error);
  if (error) folder_ = std::filesystem::absolute(folder);  // there is no such scene
  innermost = this;
}

FilesRead::~FilesRead() {
  innermost = outer_;
}

void FilesRead::add(const std::filesystem::path& path) {
  for (FilesRead* list = innermost; list; list = list->outer_) {
    if (!list->known_.insert(path).second) continue;
    list->files_.push_back(path);
    std::error_code error;
    const auto bytes = std::filesystem::file_size(path, error);
    if (!error) list->bytes_ += static_cast<std::int64_t>(bytes);
  }
}

void FilesRead::refuse_outside(const std::filesystem::path& path) {
  for (const FilesRead* list = innermost; list; list = list->outer_) {
    if (list->folder_.empty() || path == list->scene_) continue;
    std::error_code error;
    const auto at = std::filesystem::weakly_canonical(std::filesystem::absolute(path), error);
    const auto [end, other] = std::ranges::mismatch(list->folder_, at);
    if (!error && end == list->folder_.end()) continue;
    throw LimitError(fmt::format(
        "{}: the scene names this file, which is outside of its folder '{}', and --inside-folder "
        "refuses that; copy the file into the folder, or leave out --inside-folder",
        path.string(), list->folder_.string()));
  }
}

std::int64_t FilesRead::bytes() {
  std::int64_t bytes = 0;
  for (const FilesRead* list = innermost; list; list = list->outer_) bytes = list->bytes_;
  return bytes;
}

bool is_file(const std::filesystem::path& path) {
  FilesRead::refuse_outside(path);
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

std::string excerpt(std::string_view word) {
  constexpr std::size_t longest = 40;
  return word.size() <= longest ? std::string(word)
                                : std::string(word.substr(0, longest)).append("...");
}

void require_readable(const std::filesystem::path& path) {
  FilesRead::refuse_outside(path);
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(
        fmt::format("{}: there is no such file; check the name and the folder", path.string()));
  }
  if (std::filesystem::is_directory(status)) {
    throw InputError(fmt::format("{}: this is a folder; name a file in it", path.string()));
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(fmt::format("{}: this is not a regular file", path.string()));
  }
  if (!std::ifstream(path, std::ios::binary)) {
    throw InputError(
        fmt::format("{}: the file cannot be opened; check its permissions", path.string()));
  }
  FilesRead::add(path);
}

TextFile::TextFile(const std::filesystem::path& path) : path_(path) {
  require_readable(path);
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream content;
  if (std::filesystem::file_size(path) > 0) content << stream.rdbuf();
  if (!stream || !content) {
    throw InputError(fmt::format("{}: the file could not be read to its end", path.string()));
  }
  text_ = std::move(content).str();
}

void TextFile::for_each_line(
    const std::function<void(int line, std::string_view text)>& visit) const {
  std::string_view rest = text_;
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
  if (rest.starts_with("\xff\xfe") || rest.starts_with("\xfe\xff")) {
    throw InputError(fmt::format("{}: the text is UTF-16; save the file as UTF-8", path_.string()));
  }
  // Systems of before 2001 end lines with a carriage return alone.
  const char line_end = rest.find('\n') == std::string_view::npos ? '\r' : '\n';
  for (int line = 1; !rest.empty(); ++line) {
    const std::size_t end = rest.find(line_end);
    std::string_view text = rest.substr(0, end);
    if (text.ends_with('\r')) text.remove_suffix(1);
    visit(line, text);
    if (end == std::string_view::npos) return;
    rest.remove_prefix(end + 1);
  }
}

void TextFile::fail(int line, std::string_view problem) const {
  throw InputError(fmt::format("{}:{}: {}", path_.string(), line, problem));
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string lower_extension(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(line_blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(line_blanks) - first + 1);
}

std::string_view next_word(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, text.find_first_of(line_blanks));
  text.remove_prefix(word.size());
  return word;
}

std::optional<double> parse_finite(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

}  // namespace lightwell
