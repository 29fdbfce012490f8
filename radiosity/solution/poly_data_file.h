#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/solution/compressed_blocks.h"

namespace lightwell {

/// An array of a file, whose values are read when they are asked for.
struct StoredArray {
  std::string name{}, type{};  ///< VTK's word for the type: "Int32", "String" ...
  int columns = 1;
  std::int64_t rows = 0;
  std::int64_t place = 0;  ///< of the first block in the file, in bytes
  BlockHead head{};
};

/// A VTK XML PolyData file (.vtp) of polygons, as Lightwell and VTK write solutions: one piece,
/// with raw appended data, little-endian, compressed by zlib, with heads of 64 bits. All names,
/// types, counts, offsets and sizes are checked when the file is opened, before memory is taken for
/// values. Functions throw InputError that names the file, and the array if one is at fault.
class PolyDataFile {
 public:
  /// Arrays of any length, with a row for each point, and with a row for each polygon.
  enum class Place { field, points, polygons };

  explicit PolyDataFile(const std::filesystem::path& path);

  /// Throws InputError: "cannot read the solution 'FILE': REASON".
  [[noreturn]] void reject(const std::string& reason) const;

  std::int64_t polygon_count() const { return polygons_; }
  /// Null if there is no such array.
  const StoredArray* find(Place place, std::string_view name) const;

  /// Values of an array of unsigned char, int, float or double, row by row. The type must be the
  /// array's.
  template <class T>
  std::vector<T> values(const StoredArray& array);
  std::vector<std::string> strings(const StoredArray& array);
  /// x, y and z of each point.
  std::vector<double> points();
  /// Numbers of points, of one polygon after another. No value is checked.
  std::vector<std::int64_t> corners();
  /// Place in corners() after each polygon's last corner. No value is checked.
  std::vector<std::int64_t> ends();

 private:
  struct Xml;
  using Section = std::vector<StoredArray>;

  void require(bool holds, const std::string& what_is_wrong) const {
    if (!holds) reject(what_is_wrong);
  }
  void read_piece(const Xml& xml);
  void read_bytes(const StoredArray& array, std::span<char> bytes);
  std::vector<std::int64_t> whole_numbers(const StoredArray& array);

  std::filesystem::path path_;
  std::ifstream file_;
  std::int64_t polygons_ = 0;
  Section field_, of_points_, of_polygons_, coordinates_, cells_;
};

}  // namespace lightwell
