#include "scene/io/xml_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>

#include "scene/errors.h"
#include "scene/utf8.h"

namespace lightwell {
namespace {

constexpr std::string_view xml_space = " \t\r\n";
constexpr std::uintmax_t largest_xml = std::uintmax_t{32} << 20;  // bytes

TextFile text_within_limit(const std::filesystem::path& path, std::string_view kind) {
  require_readable(path);
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (!error && bytes > largest_xml) {
    throw LimitError(
        fmt::format("{}: the file has {} bytes, and {} of more than {} bytes are not read; leave "
                    "out parts of it",
                    path.string(), bytes, kind, largest_xml));
  }
  return TextFile(path);
}

}  // namespace

XmlFile::XmlFile(const std::filesystem::path& path, std::string_view kind)
    : file_(text_within_limit(path, kind)) {
  const std::string& text = file_.text();
  const pugi::xml_parse_result parsed = document_.load_buffer(text.data(), text.size());
  if (!parsed) {
    file_.fail(line_at(parsed.offset),
               fmt::format("this is not XML ({}); {} are", parsed.description(), kind));
  }
}

int XmlFile::line_at(std::ptrdiff_t offset) const {
  const std::string& text = file_.text();
  const auto end = text.begin() + std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(text));
  return 1 + static_cast<int>(std::count(text.begin(), end, '\n'));
}

void XmlFile::fail(const pugi::xml_node& element, std::string_view problem) const {
  file_.fail(line_of(element), problem);
}

double XmlFile::number(const pugi::xml_node& element, std::string_view what,
                       std::string_view text) const {
  if (const auto value = parse_finite(without_xml_space(text))) return *value;
  fail(element, fmt::format("the {} '{}' is not a finite number", what, as_utf8(excerpt(text))));
}

std::string_view without_xml_space(std::string_view text) {
  const std::size_t first = text.find_first_not_of(xml_space);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(xml_space) - first + 1);
}

void append_sample(const XmlFile& file, const pugi::xml_node& element, double nm, double value,
                   SpectrumSamples& samples) {
  if (!samples.wavelengths_nm.empty() && !(nm > samples.wavelengths_nm.back())) {
    file.fail(element, fmt::format("wavelength {} nm follows {} nm; wavelengths must rise", nm,
                                   samples.wavelengths_nm.back()));
  }
  samples.wavelengths_nm.push_back(nm);
  samples.values.push_back(value);
}

std::string xml_root_name(const std::filesystem::path& path) {
  constexpr std::size_t looked_at = std::size_t{64} << 10;
  if (!is_file(path)) return {};
  std::string head(looked_at, '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  // UTF-16 becomes the bytes of the ASCII characters that stand before a name and in it.
  if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff")) {
    head.erase(0, 2);
    std::erase(head, '\0');
  }
  std::string_view rest = head;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);
  const auto skip_past = [&rest](std::string_view end) {
    const std::size_t at = rest.find(end);
    rest.remove_prefix(at == std::string_view::npos ? rest.size() : at + end.size());
  };
  while (true) {
    rest.remove_prefix(std::min(rest.find_first_not_of(xml_space), rest.size()));
    if (rest.starts_with("<!--")) {
      skip_past("-->");
    } else if (rest.starts_with("<?")) {
      skip_past("?>");
    } else if (rest.starts_with("<!")) {
      skip_past(">");
    } else {
      break;
    }
  }
  if (!rest.starts_with('<')) return {};
  rest.remove_prefix(1);
  return std::string(rest.substr(0, rest.find_first_of(" \t\r\n/>")));
}

}  // namespace lightwell
