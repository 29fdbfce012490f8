// Changes of solution files that keep what the reader, zlib and the seal check by the way: the
// sizes of blocks, the places of arrays and the checksums.
#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <vector>

#include "radiosity/solution/solution_seal.h"
#include "tests/fuzz/input_file.h"
#include "tests/fuzz/mutation.h"
#include "tests/fuzz/target.h"

namespace lightwell::fuzz {
namespace {

constexpr std::size_t word = 8;

// A solution file in its parts.
struct SolutionParts {
  std::string xml{};                            // up to the first byte of the appended data
  std::map<std::size_t, std::string> arrays{};  // by their offset: the head and the blocks
  std::string end{};                            // the closing tags
};

// Visits the number of each attribute `offset` in the XML.
template <class Visit>
void for_each_offset(const std::string& xml, Visit visit) {
  constexpr std::string_view attribute = " offset=\"";
  for (std::size_t at = xml.find(attribute); at != std::string::npos;
       at = xml.find(attribute, at + 1)) {
    const std::size_t begin = at + attribute.size(),
                      end = std::min(xml.find('"', begin), xml.size());
    std::size_t offset = 0;
    const auto parsed = std::from_chars(xml.data() + begin, xml.data() + end, offset);
    if (parsed.ec == std::errc() && parsed.ptr == xml.data() + end) visit(begin, end, offset);
  }
}

// The parts of a file. A file whose parts cannot be told has no arrays.
SolutionParts solution_parts(const std::string& file) {
  const std::size_t data = file.find('_', file.find("<AppendedData"));
  const std::size_t end = file.rfind("</AppendedData>");
  if (data == std::string::npos || end == std::string::npos || end < data) return {.xml = file};
  SolutionParts parts{.xml = file.substr(0, data + 1),
                      .end = file.substr(end, file.rfind("<?lightwell-checksum") - end)};
  const std::string arrays = file.substr(data + 1, end - data - 1);
  for_each_offset(parts.xml, [&](std::size_t, std::size_t, std::size_t offset) {
    if (offset < arrays.size()) parts.arrays[offset];
  });
  for (auto at = parts.arrays.begin(); at != parts.arrays.end(); ++at) {
    const auto next = std::next(at);
    const std::size_t stop = next == parts.arrays.end() ? arrays.size() : next->first;
    at->second = arrays.substr(at->first, stop - at->first);
  }
  return parts;
}

std::string solution_text(const SolutionParts& parts) {
  std::map<std::size_t, std::size_t> moved;
  std::string data;
  for (const auto& [offset, array] : parts.arrays) {
    moved[offset] = data.size();
    data += array;
  }
  std::string xml;
  std::size_t done = 0;
  for_each_offset(parts.xml, [&](std::size_t begin, std::size_t end, std::size_t offset) {
    const auto place = moved.find(offset);
    if (place == moved.end()) return;
    xml += parts.xml.substr(done, begin - done) + std::to_string(place->second);
    done = end;
  });
  return xml + parts.xml.substr(done) + data + parts.end;
}

// The numbers or texts of an array of one block: most arrays of small files. Empty for others.
std::optional<std::string> array_contents(std::string_view array) {
  constexpr std::size_t head = 4 * word;
  if (array.size() < head || number_at<std::uint64_t>(array, 0) != 1) return std::nullopt;
  const auto packed = number_at<std::uint64_t>(array, 3 * word);
  if (packed > array.size() - head) return std::nullopt;
  return inflated(array.substr(head, packed));
}

std::string array_of(const std::string& contents) {
  const std::string packed = deflated(contents);
  return bytes_of<std::uint64_t>(1) + bytes_of<std::uint64_t>(contents.size()) +
         bytes_of<std::uint64_t>(0) + bytes_of<std::uint64_t>(packed.size()) + packed;
}

void mutate_array(std::string& array, const ByteMutator& mutate_bytes, Choice& choice) {
  auto contents = array_contents(array);
  if (!contents || choice.is_one_of(8)) {
    array = mutate_bytes(array, longest_contents);
    return;
  }
  const std::size_t size = contents->size();
  std::string changed = mutate_bytes(std::move(*contents), longest_contents);
  // Another size than that of the XML is refused before a value is read.
  if (!choice.is_one_of(8)) changed.resize(size, '\0');
  array = array_of(changed);
}

void mutate_attribute(std::string& xml, const ByteMutator& mutate_bytes, Choice& choice) {
  constexpr std::size_t longest = 64;
  const std::size_t before = xml.find("=\"", choice.below(xml.size()));
  if (before == std::string::npos) return;
  const std::size_t begin = before + 2, end = xml.find('"', begin);
  if (end == std::string::npos) return;
  xml.replace(begin, end - begin, mutate_bytes(xml.substr(begin, end - begin), longest));
}

std::string sealed(const std::string& file) {
  const auto path = input_file("sealed.vtp", file);
  seal_solution(path);
  return bytes_of_file(path);
}

}  // namespace

std::string mutate_solution(const std::string& file, const ByteMutator& mutate_bytes,
                            std::uint64_t seed) {
  Choice choice(seed);
  SolutionParts parts = solution_parts(file);
  if (parts.arrays.empty() || choice.is_one_of(32)) return mutate_bytes(file, 2 * file.size() + 1);
  const auto any_array = [&]() -> std::string& {
    return std::next(parts.arrays.begin(),
                     static_cast<std::ptrdiff_t>(choice.below(parts.arrays.size())))
        ->second;
  };
  switch (choice.below(8)) {
    case 0:
      mutate_attribute(parts.xml, mutate_bytes, choice);
      break;
    case 1:
      parts.xml = mutate_bytes(parts.xml, parts.xml.size() + longest_contents);
      break;
    case 2:
      any_array() = any_array();
      break;
    default:
      mutate_array(any_array(), mutate_bytes, choice);
  }
  return sealed(solution_text(parts));
}

}  // namespace lightwell::fuzz
