#pragma once

#include <vtkAOSDataArrayTemplate.h>
#include <vtkFieldData.h>
#include <vtkNew.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "mesh/patches/patch_mesh.h"

class vtkPolyData;
class vtkXMLPolyDataWriter;

namespace lightwell {

/// Adds an array of `rows` x `columns` values. VTK files cannot hold empty arrays: an empty array
/// is not added, and nullptr is returned.
template <class T>
vtkAOSDataArrayTemplate<T>* add_values(vtkFieldData* data, const std::string& name, const T* values,
                                       std::ptrdiff_t rows, int columns = 1) {
  if (rows == 0 || columns == 0) return nullptr;
  vtkNew<vtkAOSDataArrayTemplate<T>> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(columns);
  array->SetNumberOfTuples(rows);
  std::copy_n(values, rows * columns, array->GetPointer(0));
  data->AddArray(array);
  return array;
}

/// Adds an array of strings. An empty array is not added.
void add_strings(vtkFieldData* data, const std::string& name,
                 const std::vector<std::string>& values);

/// Sets the mesh's vertices, in double precision, and one polygon per element.
void set_element_polygons(vtkPolyData* poly, const PatchMesh& mesh);

/// Sets one polygon for each of `elements`, and only the vertices of these elements, in the mesh's
/// order.
void set_element_polygons(vtkPolyData* poly, const PatchMesh& mesh, std::span<const int> elements);

/// Writes raw appended data with 64-bit headers. Returns the system's reason if writing failed,
/// otherwise an empty string.
std::string write_appended(vtkXMLPolyDataWriter* writer, vtkPolyData* poly,
                           const std::filesystem::path& path);

}  // namespace lightwell
