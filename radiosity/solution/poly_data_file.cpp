#include "radiosity/solution/poly_data_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <pugixml.hpp>

#include "radiosity/solution/poly_data.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

constexpr std::int64_t most = std::numeric_limits<int>::max();  // values that an int numbers

// The whole number that a text is; empty if the text is anything else.
std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
  return value;
}

// Bytes of a value of a numeric type; 0: the type is unknown.
std::int64_t bytes_of(std::string_view type) {
  if (type == "Int8" || type == "UInt8") return 1;
  if (type == "Int32" || type == "Float32") return 4;
  if (type == "Int64" || type == "Float64") return 8;
  return 0;
}

// Reads one array's XML element and the head of its blocks, and checks both.
class ArrayHead {
 public:
  ArrayHead(const PolyDataFile& file, std::ifstream& stream, std::int64_t data, std::int64_t end)
      : file_(file),
        stream_(stream),
        data_(data),
        end_(end),
        unclaimed_(end - data),
        room_(std::max(least_room, most_of_file * end)) {}

  // `tuples`: the rows that the array must have; -1: as the element says.
  StoredArray read(const pugi::xml_node& node, std::int64_t tuples) {
    StoredArray array = read_head(node);
    const std::int64_t own = number(node, "NumberOfTuples", tuples);
    require(own >= 0 && (tuples < 0 || own == tuples), "the count of values is wrong");
    array.rows = own;
    const auto bytes = static_cast<std::int64_t>(array.head.bytes());
    if (node.name() == std::string_view("Array")) {
      constexpr std::int64_t longest = std::int64_t{1} << 26u, most_texts = std::int64_t{1} << 20u;
      require(array.type == "String" && array.columns == 1, "the type is unknown");
      require(own <= bytes && own <= most_texts && bytes <= longest,
              "the count of values is wrong");
      return array;
    }
    const std::int64_t each = bytes_of(array.type);
    require(each > 0, "the type is unknown");
    require(own <= most / array.columns && bytes == own * array.columns * each,
            "the count of values is wrong");
    return array;
  }

  // The corners or the ends of so many polygons. Elements have at most four corners.
  StoredArray read_whole_numbers(const pugi::xml_node& node, std::int64_t polygons) {
    StoredArray array = read_head(node);
    const auto bytes = static_cast<std::int64_t>(array.head.bytes());
    const std::int64_t each = bytes_of(array.type);
    require((each == 8 || each == 4) && array.type.starts_with("Int"),
            "the type is no whole number");
    const bool is_of_ends = array.name == "offsets";
    require(
        bytes % each == 0 && (is_of_ends ? bytes == polygons * each : bytes <= 4 * polygons * each),
        "the count of values is wrong");
    array.rows = bytes / each;
    return array;
  }

 private:
  void require(bool holds, const std::string& reason) const {
    if (!holds) {
      file_.reject(fmt::format("its array '{}' is damaged: {}", name_, reason));
    }
  }

  // A whole number from 0 to `most`; `otherwise` if the attribute is absent.
  std::int64_t number(const pugi::xml_node& node, const char* attribute,
                      std::int64_t otherwise) const {
    if (!node.attribute(attribute)) return otherwise;
    const auto value = whole_number(node.attribute(attribute).value());
    require(value && 0 <= *value && *value <= most,
            fmt::format("{} is '{}'", attribute, node.attribute(attribute).value()));
    return *value;
  }

