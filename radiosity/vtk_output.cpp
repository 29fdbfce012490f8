#include "radiosity/vtk_output.h"

#include <vtkCellArray.h>
#include <vtkErrorCode.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "radiosity/vtk_messages.h"

namespace lightwell {

void set_element_polygons(vtkPolyData* poly, const PatchMesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) points->SetPoint(v, mesh.position(v).data());
  vtkNew<vtkCellArray> polygons;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int corner_count = mesh.corner_count(e);
    polygons->InsertNextCell(corner_count);
    for (int c = 0; c < corner_count; ++c) polygons->InsertCellPoint(mesh.corners[e][c]);
  }
  poly->SetPoints(points);
  poly->SetPolys(polygons);
}

std::string write_appended(vtkXMLPolyDataWriter* writer, vtkPolyData* poly,
                           const std::filesystem::path& path) {
  // VTK does not say why a file cannot be opened.
  if (!std::ofstream(path, std::ios::binary)) return std::strerror(errno);
  const VtkMessages messages;
  writer->SetFileName(path.c_str());
  writer->SetInputData(poly);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetHeaderTypeToUInt64();
  if (writer->Write() != 0 && writer->GetErrorCode() == vtkErrorCode::NoError) return "";
  const bool full = writer->GetErrorCode() == vtkErrorCode::OutOfDiskSpaceError;
  return std::strerror(full ? ENOSPC : EIO);
}

}  // namespace lightwell
