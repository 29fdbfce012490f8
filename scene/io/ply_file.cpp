#include "scene/io/ply_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "scene/errors.h"
#include "scene/io/non_finite.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

enum class PlyFormat { ascii, little_endian, big_endian };

struct NumberType {
  std::string_view name, other_name;
  std::size_t size;                  // bytes
  double (*decode)(const char* at);  // from the machine's byte order, which is little-endian
  bool is_single;                    // precision
};

template <class Number>
double decode(const char* at) {
  Number number;
  std::memcpy(&number, at, sizeof number);
  return static_cast<double>(number);
}

constexpr std::array<NumberType, 8> number_types = {{
    {"char", "int8", 1, decode<std::int8_t>, false},
    {"uchar", "uint8", 1, decode<std::uint8_t>, false},
    {"short", "int16", 2, decode<std::int16_t>, false},
    {"ushort", "uint16", 2, decode<std::uint16_t>, false},
    {"int", "int32", 4, decode<std::int32_t>, false},
    {"uint", "uint32", 4, decode<std::uint32_t>, false},
    {"float", "float32", 4, decode<float>, true},
    {"double", "float64", 8, decode<double>, false},
}};

struct Property {
  std::string_view name;
  const NumberType* type;
  const NumberType* count;  // of a list; null: one number
};

struct Element {
  std::string_view name;
  std::int64_t count = 0;
  std::vector<Property> properties{};
  // Position of a number among the properties; empty if there is none of these names.
  std::optional<std::size_t> find(std::initializer_list<std::string_view> names) const {
    for (std::size_t p = 0; p < properties.size(); ++p) {
      if (std::ranges::find(names, properties[p].name) != names.end()) return p;
    }
    return std::nullopt;
  }
};

class PlyReader {
 public:
  explicit PlyReader(const std::filesystem::path& path) : file_(path), rest_(file_.text()) {}

