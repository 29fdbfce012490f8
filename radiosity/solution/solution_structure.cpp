#include "radiosity/solution/solution_structure.h"

#include <fmt/format.h>
#include <vtkNew.h>
#include <vtkZLibDataCompressor.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "radiosity/solution/vtk_messages.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

constexpr std::int64_t most = std::numeric_limits<int>::max();  // values that an int numbers

// Bytes of a value of a numeric type; 0: the type is unknown.
std::int64_t bytes_of(std::string_view type) {
  if (type == "Int8" || type == "UInt8") return 1;
  if (type == "Int32" || type == "Float32") return 4;
  if (type == "Int64" || type == "Float64") return 8;
  return 0;
}

// An array of the file: an XML element that says where in the appended data its blocks are.
class StoredArray {
 public:
  StoredArray(const std::filesystem::path& path, const pugi::xml_node& node)
      : path_(path), node_(node), name_(node.attribute("Name").value()) {
    require(!name_.empty(), "it has no name");
    require(node.attribute("format").value() == std::string_view("appended"),
            "it is not in the appended data");
  }

  [[noreturn]] void reject(const std::string& reason) const {
    throw InputError(fmt::format("cannot read the solution '{}': its array '{}' is damaged: {}",
                                 path_.string(), name_, reason));
  }
  void require(bool holds, const std::string& what_is_wrong) const {
    if (!holds) reject(what_is_wrong);
  }

  // A whole number from 0 to `most`; `otherwise` if the attribute is absent.
  std::int64_t number(const char* attribute, std::int64_t otherwise) const {
    if (!node_.attribute(attribute)) return otherwise;
    const std::int64_t value = node_.attribute(attribute).as_llong(-1);
    require(0 <= value && value <= most,
            fmt::format("{} is '{}'", attribute, node_.attribute(attribute).value()));
    return value;
  }
  bool is_text() const { return node_.name() == std::string_view("Array"); }
  const std::string& name() const { return name_; }
  std::string_view type() const { return node_.attribute("type").value(); }
  std::int64_t offset() const {
    const std::int64_t value = node_.attribute("offset").as_llong(-1);
    require(value >= 0, "the offset is no number");
    return value;
  }

 private:
  const std::filesystem::path& path_;
  pugi::xml_node node_;
  std::string name_;
};

// The XML of a file, up to the appended data, and where these begin and end.
struct Layout {
  pugi::xml_document xml{};
  std::int64_t data = 0, end = 0;
};

class StructureCheck {
 public:
  explicit StructureCheck(const std::filesystem::path& path)
      : path_(path), file_(path, std::ios::binary) {
    read_layout();
  }

  void check() {
    const VtkMessages messages;
    const pugi::xml_node root = layout_.xml.child("VTKFile"), poly = root.child("PolyData");
    const auto has = [&](const char* attribute, std::string_view value) {
      return root.attribute(attribute).value() == value;
    };
    require(has("type", "PolyData") && has("byte_order", "LittleEndian") &&
                has("header_type", "UInt64") && has("compressor", "vtkZLibDataCompressor"),
            "its XML is not as Lightwell writes it");
    const pugi::xml_node piece = poly.child("Piece");
    require(piece && !piece.next_sibling("Piece"), "it does not have one piece");
    const auto count = [&](const char* attribute) {
      const std::int64_t value = piece.attribute(attribute).as_llong(-1);
      require(0 <= value && value <= most, fmt::format("{} is no count", attribute));
      return value;
    };
    const std::int64_t points = count("NumberOfPoints"), polygons = count("NumberOfPolys");
    for (const char* other : {"NumberOfVerts", "NumberOfLines", "NumberOfStrips"}) {
      require(count(other) == 0, "it has other cells than polygons");
    }
    check_arrays(poly.child("FieldData"), -1);
    check_arrays(piece.child("PointData"), points);
    check_arrays(piece.child("CellData"), polygons);
    check_arrays(piece.child("Points"), points);
    require(std::distance(piece.child("Points").begin(), piece.child("Points").end()) == 1,
            "it does not have one array of points");
    for (const char* cells : {"Verts", "Lines", "Strips", "Polys"}) {
      const bool is_used = cells == std::string_view("Polys");
      check_cells(piece.child(cells), is_used ? polygons : 0);
    }
  }

