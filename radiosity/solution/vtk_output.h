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

/// VTK's files cannot hold arrays without values: none is added, and a null pointer returned.
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

/// Text for people and for readers; nothing for no values.
void add_strings(vtkFieldData* data, const std::string& name,
                 const std::vector<std::string>& values);

/// The mesh's vertices, in double precision, and one polygon per element.
void set_element_polygons(vtkPolyData* poly, const PatchMesh& mesh);

/// One polygon for each of `elements`, and only the vertices that those have, in the mesh's order.
void set_element_polygons(vtkPolyData* poly, const PatchMesh& mesh, std::span<const int> elements);

/// Writes raw appended data with 64-bit headers. Returns why it failed, in the system's words;
/// nothing where it did not.
std::string write_appended(vtkXMLPolyDataWriter* writer, vtkPolyData* poly,
                           const std::filesystem::path& path);

}  // namespace lightwell
