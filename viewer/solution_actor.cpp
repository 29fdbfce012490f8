#include "viewer/solution_actor.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

namespace lightwell {
namespace {

vtkSmartPointer<vtkCellArray> polygons_of_kind(const PatchMesh& mesh,
                                               const std::vector<ElementKind>& kinds,
                                               const BandArray& radiance, ElementKind kind) {
  auto polygons = vtkSmartPointer<vtkCellArray>::New();
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (kinds[e] != kind) continue;
    const int corner_count = mesh.corner_count(e);
    // VTK splits a quad along the diagonal from its first corner.
    const int first = first_corner(mesh, e, radiance);
    polygons->InsertNextCell(corner_count);
    for (int c = 0; c < corner_count; ++c) {
      polygons->InsertCellPoint(mesh.corners[e][(first + c) % corner_count]);
    }
  }
  return polygons;
}

vtkSmartPointer<vtkActor> make_actor(vtkPolyData* data, bool is_glass) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetColorModeToDirectScalars();
  mapper->SetScalarModeToUsePointData();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->LightingOff();
  property->BackfaceCullingOn();
  property->SetEdgeColor(0.1, 0.1, 0.1);
  property->SetLineWidth(1.0f);
  if (is_glass) property->SetOpacity(glass_opacity);
  return actor;
}

}  // namespace

SolutionActor::SolutionActor(const PatchMesh& mesh, const std::vector<ElementKind>& kinds,
                             const BandArray& radiance)
    : colors_(vtkSmartPointer<vtkUnsignedCharArray>::New()) {
  colors_->SetNumberOfComponents(3);
  colors_->SetNumberOfTuples(mesh.vertex_count());
  colors_->FillValue(0);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(mesh.vertex_count());
  for (int v = 0; v < mesh.vertex_count(); ++v) points->SetPoint(v, mesh.position(v).data());

  for (const ElementKind kind : {ElementKind::lit, ElementKind::unlit, ElementKind::glass}) {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->GetPointData()->SetScalars(colors_);
    parts_.push_back({kind, data, make_actor(data, kind == ElementKind::glass)});
  }
  set_shapes(mesh, kinds, radiance);
}

SolutionActor::~SolutionActor() = default;

void SolutionActor::set_shapes(const PatchMesh& mesh, const std::vector<ElementKind>& kinds,
                               const BandArray& radiance) {
  for (const Part& part : parts_) {
    const auto polygons = polygons_of_kind(mesh, kinds, radiance, part.kind);
    part.data->SetPolys(polygons);
  }
}

void SolutionActor::add_to(vtkRenderer* renderer) const {
  for (const Part& part : parts_) renderer->AddActor(part.actor);
}

void SolutionActor::set_colors(const std::vector<std::uint8_t>& rgb) {
  std::copy(rgb.begin(), rgb.end(), colors_->GetPointer(0));
  colors_->Modified();
  for (const Part& part : parts_) part.data->Modified();
}

void SolutionActor::show_mesh(bool shown) {
  for (const Part& part : parts_) part.actor->GetProperty()->SetEdgeVisibility(shown);
}

void SolutionActor::show_unlit(bool shown) {
  for (const Part& part : parts_) {
    if (part.kind == ElementKind::unlit) part.actor->SetVisibility(shown);
  }
}

}  // namespace lightwell