  StoredArray read_head(const pugi::xml_node& node) {
    name_ = node.attribute("Name").value();
    require(!name_.empty(), "it has no name");
    require(node.attribute("format").value() == std::string_view("appended"),
            "it is not in the appended data");
    StoredArray array{.name = name_, .type = node.attribute("type").value()};
    array.columns = static_cast<int>(number(node, "NumberOfComponents", 1));
    require(array.columns >= 1, "there are no components");
    const auto offset = whole_number(node.attribute("offset").value());
    require(offset && *offset >= 0, "the offset is no number");
    require(*offset <= end_ - data_, "the offset is too large");
    array.place = data_ + *offset;
    const auto read_words = [&](std::uint64_t place, std::uint64_t count) {
      std::vector<std::uint64_t> words(count);
      stream_.seekg(static_cast<std::streamoff>(array.place + static_cast<std::int64_t>(place)));
      stream_.read(reinterpret_cast<char*>(words.data()),
                   static_cast<std::streamsize>(sizeof(std::uint64_t) * count));
      require(static_cast<bool>(stream_), "the appended data end early");
      return words;
    };
    array.head = block_head(static_cast<std::uint64_t>(end_ - array.place), read_words,
                            [&](const std::string& reason) { require(false, reason); });
    constexpr std::size_t before_sizes = 3;
    const std::size_t words =
        array.head.compressed.empty() ? 1 : before_sizes + array.head.compressed.size();
    const auto bytes_of_head = static_cast<std::int64_t>(sizeof(std::uint64_t) * words);
    array.place += bytes_of_head;
    unclaimed_ -= bytes_of_head + static_cast<std::int64_t>(array.head.compressed_bytes());
    require(unclaimed_ >= 0, "it shares its place with other arrays");
    room_ -= static_cast<std::int64_t>(array.head.bytes());
    require(room_ >= 0, "the values of all arrays are far longer than the file");
    return array;
  }

  // Bytes that all arrays may have together. Constant values shrink to a thousandth, others of real
  // solutions to a third.
  static constexpr std::int64_t least_room = std::int64_t{1} << 30u, most_of_file = 256;

  const PolyDataFile& file_;
  std::ifstream& stream_;
  std::int64_t data_, end_;  // of the appended data, in bytes from the file's begin
  std::int64_t unclaimed_;   // bytes of the appended data that no array has
  std::int64_t room_;        // bytes that the values of further arrays may take
  std::string name_;
};

}  // namespace

// The XML of a file, up to the appended data, and where these begin and end.
struct PolyDataFile::Xml {
  pugi::xml_document text{};
  std::int64_t data = 0, end = 0;
};

PolyDataFile::PolyDataFile(const std::filesystem::path& path)
    : path_(path), file_(path, std::ios::binary) {
  require(static_cast<bool>(file_), "it cannot be opened; is it there, and may you read it?");
  // The XML is short beside the data: some 200 bytes for each of some hundred arrays.
  constexpr std::string_view start_of_data = "<AppendedData encoding=\"raw\">";
  constexpr std::size_t longest = std::size_t{64} << 20u;
  std::string text;
  std::vector<char> buffer(1 << 16);
  std::size_t found = std::string::npos, data = std::string::npos;
  while (data == std::string::npos && text.size() < longest && file_) {
    file_.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    const std::size_t from = text.size() - std::min(text.size(), start_of_data.size());
    text.append(buffer.data(), static_cast<std::size_t>(file_.gcount()));
    if (found == std::string::npos) found = text.find(start_of_data, from);
    if (found != std::string::npos) data = text.find('_', found);
  }
  require(found != std::string::npos, "it has no appended data");
  file_.clear();
  require(data != std::string::npos, "its appended data do not begin");
  Xml xml;
  xml.data = static_cast<std::int64_t>(data) + 1;
  xml.end = static_cast<std::int64_t>(std::filesystem::file_size(path_));
  text.resize(found);
  text += "</VTKFile>";
  const pugi::xml_parse_result parsed = xml.text.load_buffer(text.data(), text.size());
  require(static_cast<bool>(parsed), fmt::format("its XML is damaged: {}", parsed.description()));
  read_piece(xml);
}

void PolyDataFile::reject(const std::string& reason) const {
  throw InputError(fmt::format("cannot read the solution '{}': {}", path_.string(), reason));
}

void PolyDataFile::read_piece(const Xml& xml) {
  const pugi::xml_node root = xml.text.child("VTKFile"), poly = root.child("PolyData"),
                       piece = poly.child("Piece");
  const auto has = [&](const char* attribute, std::string_view value) {
    return root.attribute(attribute).value() == value;
  };
  require(has("type", "PolyData") && has("byte_order", "LittleEndian") &&
              has("header_type", "UInt64") && has("compressor", "vtkZLibDataCompressor"),
          "its XML is not as Lightwell writes it");
  require(piece && !piece.next_sibling("Piece"), "it does not have one piece");
  const auto count = [&](const char* attribute) {
    const auto value = whole_number(piece.attribute(attribute).value());
    require(value && 0 <= *value && *value <= most, fmt::format("{} is no count", attribute));
    return *value;
  };
  const std::int64_t points = count("NumberOfPoints");
  polygons_ = count("NumberOfPolys");
  for (const char* other : {"NumberOfVerts", "NumberOfLines", "NumberOfStrips"}) {
    require(count(other) == 0, "it has other cells than polygons");
  }
  ArrayHead head(*this, file_, xml.data, xml.end);
  const auto read = [&](const pugi::xml_node& parent, std::int64_t tuples) {
    Section section;
    for (const pugi::xml_node& node : parent) section.push_back(head.read(node, tuples));
    return section;
  };
  field_ = read(poly.child("FieldData"), -1);
  of_points_ = read(piece.child("PointData"), points);
  of_polygons_ = read(piece.child("CellData"), polygons_);
  coordinates_ = read(piece.child("Points"), points);
  require(coordinates_.size() == 1, "it does not have one array of points");
  for (const pugi::xml_node& node : piece.child("Polys")) {
    cells_.push_back(head.read_whole_numbers(node, polygons_));
  }
}