 private:
  struct Blocks {
    std::vector<std::uint64_t> compressed{};  // bytes of each
    std::uint64_t size = 0, last = 0;         // bytes of the others and of the last, uncompressed
    std::int64_t place = 0;                   // of the first in the file
    // Uncompressed, of all. No sum overflows: a file has less than 2^53 bytes, each makes 1032.
    std::int64_t bytes() const {
      if (compressed.empty()) return 0;
      return static_cast<std::int64_t>((compressed.size() - 1) * size + last);
    }
  };

  void require(bool holds, const std::string& what_is_wrong) const {
    if (holds) return;
    throw InputError(
        fmt::format("cannot read the solution '{}': {}", path_.string(), what_is_wrong));
  }

  // The XML is short beside the data: some 200 bytes for each of some hundred arrays.
  void read_layout() {
    constexpr std::string_view start_of_data = "<AppendedData encoding=\"raw\">";
    constexpr std::size_t longest = std::size_t{64} << 20u;
    std::string text;
    std::vector<char> buffer(1 << 16);
    std::size_t found = std::string::npos;
    while (found == std::string::npos && text.size() < longest && file_) {
      file_.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
      const std::size_t from = text.size() - std::min(text.size(), start_of_data.size());
      text.append(buffer.data(), static_cast<std::size_t>(file_.gcount()));
      found = text.find(start_of_data, from);
    }
    require(found != std::string::npos, "it has no appended data");
    file_.clear();
    const std::size_t data = text.find('_', found);
    require(data != std::string::npos, "its appended data do not begin");
    layout_.data = static_cast<std::int64_t>(data) + 1;
    layout_.end = static_cast<std::int64_t>(std::filesystem::file_size(path_));
    text.resize(found);
    text += "</VTKFile>";
    const pugi::xml_parse_result parsed = layout_.xml.load_buffer(text.data(), text.size());
    require(static_cast<bool>(parsed), fmt::format("its XML is damaged: {}", parsed.description()));
  }

  // `tuples`: of each array; -1: as each says.
  void check_arrays(const pugi::xml_node& parent, std::int64_t tuples) {
    for (const pugi::xml_node& node : parent) {
      const StoredArray array(path_, node);
      const std::int64_t own = array.number("NumberOfTuples", tuples);
      array.require(own >= 0 && (tuples < 0 || own == tuples), "the count of values is wrong");
      check_array(array, own);
    }
  }

  void check_cells(const pugi::xml_node& parent, std::int64_t cells) {
    std::int64_t corners = 0, end = 0;
    for (const pugi::xml_node& node : parent) {
      const StoredArray array(path_, node);
      const Blocks blocks = blocks_of(array);
      const std::int64_t bytes = blocks.bytes(), each = bytes_of(array.type());
      array.require(each == 8 || each == 4, "the type is no whole number");
      const bool is_offset = array.name() == "offsets";
      array.require(is_offset ? bytes == cells * each : bytes <= 4 * cells * each,
                    "the count of values is wrong");
      if (is_offset) {
        end = each == 8 ? last_offset<std::int64_t>(array, blocks)
                        : last_offset<std::int32_t>(array, blocks);
      } else {
        corners = bytes / each;
      }
    }
    // VTK takes memory for as many corners as the last offset says.
    require(end == corners, "its polygons have another number of corners than they say");
  }

  template <class Number>
  std::int64_t last_offset(const StoredArray& array, const Blocks& blocks) {
    Number last = 0;
    for_each_block(array, blocks, [&](const std::vector<unsigned char>& contents) {
      array.require(contents.size() % sizeof(Number) == 0, "a block ends within a number");
      for (std::size_t at = 0; at < contents.size(); at += sizeof(Number)) {
        Number next;
        std::memcpy(&next, contents.data() + at, sizeof next);
        array.require(next >= last, "the offsets fall");
        last = next;
      }
    });
    return last;
  }

