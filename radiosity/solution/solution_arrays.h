#pragma once

#include <fmt/format.h>

#include <limits>
#include <string>
#include <vector>

#include "radiosity/solution/poly_data_file.h"
#include "scene/bands.h"

namespace lightwell {

template <class T>
struct Values {
  std::vector<T> values{};  ///< row by row
  int rows = 0, columns = 0;

  const T* row(int i) const { return values.data() + std::ptrdiff_t{i} * columns; }
};

/// The arrays of a file with a valid seal. The file may come from another program, so every value
/// is checked before use. Failed checks throw InputError that names the file.
class SolutionArrays {
 public:
  using Place = PolyDataFile::Place;

  explicit SolutionArrays(PolyDataFile& file) : file_(file) {}

  void require(bool holds, const std::string& what_is_wrong) const {
    if (!holds) file_.reject(what_is_wrong);
  }

  bool has(Place place, const std::string& name) const { return file_.find(place, name); }
  /// Values of an array; none if the array is absent.
  template <class T>
  Values<T> optional(Place place, const std::string& name, int columns) const {
    const StoredArray* array = file_.find(place, name);
    if (!array) return {.columns = columns};
    require(array->columns == columns, fmt::format("its array '{}' has {} columns instead of {}",
                                                   name, array->columns, columns));
    require(array->rows < std::numeric_limits<int>::max(),
            fmt::format("its array '{}' is too long", name));
    return {file_.values<T>(*array), static_cast<int>(array->rows), columns};
  }
  template <class T>
  Values<T> required(Place place, const std::string& name, int rows, int columns = 1) const {
    const StoredArray* array = file_.find(place, name);
    require(array, fmt::format("its array '{}' is missing", name));
    require(array->rows == rows,
            fmt::format("its array '{}' has {} rows instead of {}", name, array->rows, rows));
    return optional<T>(place, name, columns);
  }
  /// Integers, all of which must lie in [low, high).
  std::vector<int> integers(Place place, const std::string& name, int rows, int low,
                            int high) const {
    std::vector<int> values = required<int>(place, name, rows).values;
    for (const int value : values) {
      require(low <= value && value < high,
              fmt::format("its array '{}' holds {}, outside [{}, {})", name, value, low, high));
    }
    return values;
  }
  Eigen::ArrayXd areas(Place place, const std::string& name, int rows) const {
    const auto values = required<double>(place, name, rows);
    const Eigen::ArrayXd areas = Eigen::Map<const Eigen::ArrayXd>(values.row(0), rows);
    require((areas > 0.0).all() && areas.allFinite(),
            fmt::format("its array '{}' holds an area that is not positive", name));
    return areas;
  }
  BandArray bands(Place place, const std::string& name, int rows, int band_count) const {
    const auto values = required<float>(place, name, rows, band_count);
    return Eigen::Map<const BandArray>(values.row(0), rows, band_count);
  }
  double number(const char* name) const { return *required<double>(field(), name, 1).row(0); }
  std::vector<std::string> strings(const char* name) const {
    const StoredArray* array = file_.find(field(), name);
    return array ? file_.strings(*array) : std::vector<std::string>();
  }
  std::string text(const char* name) const {
    const auto values = strings(name);
    require(values.size() == 1, fmt::format("its entry '{}' is missing", name));
    return values.front();
  }

  static constexpr Place field() { return Place::field; }
  static constexpr Place points() { return Place::points; }
  static constexpr Place cells() { return Place::polygons; }
  PolyDataFile& file() const { return file_; }

 private:
  PolyDataFile& file_;
};

}  // namespace lightwell
