#include "radiosity/solution/solution_seal.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "scene/errors.h"
#include "scene/utf8.h"

namespace lightwell {
namespace {

constexpr std::string_view preamble_start = "<?lightwell-solution format=\"";
constexpr std::string_view seal_start = "<?lightwell-checksum ";
constexpr std::string_view seal_end = "?>\n";
constexpr std::size_t seal_digits = 16;
constexpr std::size_t seal_length = seal_start.size() + seal_digits + seal_end.size();

[[noreturn]] void reject(const std::filesystem::path& path, const std::string& reason) {
  throw InputError(fmt::format("cannot read the solution '{}': {}", path.string(), reason));
}

constexpr std::uint64_t checksum_of_nothing = 0xcbf29ce484222325u;

// FNV-1a of bytes that follow those of the checksum `hash`.
std::uint64_t checksum_after(std::uint64_t hash, std::string_view bytes) {
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

/// FNV-1a of the first `length` bytes; the file may turn out shorter.
std::uint64_t checksum_of_start(std::ifstream& file, std::uint64_t length) {
  std::uint64_t hash = checksum_of_nothing;
  std::vector<char> buffer(1 << 20);
  while (length > 0) {
    file.read(buffer.data(),
              static_cast<std::streamsize>(std::min<std::uint64_t>(length, 1 << 20)));
    const auto got = static_cast<std::size_t>(file.gcount());
    if (got == 0) break;
    hash = checksum_after(hash, {buffer.data(), got});
    length -= got;
  }
  return hash;
}

std::string seal_text(std::uint64_t checksum) {
  return fmt::format("{}{:016x}{}", seal_start, checksum, seal_end);
}

/// Version in the file's first line. Rejects files that are not solutions.
int read_format(const std::filesystem::path& path, std::ifstream& file) {
  std::array<char, 64> start{};
  file.read(start.data(), start.size());
  const std::string_view text(start.data(), static_cast<std::size_t>(file.gcount()));
  file.clear();
  if (text.empty()) reject(path, "the file is empty");
  if (!text.starts_with(preamble_start)) {
    if (preamble_start.starts_with(text)) reject(path, "the file ends in its first line");
    if (text.starts_with("<?xml") || text.starts_with("<VTKFile")) {
      reject(path,
             "it is a VTK file that Lightwell did not write (a copy saved by another program "
             "lacks what is needed here); use the file that 'lightwell solve' wrote");
    }
    reject(path, "it is not a Lightwell solution; 'lightwell solve SCENE -o S.vtp' makes one");
  }
  int format = 0;
  const char* first = text.data() + preamble_start.size();
  const auto parsed = std::from_chars(first, text.data() + text.size(), format);
  if (parsed.ec != std::errc{}) reject(path, "its first line names no version");
  return format;
}

}  // namespace

std::string solution_preamble(const std::string& summary) {
  std::string text;
  std::istringstream lines(summary);
  for (std::string line; std::getline(lines, line);) text += as_utf8(line) + "\n";
  // "?>" would end the processing instruction early.
  for (std::size_t at = text.find("?>"); at != std::string::npos; at = text.find("?>", at)) {
    text.replace(at, 2, "? >");
  }
  return fmt::format("{}{}\"\n{}?>\n", preamble_start, solution_format, text);
}

std::uint64_t file_checksum(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw std::runtime_error(
        fmt::format("cannot read '{}': {}", path.string(), std::strerror(errno)));
  }
  return checksum_of_start(file, std::numeric_limits<std::uint64_t>::max());
}

std::string seal_of(std::span<const std::string> pieces) {
  std::uint64_t hash = checksum_of_nothing;
  for (const std::string& piece : pieces) hash = checksum_after(hash, piece);
  return seal_text(hash);
}

void seal_solution(const std::filesystem::path& path) {
  const std::string seal = seal_text(file_checksum(path));
  std::ofstream file(path, std::ios::binary | std::ios::app);
  file << seal;
  file.close();
  if (!file) {
    throw std::runtime_error(
        fmt::format("cannot write '{}': {}", path.string(), std::strerror(errno)));
  }
}

void check_seal(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) reject(path, "there is no such file");
  if (std::filesystem::is_directory(path, error)) reject(path, "it is a folder");
  std::ifstream file(path, std::ios::binary);
  if (!file) reject(path, std::strerror(errno));

  const int format = read_format(path, file);
  if (format != solution_format) {
    reject(path, fmt::format("it has solution format {}, and this program reads format {}; solve "
                             "the scene again, or use the version of Lightwell that wrote it",
                             format, solution_format));
  }
  const auto size = static_cast<std::uint64_t>(std::filesystem::file_size(path));
  std::string seal(seal_length, '\0');
  if (size > seal_length) {
    file.seekg(static_cast<std::streamoff>(size - seal_length));
    file.read(seal.data(), static_cast<std::streamsize>(seal_length));
    file.clear();
  }
  if (!seal.starts_with(seal_start) || !seal.ends_with(seal_end)) {
    reject(path, fmt::format("it is torn: {} bytes, without the closing checksum. Copying or "
                             "writing it was cut short; copy it again or solve again",
                             size));
  }
  file.seekg(0);
  if (seal_text(checksum_of_start(file, size - seal_length)) != seal) {
    reject(path,
           "it was damaged or changed after it was written: its checksum does not fit; copy it "
           "again or solve again");
  }
}

}  // namespace lightwell