  void check_array(const StoredArray& array, std::int64_t tuples) {
    const std::int64_t components = array.number("NumberOfComponents", 1);
    array.require(components >= 1, "there are no components");
    const Blocks blocks = blocks_of(array);
    if (array.is_text()) {
      array.require(array.type() == "String" && components == 1, "the type is unknown");
      check_strings(array, tuples, blocks);
      return;
    }
    const std::int64_t each = bytes_of(array.type());
    array.require(each > 0, "the type is unknown");
    array.require(tuples <= most / components && blocks.bytes() == tuples * components * each,
                  "the count of values is wrong");
  }

  // `count` words of 8 bytes from `place` on, which lie within the file.
  std::vector<std::uint64_t> words_at(std::int64_t place, std::size_t count) {
    std::vector<std::uint64_t> words(count);
    file_.seekg(static_cast<std::streamoff>(place));
    file_.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(8 * count));
    require(static_cast<bool>(file_), "its appended data end early");
    return words;
  }

  // The head of an array: the number of blocks, two sizes, and the compressed size of each block.
  Blocks blocks_of(const StoredArray& array) {
    constexpr std::int64_t word = 8, before_sizes = 3;
    array.require(array.offset() <= layout_.end - layout_.data - word, "the offset is too large");
    const std::int64_t place = layout_.data + array.offset();
    const std::uint64_t count = words_at(place, 1).front();
    if (count == 0) return {};
    array.require(count <= static_cast<std::uint64_t>((layout_.end - place) / word),
                  "there are more blocks than the file has room for");
    std::vector<std::uint64_t> head =
        words_at(place, static_cast<std::size_t>(count) + before_sizes);
    Blocks blocks{.size = head[1],
                  .last = head[2] == 0 ? head[1] : head[2],
                  .place = place + word * static_cast<std::int64_t>(head.size())};
    head.erase(head.begin(), head.begin() + before_sizes);
    blocks.compressed = std::move(head);
    array.require(blocks.last <= blocks.size, "the size of a block is wrong");
    auto left = static_cast<std::uint64_t>(layout_.end - blocks.place);
    for (std::uint64_t b = 0; b < count; ++b) {
      // Deflate makes at most 1032 bytes of one (Deutsch 1996: 258 bytes from two bits).
      constexpr std::uint64_t most_of_one = 1032;
      const std::uint64_t whole = b + 1 == count ? blocks.last : blocks.size;
      const std::uint64_t bytes = blocks.compressed[b];
      array.require(bytes <= left && whole / most_of_one <= bytes,
                    "a block is longer than the file");
      left -= bytes;
    }
    return blocks;
  }

  void check_strings(const StoredArray& array, std::int64_t count, const Blocks& blocks) {
    constexpr std::int64_t longest = std::int64_t{1} << 30u;
    const std::int64_t bytes = blocks.bytes();
    array.require(count <= bytes && bytes <= longest, "the count of values is wrong");
    std::int64_t ends = 0;
    bool has_ended = true;
    for_each_block(array, blocks, [&](const std::vector<unsigned char>& contents) {
      ends += std::ranges::count(contents, '\0');
      if (!contents.empty()) has_ended = contents.back() == '\0';
    });
    array.require(ends == count && has_ended, "a text does not end");
  }

  // Uncompresses the blocks of an array one by one.
  template <class Visit>
  void for_each_block(const StoredArray& array, const Blocks& blocks, Visit visit) {
    vtkNew<vtkZLibDataCompressor> compressor;
    std::vector<unsigned char> packed, contents;
    file_.seekg(static_cast<std::streamoff>(blocks.place));
    for (std::size_t b = 0; b < blocks.compressed.size(); ++b) {
      packed.resize(static_cast<std::size_t>(blocks.compressed[b]));
      file_.read(reinterpret_cast<char*>(packed.data()),
                 static_cast<std::streamsize>(packed.size()));
      const std::size_t whole = b + 1 == blocks.compressed.size() ? blocks.last : blocks.size;
      contents.resize(whole);
      const std::size_t made =
          compressor->Uncompress(packed.data(), packed.size(), contents.data(), whole);
      array.require(made == whole, "a block is damaged");
      visit(std::as_const(contents));
    }
  }

  const std::filesystem::path& path_;
  std::ifstream file_;
  Layout layout_{};
};

}  // namespace

void check_structure(const std::filesystem::path& path) {
  StructureCheck(path).check();
}

}  // namespace lightwell
