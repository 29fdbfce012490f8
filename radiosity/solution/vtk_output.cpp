#include "radiosity/solution/vtk_output.h"

#include <vtkCellArray.h>
#include <vtkErrorCode.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataWriter.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <numeric>

#include "radiosity/solution/vtk_messages.h"

namespace lightwell {
namespace {

void set_polygons(vtkPolyData* poly, const PatchMesh& mesh, std::span<const int> elements,
                  const std::vector<char>& is_written) {
  std::vector<vtkIdType> point_of(is_written.size(), -1);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (is_written[v]) point_of[v] = points->InsertNextPoint(mesh.position(v).data());
  }
  vtkNew<vtkCellArray> polygons;
  for (const int e : elements) {
    const int corner_count = mesh.corner_count(e);
    polygons->InsertNextCell(corner_count);
    for (int c = 0; c < corner_count; ++c) polygons->InsertCellPoint(point_of[mesh.corners[e][c]]);
  }
  poly->SetPoints(points);
  poly->SetPolys(polygons);
}

}  // namespace

void add_strings(vtkFieldData* data, const std::string& name,
                 const std::vector<std::string>& values) {
  if (values.empty()) return;
  vtkNew<vtkStringArray> array;
  array->SetName(name.c_str());
  for (const std::string& value : values) array->InsertNextValue(value);
  data->AddArray(array);
}

void set_element_polygons(vtkPolyData* poly, const PatchMesh& mesh) {
  std::vector<int> elements(static_cast<std::size_t>(mesh.element_count()));
  std::iota(elements.begin(), elements.end(), 0);
  set_polygons(poly, mesh, elements,
               std::vector<char>(static_cast<std::size_t>(mesh.vertex_count()), 1));
}

void set_element_polygons(vtkPolyData* poly, const PatchMesh& mesh, std::span<const int> elements) {
  std::vector<char> is_written(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (const int e : elements) {
    for (int c = 0; c < mesh.corner_count(e); ++c) is_written[mesh.corners[e][c]] = 1;
  }
  set_polygons(poly, mesh, elements, is_written);
}

std::string write_appended(vtkXMLPolyDataWriter* writer, vtkPolyData* poly,
                           const std::filesystem::path& path) {
  // VTK does not report why a file cannot be opened.
  if (!std::ofstream(path, std::ios::binary)) return std::strerror(errno);
  const VtkMessages messages;
  writer->SetFileName(path.c_str());
  writer->SetInputData(poly);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetHeaderTypeToUInt64();
  errno = 0;
  if (writer->Write() != 0 && writer->GetErrorCode() == vtkErrorCode::NoError) return "";
  // VTK knows full disks alone, and not all of them; the write that failed set errno.
  const int reason = errno;
  const bool is_of_a_write = reason == ENOSPC || reason == EDQUOT || reason == EFBIG;
  if (is_of_a_write) return std::strerror(reason);
  const bool full = writer->GetErrorCode() == vtkErrorCode::OutOfDiskSpaceError;
  return std::strerror(full ? ENOSPC : EIO);
}

}  // namespace lightwell