  IndexedPolygons read() {
    read_header();
    for (const Element& element : elements_) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else {
        read_lists(element);
      }
    }
    return std::move(result_);
  }

 private:
  void read_header() {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
    for (line_ = 1;; ++line_) {
      const std::size_t end = rest_.find('\n');
      const std::string_view text = trimmed(rest_.substr(0, end));
      std::string_view words = text;
      const std::string_view key = next_word(words);
      if (line_ == 1 && key != "ply") fail("this is no PLY file; its first line must be 'ply'");
      if (end == std::string_view::npos) {
        fail("the header does not end with 'end_header'; the file was damaged or cut off");
      }
      rest_.remove_prefix(end + 1);
      if (key == "end_header") break;
      if (key == "format") {
        read_format(words, text);
      } else if (key == "element") {
        read_element(words, text);
      } else if (key == "property") {
        read_property(words, text);
      } else if (line_ > 1 && !key.empty() && key != "comment" && key != "obj_info") {
        fail_line("a header has no such line", text);
      }
    }
    if (!format_) fail("the header names no format; the file was damaged");
  }

  void read_format(std::string_view words, std::string_view text) {
    const std::string_view name = next_word(words);
    if (name == "ascii") format_ = PlyFormat::ascii;
    if (name == "binary_little_endian") format_ = PlyFormat::little_endian;
    if (name == "binary_big_endian") format_ = PlyFormat::big_endian;
    if (!format_) {
      fail_line("a format is ascii, binary_little_endian or binary_big_endian", text);
    }
  }

  void read_element(std::string_view words, std::string_view text) {
    const std::string_view name = next_word(words);
    if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0) {
      fail_line("the name of an element must begin with a letter", text);
    }
    if (std::ranges::find(elements_, name, &Element::name) != elements_.end()) {
      fail_line("there is an element of that name already", text);
    }
    const auto count = parse_finite(next_word(words));
    if (!count || !(*count >= 0.0 && *count <= static_cast<double>(file_.text().size()))) {
      throw InputError(
          fmt::format("{}:{}: the file is too short for so many of '{}' ({}); it was damaged or "
                      "cut off",
                      file_.path().string(), line_, excerpt(name), excerpt(text)));
    }
    elements_.push_back({.name = name, .count = static_cast<std::int64_t>(*count)});
  }

  void read_property(std::string_view words, std::string_view text) {
    if (elements_.empty()) fail_line("a property must follow an element", text);
    const auto type = [&] {
      const std::string_view name = next_word(words);
      const auto found = std::ranges::find_if(number_types, [&](const NumberType& each) {
        return each.name == name || each.other_name == name;
      });
      if (found == number_types.end()) fail_line("the type of the property is unknown", text);
      return &*found;
    };
    Property property{};
    std::string_view after = words;
    if (next_word(after) == "list") {
      words = after;
      property.count = type();
    }
    property.type = type();
    property.name = next_word(words);
    if (property.name.empty()) fail_line("a property must have a name", text);
    elements_.back().properties.push_back(property);
  }

  void read_vertices(const Element& element) {
    const auto x = element.find({"x"}), y = element.find({"y"}), z = element.find({"z"});
    const auto nx = element.find({"nx"}), ny = element.find({"ny"}), nz = element.find({"nz"});
    const auto u = element.find({"u", "s", "texture_u"}), v = element.find({"v", "t", "texture_v"});
    if (element.count > 0 && !(x && y && z)) fail("its vertices do not have x, y and z");
    std::vector<double> values;
    for (std::int64_t i = 0; i < element.count; ++i) {
      values.clear();
      for (const Property& property : element.properties) {
        values.push_back(0.0);
        if (!property.count) {
          values.back() = number(*property.type, element);
        } else {
          for (std::uint32_t k = length(property, element); k > 0; --k) {
            number(*property.type, element);
          }
        }
      }
      result_.positions.emplace_back(values[*x], values[*y], values[*z]);
      if (nx && ny && nz) result_.normals.emplace_back(values[*nx], values[*ny], values[*nz]);
      if (u && v) result_.uv.emplace_back(values[*u], values[*v]);
    }
  }

  // Polygons of faces, triangles of strips; other elements are skipped.
  void read_lists(const Element& element) {
    const auto corners = element.find({"vertex_indices", "vertex_index"});
    const bool is_face = element.name == "face", is_strip = element.name == "tristrips";
    std::vector<double> list;
    for (std::int64_t i = 0; i < element.count; ++i) {
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        list.clear();
        const std::uint32_t count = property.count ? length(property, element) : 1;
        for (std::uint32_t k = 0; k < count; ++k) list.push_back(number(*property.type, element));
        if (p != corners) continue;
        if (is_face) add_polygon(list, element);
        if (is_strip) add_strips(list, element);
      }
    }
  }

  void add_polygon(std::span<const double> list, const Element& element) {
    auto& polygon = result_.polygons.emplace_back();
    for (const double corner : list) polygon.push_back(index(corner, element));
  }

  // A strip ends before -1. Every second triangle has the other winding.
  void add_strips(std::span<const double> list, const Element& element) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (list[i] < 0.0) begin = i + 1;
      if (i < begin + 2) continue;
      std::array corners = {list[i - 2], list[i - 1], list[i]};
      if ((i - begin) % 2 == 1) std::swap(corners[0], corners[1]);
      add_polygon(corners, element);
    }
  }

  std::uint32_t index(double value, const Element& element) const {
    if (!(value >= 0.0 && value <= static_cast<double>(UINT32_MAX))) {
      fail(fmt::format("a '{}' has the number {}, which no vertex and no list can have",
                       excerpt(element.name), value));
    }
    return static_cast<std::uint32_t>(value);
  }

  std::uint32_t length(const Property& property, const Element& element) {
    return index(number(*property.count, element), element);
  }

  double number(const NumberType& type, const Element& element) {
    const double value =
        *format_ == PlyFormat::ascii ? text_number(element) : binary_number(type, element);
    return type.is_single ? static_cast<double>(static_cast<float>(value)) : value;
  }

  double text_number(const Element& element) {
    constexpr std::string_view blanks = " \t\r\n\f\v";
    rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size()));
    const std::string_view word = rest_.substr(0, rest_.find_first_of(blanks));
    if (word.empty()) fail_short(element);
    double value = 0.0;
    const char* const begin = word.data() + (word.starts_with('+') ? 1 : 0);
    const char* const end = word.data() + word.size();
    const auto parsed = std::from_chars(begin, end, value);
    if (names_non_finite(word)) {
      value = std::numeric_limits<double>::quiet_NaN();
    } else if (parsed.ec != std::errc() || parsed.ptr != end) {
      fail(fmt::format("a '{}' has '{}' in place of a number", excerpt(element.name),
                       excerpt(word)));
    }
    rest_.remove_prefix(word.size());
    return value;
  }

  double binary_number(const NumberType& type, const Element& element) {
    if (rest_.size() < type.size) fail_short(element);
    std::array<char, 8> bytes{};
    std::copy_n(rest_.begin(), type.size, bytes.begin());
    if (*format_ == PlyFormat::big_endian) {
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(type.size));
    }
    rest_.remove_prefix(type.size);
    return type.decode(bytes.data());
  }

  [[noreturn]] void fail(std::string_view problem) const {
    throw InputError(fmt::format("{}: {}", file_.path().string(), problem));
  }
  [[noreturn]] void fail_line(std::string_view problem, std::string_view text) const {
    file_.fail(line_, fmt::format("{} ({}); the file was damaged", problem, excerpt(text)));
  }
  [[noreturn]] void fail_short(const Element& element) const {
    fail(
        fmt::format("the file ends within '{}'; it was damaged or cut off", excerpt(element.name)));
  }

  TextFile file_;
  std::string_view rest_;
  int line_ = 0;
  std::optional<PlyFormat> format_{};
  std::vector<Element> elements_{};
  IndexedPolygons result_{};
};

}  // namespace

IndexedPolygons read_ply_file(const std::filesystem::path& path) {
  return PlyReader(path).read();
}

}  // namespace lightwell
