#include "viewer/window/marks.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

namespace lightwell {

Marks::Marks()
    : data_(vtkSmartPointer<vtkPolyData>::New()), actor_(vtkSmartPointer<vtkActor>::New()) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data_);
  // Offsets in depth large enough to be in front of every surface.
  mapper->SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -1e6);
  mapper->SetRelativeCoincidentTopologyPointOffsetParameter(-1e6);
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  actor_->SetMapper(mapper);
  vtkProperty* property = actor_->GetProperty();
  property->LightingOff();
  property->SetColor(1.0, 0.85, 0.1);
  property->SetLineWidth(2.0f);
  property->SetPointSize(7.0f);
  actor_->VisibilityOff();
}

Marks::~Marks() = default;

void Marks::add_to(vtkRenderer* renderer) const {
  renderer->AddActor(actor_);
}

void Marks::set(const std::vector<Eigen::Vector3d>& points) {
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  vtkNew<vtkCellArray> dots, lines;
  for (const Eigen::Vector3d& point : points) {
    const vtkIdType id = places->InsertNextPoint(point.data());
    dots->InsertNextCell(1, &id);
  }
  if (points.size() > 1) {
    lines->InsertNextCell(static_cast<int>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
      lines->InsertCellPoint(static_cast<vtkIdType>(i));
    }
  }
  data_->SetPoints(places);
  data_->SetVerts(dots);
  data_->SetLines(lines);
  data_->Modified();
  actor_->SetVisibility(!points.empty());
}

}  // namespace lightwell