const StoredArray* PolyDataFile::find(Place place, std::string_view name) const {
  const Section& section = place == Place::field    ? field_
                           : place == Place::points ? of_points_
                                                    : of_polygons_;
  const auto found = std::ranges::find(section, name, &StoredArray::name);
  return found == section.end() ? nullptr : &*found;
}

void PolyDataFile::read_bytes(const StoredArray& array, std::span<char> bytes) {
  std::vector<char> blocks(array.head.compressed_bytes());
  file_.seekg(static_cast<std::streamoff>(array.place));
  file_.read(blocks.data(), static_cast<std::streamsize>(blocks.size()));
  if (!file_ || !uncompress_blocks(array.head, blocks, bytes)) {
    reject(fmt::format("its array '{}' is damaged: a block is damaged", array.name));
  }
}

template <class T>
std::vector<T> PolyDataFile::values(const StoredArray& array) {
  require(array.type == data_type_name<T>(),
          fmt::format("its array '{}' has the wrong type", array.name));
  std::vector<T> values(array.head.bytes() / sizeof(T));
  read_bytes(array, {reinterpret_cast<char*>(values.data()), sizeof(T) * values.size()});
  return values;
}
template std::vector<unsigned char> PolyDataFile::values(const StoredArray&);
template std::vector<int> PolyDataFile::values(const StoredArray&);
template std::vector<float> PolyDataFile::values(const StoredArray&);
template std::vector<double> PolyDataFile::values(const StoredArray&);

std::vector<std::string> PolyDataFile::strings(const StoredArray& array) {
  require(array.type == "String", fmt::format("its array '{}' has the wrong type", array.name));
  std::string text(array.head.bytes(), '\0');
  read_bytes(array, text);
  const bool has_ended = text.empty() || text.back() == '\0';
  if (!has_ended || std::ranges::count(text, '\0') != array.rows) {
    reject(fmt::format("its array '{}' is damaged: a text does not end", array.name));
  }
  std::vector<std::string> strings;
  for (std::size_t at = 0; at < text.size(); at += strings.back().size() + 1) {
    strings.emplace_back(text.c_str() + at);
  }
  return strings;
}

std::vector<double> PolyDataFile::points() {
  const StoredArray& array = coordinates_.front();
  require(array.type == data_type_name<double>() && array.columns == 3 && array.rows > 0,
          "it has no points in double precision");
  return values<double>(array);
}

std::vector<std::int64_t> PolyDataFile::whole_numbers(const StoredArray& array) {
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(array.rows));
  if (array.type == "Int64") {
    read_bytes(array, {reinterpret_cast<char*>(numbers.data()), 8 * numbers.size()});
  } else {
    std::vector<std::int32_t> narrow(numbers.size());
    read_bytes(array, {reinterpret_cast<char*>(narrow.data()), 4 * narrow.size()});
    std::ranges::copy(narrow, numbers.begin());
  }
  return numbers;
}

std::vector<std::int64_t> PolyDataFile::corners() {
  const auto found = std::ranges::find(cells_, "connectivity", &StoredArray::name);
  require(found != cells_.end(), "its polygons have no corners");
  return whole_numbers(*found);
}

std::vector<std::int64_t> PolyDataFile::ends() {
  const auto found = std::ranges::find(cells_, "offsets", &StoredArray::name);
  require(found != cells_.end(), "its polygons have no corners");
  return whole_numbers(*found);
}

}  // namespace lightwell
