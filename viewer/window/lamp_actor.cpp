#include "viewer/window/lamp_actor.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

namespace lightwell {

LampActor::LampActor(const DrawnLamps& lamps)
    : colors_(vtkSmartPointer<vtkUnsignedCharArray>::New()),
      data_(vtkSmartPointer<vtkPolyData>::New()),
      actor_(vtkSmartPointer<vtkActor>::New()) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const DrawnLamps::Face& face : lamps.faces()) {
    corner_count_.push_back(static_cast<int>(face.outline.size()));
    for (const Eigen::Vector3d& p : face.outline) points->InsertNextPoint(p.data());
  }
  colors_->SetNumberOfComponents(3);
  data_->SetPoints(points);
  data_->GetCellData()->SetScalars(colors_);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data_);
  mapper->SetColorModeToDirectScalars();
  mapper->SetScalarModeToUseCellData();
  actor_->SetMapper(mapper);
  actor_->PickableOff();
  actor_->GetProperty()->LightingOff();
  actor_->GetProperty()->BackfaceCullingOn();
}

LampActor::~LampActor() = default;

void LampActor::add_to(vtkRenderer* renderer) const {
  renderer->AddActor(actor_);
}

void LampActor::set_colors(const std::vector<std::uint8_t>& colors,
                           const std::vector<char>& is_drawn) {
  vtkNew<vtkCellArray> polygons;
  colors_->Reset();
  vtkIdType first = 0;
  for (std::size_t f = 0; f < corner_count_.size(); ++f) {
    const int count = corner_count_[f];
    if (is_drawn[f]) {
      polygons->InsertNextCell(count);
      for (int c = 0; c < count; ++c) polygons->InsertCellPoint(first + c);
      colors_->InsertNextTypedTuple(&colors[3 * f]);
    }
    first += count;
  }
  data_->SetPolys(polygons);
  colors_->Modified();
  data_->Modified();
}

void LampActor::show(bool shown) {
  actor_->SetVisibility(shown);
}

}  // namespace lightwell
