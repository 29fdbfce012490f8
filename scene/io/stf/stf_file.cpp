#include "scene/io/stf/stf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/utf8.h"

namespace lightwell {
namespace {

// Names of sections without blanks: some programs write them with blanks in one place and without
// in another.
std::string section_key(std::string_view name) {
  std::string key = lower_case(name);
  std::erase(key, ' ');
  return key;
}

// A line as UTF-8, with a remark where the line is taken as Latin-1.
std::string decoded(int number, std::string_view line, Remarks& remarks) {
  std::string text = as_utf8(line);
  if (text.size() > line.size()) {
    remarks.mention("Text that is not UTF-8 was read as Latin-1", fmt::format("line {}", number));
  }
  return text;
}

void require_text(const TextFile& file) {
  if (file.text().find('\0') == std::string::npos) return;
  file.fail(1,
            "the file is not text of 8-bit characters; save it as UTF-8, not as UTF-16, which "
            "some editors call Unicode");
}

}  // namespace

void StfSection::add(std::string_view key, std::string_view value, int line) {
  const Entry entry{.key = std::string(key), .value = std::string(value), .line = line};
  if (entries_.emplace(lower_case(key), entry).second) return;
  remarks_->add("Keys that repeat an earlier one were left out",
                fmt::format("[{}] {}", name_, key));
}

bool StfSection::has(std::string_view key) const {
  return entries_.contains(lower_case(key));
}

std::string StfSection::text(std::string_view key) {
  const auto found = entries_.find(lower_case(key));
  if (found == entries_.end()) return {};
  found->second.is_read = true;
  return found->second.value;
}

double StfSection::parsed(std::string_view key, std::string_view word) const {
  if (const auto value = parse_finite(word)) return *value;
  std::string with_point(word);
  std::ranges::replace(with_point, ',', '.');
  const auto value = parse_finite(with_point);
  if (!value) {
    fail(key, fmt::format("has '{}', which is not a finite number; write numbers alone: lengths in "
                          "metres, angles in degrees, flux in lumens, power in watts",
                          excerpt(word)));
  }
  remarks_->mention("Commas in numbers were read as decimal points", fmt::format("[{}]", name_));
  return *value;
}

std::optional<double> StfSection::number(std::string_view key) {
  const std::string value = text(key);
  if (value.empty()) return std::nullopt;
  return parsed(key, value);
}

std::vector<double> StfSection::numbers(std::string_view key, std::size_t least) {
  const std::string value = text(key);
  std::vector<double> result;
  std::string_view rest = value;
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    result.push_back(parsed(key, word));
  }
  if (result.size() < least) {
    fail(key, fmt::format("has {} numbers; {} are needed, with blanks between them", result.size(),
                          least));
  }
  return result;
}

Eigen::Vector3d StfSection::vector_or(std::string_view key, const Eigen::Vector3d& usual) {
  if (text(key).empty()) return usual;
  std::vector<double> values = numbers(key, 2);
  values.resize(3, 0.0);
  return {values[0], values[1], values[2]};
}

double StfSection::positive(std::string_view key) {
  const auto value = number(key);
  if (!value) fail(fmt::format("lacks the key '{}'; add it, with a number above 0", key));
  if (!(*value > 0.0)) fail(key, fmt::format("is {:g}; it must be above 0", *value));
  return *value;
}

std::size_t StfSection::count(std::string_view key) {
  const auto value = number(key);
  if (!value) return 0;
  constexpr double most = 1e15;  // whole numbers are exact
  if (!(*value >= 0.0 && *value <= most) || *value != std::floor(*value)) {
    fail(key, fmt::format("is {:g}; a whole number is needed, 0 or more", *value));
  }
  return static_cast<std::size_t>(*value);
}

std::size_t StfSection::counted(std::string_view prefix, std::string_view count_key) {
  std::size_t said = 0, found = 0;
  remarks_->attempt("Counts that cannot be used were taken as 0", fmt::format("[{}]", name_),
                    [&] { said = count(count_key); });
  while (found < said && has(fmt::format("{}{}", prefix, found + 1))) ++found;
  if (found < said) {
    remarks_->add("Entries that are counted but not described are missing",
                  fmt::format("[{}] {}={}, of which {} described", name_, count_key, said,
                              found == 1 ? "1 is" : fmt::format("{} are", found)));
  }
  return found;
}

void StfSection::remark_unread(const std::set<std::string_view>& known) const {
  for (const auto& [key, entry] : entries_) {
    if (entry.is_read || known.contains(key)) continue;
    remarks_->add("Keys that are not understood were left out",
                  fmt::format("[{}] {}", name_, entry.key));
  }
}

void StfSection::fail(std::string_view key, std::string_view problem) const {
  const auto found = entries_.find(lower_case(key));
  file_->fail(found == entries_.end() ? line_ : found->second.line,
              fmt::format("{} of [{}] {}", key, name_, problem));
}

void StfSection::fail(std::string_view problem) const {
  file_->fail(line_, fmt::format("[{}] {}", name_, problem));
}

void StfSection::fail_limit(std::string_view problem) const {
  throw LimitError(fmt::format("{}:{}: [{}] {}", file_->path().string(), line_, name_, problem));
}

StfFile::StfFile(const TextFile& file, Remarks& remarks) : file_(&file), remarks_(&remarks) {
  require_text(file);
  StfSection* section = nullptr;
  bool is_repeated = false;
  file.for_each_line([&](int number, std::string_view line) {
    const std::string decoded_line = decoded(number, line, remarks);
    const std::string_view text = trimmed(decoded_line);
    if (text.empty()) return;
    if (text.front() == '[' && text.back() == ']') {
      const std::string name(trimmed(text.substr(1, text.size() - 2)));
      const auto [at, is_new] =
          sections_.try_emplace(section_key(name), Known{{file, remarks, name, number}});
      is_repeated = !is_new;
      if (is_repeated) remarks.mention("Sections that repeat an earlier one were left out", name);
      section = &at->second.section;
      return;
    }
    const std::size_t equal = text.find('=');
    if (equal == std::string_view::npos || !section) {
      remarks.add("Lines that are neither a section nor a key in one were left out",
                  fmt::format("line {}", number));
    } else if (!is_repeated) {
      section->add(trimmed(text.substr(0, equal)), trimmed(text.substr(equal + 1)), number);
    }
  });
  if (!find("PROJECT")) {
    file.fail(1,
              "there is no section [PROJECT]; a file of DIALux's exchange format STF has one, with "
              "the number of its rooms as NrRooms");
  }
}

StfSection* StfFile::find(std::string_view name) {
  const auto found = sections_.find(section_key(name));
  if (found == sections_.end()) return nullptr;
  found->second.is_read = true;
  return &found->second.section;
}

void StfFile::remark_unread() const {
  for (const auto& [key, known] : sections_) {
    if (known.is_read || key == "version") continue;
    remarks_->mention("Sections that no room refers to were passed over", known.section.name());
  }
}

}  // namespace lightwell
