// Changes of checkpoints that keep the checksums of the header, of records and of states.
#include <algorithm>
#include <span>
#include <vector>

#include "radiosity/journal/journal_format.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/target.h"

namespace lightwell::fuzz {
namespace {

struct Record {
  RecordHead head{};
  std::string bytes{};
};

// A checkpoint in its parts.
struct JournalParts {
  std::string header{};  // without its checksum
  std::vector<Record> records{};
  std::string rest{};  // what is no record
};

JournalParts journal_parts(const std::string& file) {
  const std::size_t seal = std::min(file.find("checksum: "), file.size());
  JournalParts parts{.header = file.substr(0, seal)};
  std::size_t at = std::min(file.find('\n', seal), file.size() - 1) + 1;
  while (at + sizeof(RecordHead) <= file.size()) {
    const auto head = number_at<RecordHead>(file, at);
    const std::size_t begin = at + sizeof head;
    if (head.magic != RecordHead::right_magic || head.size > file.size() - begin) break;
    parts.records.push_back({head, file.substr(begin, head.size)});
    at = begin + head.size;
  }
  parts.rest = file.substr(at);
  return parts;
}

std::span<const std::byte> as_bytes(std::string_view text) {
  return std::as_bytes(std::span(text));
}

std::string journal_file(const JournalParts& parts) {
  std::string file = parts.header + journal_checksum_line(parts.header);
  for (const Record& record : parts.records) {
    const auto bytes = journal_record(record.head, as_bytes(record.bytes));
    file.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  return file + parts.rest;
}

// Changes a field of the head. A size that is not the number of bytes is left to the file.
void mutate_head(RecordHead& head, const ByteMutator& mutate_bytes, Choice& choice) {
  constexpr std::uint32_t kinds = 6;  // four are known
  const auto mutated = [&](auto number) {
    std::string bytes = mutate_bytes(bytes_of(number), sizeof number);
    bytes.resize(sizeof number, '\0');
    return number_at<decltype(number)>(bytes, 0);
  };
  switch (choice.below(4)) {
    case 0:
      head.kind = static_cast<RecordKind>(choice.below(kinds));
      break;
    case 1:
      head.phase = choice.is_one_of(2) ? mutated(head.phase) : head.phase + 1 - head.phase % 2 * 2;
      break;
    case 2:
      head.block = choice.is_one_of(2) ? mutated(head.block) : head.block + 1;
      break;
    default:
      head.size = mutated(head.size);
  }
}

// Gives the states in both halves of a record of slots their checksums, where their sizes fit.
void repair_states(std::string& slots) {
  const std::size_t half = slots.size() / 2;
  for (std::size_t at : {std::size_t{0}, half}) {
    if (half < sizeof(StateHead)) return;
    auto head = number_at<StateHead>(slots, at);
    if (head.size > half - sizeof head) continue;
    head.checksum =
        state_checksum(head, as_bytes(std::string_view(slots).substr(at + sizeof head, head.size)));
    slots.replace(at, sizeof head, bytes_of(head));
  }
}

void mutate_record(Record& record, const ByteMutator& mutate_bytes, Choice& choice) {
  if (choice.is_one_of(3)) return mutate_head(record.head, mutate_bytes, choice);
  const bool keeps_size = choice.is_one_of(2);
  const std::size_t size = record.bytes.size();
  record.bytes = mutate_bytes(std::move(record.bytes), longest_contents);
  if (keeps_size) record.bytes.resize(size, '\0');
  record.head.size = record.bytes.size();
  if (record.head.kind == RecordKind::slots) repair_states(record.bytes);
}

}  // namespace

std::string mutate_journal(const std::string& file, const ByteMutator& mutate_bytes,
                           std::uint64_t seed) {
  Choice choice(seed);
  if (file.empty() || choice.is_one_of(16)) return mutate_bytes(file, longest_contents);
  JournalParts parts = journal_parts(file);
  if (parts.records.empty() || choice.is_one_of(8)) {
    parts.header = mutate_bytes(parts.header, longest_contents);
    return journal_file(parts);
  }
  const std::size_t chosen = choice.below(parts.records.size());
  const auto place = parts.records.begin() + static_cast<std::ptrdiff_t>(chosen);
  switch (choice.below(8)) {
    case 0:
      parts.records.erase(place);
      break;
    case 1:
      parts.records.insert(place, Record(*place));
      break;
    case 2:
      std::swap(*place, parts.records[choice.below(parts.records.size())]);
      break;
    case 3:
      parts.rest = mutate_bytes(parts.rest, longest_contents);
      break;
    default:
      mutate_record(*place, mutate_bytes, choice);
  }
  return journal_file(parts);
}

}  // namespace lightwell::fuzz
