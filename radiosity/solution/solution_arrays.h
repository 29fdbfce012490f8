#pragma once

#include <fmt/format.h>
#include <vtkAOSDataArrayTemplate.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "scene/bands.h"
#include "scene/errors.h"

namespace lightwell {

template <class T>
struct Values {
  const T* data = nullptr;
  int rows = 0, columns = 0;

  std::vector<T> to_vector() const { return {data, data + std::ptrdiff_t{rows} * columns}; }
};

/// The arrays of a file with a valid seal. The file may come from another program, so every value
/// is checked before use. Failed checks throw InputError that names the file.
class SolutionArrays {
 public:
  SolutionArrays(const std::filesystem::path& path, vtkPolyData* poly) : path_(path), poly_(poly) {}

  [[noreturn]] void reject(const std::string& reason) const {
    throw InputError(fmt::format("cannot read the solution '{}': {}", path_.string(), reason));
  }
  void require(bool holds, const std::string& what_is_wrong) const {
    if (!holds) reject(what_is_wrong);
  }

  /// Values of an array; none if the array is absent.
  template <class T>
  Values<T> optional(vtkFieldData* data, const char* name, int columns) const {
    vtkAbstractArray* abstract = data->GetAbstractArray(name);
    if (!abstract) return {nullptr, 0, columns};
    auto* array = vtkAOSDataArrayTemplate<T>::FastDownCast(abstract);
    require(array, fmt::format("its array '{}' has the wrong type", name));
    require(array->GetNumberOfComponents() == columns,
            fmt::format("its array '{}' has {} columns instead of {}", name,
                        array->GetNumberOfComponents(), columns));
    require(array->GetNumberOfTuples() < std::numeric_limits<int>::max(),
            fmt::format("its array '{}' is too long", name));
    return {array->GetPointer(0), static_cast<int>(array->GetNumberOfTuples()), columns};
  }
  template <class T>
  Values<T> required(vtkFieldData* data, const char* name, int rows, int columns = 1) const {
    const Values<T> values = optional<T>(data, name, columns);
    require(values.data, fmt::format("its array '{}' is missing", name));
    require(values.rows == rows,
            fmt::format("its array '{}' has {} rows instead of {}", name, values.rows, rows));
    return values;
  }
  /// Integers, all of which must lie in [low, high).
  std::vector<int> integers(vtkFieldData* data, const char* name, int rows, int low,
                            int high) const {
    std::vector<int> values = required<int>(data, name, rows).to_vector();
    for (const int value : values) {
      require(low <= value && value < high,
              fmt::format("its array '{}' holds {}, outside [{}, {})", name, value, low, high));
    }
    return values;
  }
  Eigen::ArrayXd areas(vtkFieldData* data, const char* name, int rows) const {
    const auto values = required<double>(data, name, rows);
    const Eigen::ArrayXd areas = Eigen::Map<const Eigen::ArrayXd>(values.data, rows);
    require((areas > 0.0).all() && areas.allFinite(),
            fmt::format("its array '{}' holds an area that is not positive", name));
    return areas;
  }
  BandArray bands(vtkFieldData* data, const char* name, int rows, int band_count) const {
    const auto values = required<float>(data, name, rows, band_count);
    return Eigen::Map<const BandArray>(values.data, rows, band_count);
  }
  double number(const char* name) const { return *required<double>(field(), name, 1).data; }
  std::vector<std::string> strings(const char* name) const {
    vtkAbstractArray* abstract = field()->GetAbstractArray(name);
    if (!abstract) return {};
    auto* array = vtkStringArray::SafeDownCast(abstract);
    require(array, fmt::format("its array '{}' has the wrong type", name));
    std::vector<std::string> values;
    for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i) values.push_back(array->GetValue(i));
    return values;
  }
  std::string text(const char* name) const {
    const auto values = strings(name);
    require(values.size() == 1, fmt::format("its entry '{}' is missing", name));
    return values.front();
  }

  vtkFieldData* field() const { return poly_->GetFieldData(); }
  vtkFieldData* points() const { return poly_->GetPointData(); }
  vtkFieldData* cells() const { return poly_->GetCellData(); }
  vtkPolyData* poly() const { return poly_; }

 private:
  const std::filesystem::path& path_;
  vtkPolyData* poly_;
};

}  // namespace lightwell
