#include "radiosity/journal/journal_format.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>

#include "scene/errors.h"

namespace lightwell {
namespace {

// Values by option in text such as "--rays 512 --discontinuity".
std::map<std::string, std::string> by_option(const std::string& text) {
  std::map<std::string, std::string> options;
  std::istringstream words(text);
  std::string option;
  for (std::string word; words >> word;) {
    if (word.starts_with("--")) {
      option = word;
      options[option];
    } else {
      std::string& value = options[option];
      value += (value.empty() ? "" : " ") + word;
    }
  }
  return options;
}

std::string option_text(const std::map<std::string, std::string>& options,
                        const std::string& option) {
  const auto at = options.find(option);
  if (at == options.end()) return "no " + option;
  return at->second.empty() ? option : option + " " + at->second;
}

std::vector<std::string> differences(const std::string& then, const std::string& now) {
  const auto before = by_option(then), after = by_option(now);
  auto all = before;
  all.insert(after.begin(), after.end());
  std::vector<std::string> found;
  for (const auto& [option, value] : all) {
    const std::string a = option_text(before, option), b = option_text(after, option);
    if (a != b) found.push_back(fmt::format("{}, now it is {}", a, b));
  }
  return found;
}

}  // namespace

void reject_journal(const std::filesystem::path& path, const std::string& reason) {
  throw InputError(fmt::format("the checkpoint '{}' {}", path.string(), reason));
}

std::string journal_checksum_line(std::string_view lines) {
  Fingerprint print;
  print.add(lines);
  return fmt::format("checksum: {:016x}\n", print.value());
}

RecordChecksum::RecordChecksum(const RecordHead& head) {
  print_.add(head.magic);
  print_.add(head.kind);
  print_.add(head.phase);
  print_.add(head.block);
  print_.add(head.size);
}

void RecordChecksum::add_in_pieces(std::span<const std::byte> bytes) {
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    add(bytes.subspan(at, std::min(piece, bytes.size() - at)));
  }
}

std::vector<std::byte> journal_record(RecordHead head, std::span<const std::byte> bytes) {
  RecordChecksum checksum(head);
  if (head.kind != RecordKind::slots) checksum.add_in_pieces(bytes);
  head.checksum = checksum.value();
  std::vector<std::byte> record(sizeof head + bytes.size());
  std::memcpy(record.data(), &head, sizeof head);
  if (!bytes.empty()) std::memcpy(record.data() + sizeof head, bytes.data(), bytes.size());
  return record;
}

std::uint64_t state_checksum(const StateHead& head, std::span<const std::byte> bytes) {
  Fingerprint print;
  print.add(head.number);
  print.add(head.size);
  print.add_bytes(bytes);
  return print.value();
}

std::string journal_header(const Provenance& of) {
  // File names may contain line breaks.
  const auto one_line = [](std::string text) {
    for (char& c : text) {
      if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    }
    return text;
  };
  const std::string lines =
      fmt::format("{}{}\nversion: {}\nscene: {}\nhash: {:016x}\noptions: {}\n", journal_first_words,
                  journal_format, one_line(of.version), one_line(of.scene_file), of.scene_hash,
                  one_line(of.options));
  return lines + journal_checksum_line(lines);
}

void check_journal_of(const std::filesystem::path& path, const Provenance& found,
                      const Provenance& wanted) {
  if (found.version != wanted.version) {
    reject_journal(
        path, fmt::format("was made by version {}, and this is version {}, which may compute other "
                          "digits; go on with that version, or remove it to start again",
                          found.version, wanted.version));
  }
  if (found.scene_hash != wanted.scene_hash) {
    reject_journal(
        path,
        fmt::format("is of another scene: of '{}' (hash {:016x}), while '{}' has hash "
                    "{:016x}. Give the scene as it was, or remove it to start again",
                    found.scene_file, found.scene_hash, wanted.scene_file, wanted.scene_hash));
  }
  if (const auto differing = differences(found.options, wanted.options); !differing.empty()) {
    reject_journal(path,
                   fmt::format("was made with other options: with {}. Give the options as they "
                               "were, or remove it to start again",
                               fmt::join(differing, "; with ")));
  }
}

}  // namespace lightwell
