#include "viewer/window/isolux.h"

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkContourFilter.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>

namespace lightwell {
namespace {

constexpr std::size_t most_labels = 60;

// The drawn triangles without glass, with illuminance (lx) and normals at their corners.
vtkSmartPointer<vtkPolyData> lit_triangles(const PatchMesh& mesh, const FineRoundShapes& spheres,
                                           const std::vector<ElementKind>& kinds,
                                           const std::vector<float>& lux,
                                           const BandArray& radiance) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkFloatArray> light;
  vtkNew<vtkDoubleArray> normals;
  normals->SetNumberOfComponents(3);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    points->InsertNextPoint(mesh.position(v).data());
    light->InsertNextValue(lux[static_cast<std::size_t>(v)]);
    normals->InsertNextTuple(mesh.vertex_normal[static_cast<std::size_t>(v)].data());
  }
  for (const FineRoundShapes::Point& point : spheres.points) {
    float value = 0.0f;
    for (int c = 0; c < 4; ++c) {
      if (point.vertex[c] >= 0) value += point.weight[c] * lux[point.vertex[c]];
    }
    points->InsertNextPoint(point.position.data());
    light->InsertNextValue(value);
    normals->InsertNextTuple(point.normal.data());
  }
  vtkNew<vtkCellArray> triangles;
  for (const FineRoundShapes::Face& face : spheres.faces) {
    if (kinds[face.element] == ElementKind::glass) continue;
    for (int c = 1; c < 3 && face.corner[c + 1] >= 0; ++c) {
      triangles->InsertNextCell(3);
      for (const int k : {0, c, c + 1}) {
        triangles->InsertCellPoint(mesh.vertex_count() + face.corner[k]);
      }
    }
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (kinds[static_cast<std::size_t>(e)] == ElementKind::glass) continue;
    if (!spheres.has_faces.empty() && spheres.has_faces[e]) continue;
    const int count = mesh.corner_count(e), first = first_corner(mesh, e, radiance);
    for (int c = 1; c + 1 < count; ++c) {
      triangles->InsertNextCell(3);
      for (const int k : {0, c, c + 1}) {
        triangles->InsertCellPoint(mesh.corners[e][(first + k) % count]);
      }
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(triangles);
  data->GetPointData()->SetScalars(light);
  data->GetPointData()->SetNormals(normals);
  return data;
}

vtkSmartPointer<vtkActor> make_line_actor(vtkPolyData* data, double grey, float width) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->SetColor(grey, grey, grey);
  actor->GetProperty()->SetLineWidth(width);
  actor->VisibilityOff();
  return actor;
}

vtkSmartPointer<vtkTextActor> make_label() {
  auto text = vtkSmartPointer<vtkTextActor>::New();
  text->GetPositionCoordinate()->SetCoordinateSystemToWorld();
  vtkTextProperty* property = text->GetTextProperty();
  property->SetFontSize(12);
  property->SetJustificationToCentered();
  property->SetVerticalJustificationToCentered();
  property->SetColor(1.0, 1.0, 1.0);
  property->SetBackgroundColor(0.05, 0.05, 0.05);
  property->SetBackgroundOpacity(0.75);
  text->VisibilityOff();
  return text;
}

// The way on which a camera sees a point.
Eigen::Vector3d sight_to(const Eigen::Vector3d& point, const Camera& camera) {
  const Eigen::Vector3d way = point - camera.position;
  if (camera.projection != Projection::orthographic) return way;
  return way.dot(camera.direction) * camera.direction;
}

}  // namespace

IsoluxLines::IsoluxLines()
    : data_(vtkSmartPointer<vtkPolyData>::New()),
      dark_(make_line_actor(data_, 0.0, 3.0f)),
      bright_(make_line_actor(data_, 1.0, 1.2f)) {
  for (std::size_t i = 0; i < most_labels; ++i) texts_.push_back(make_label());
}

IsoluxLines::~IsoluxLines() = default;

void IsoluxLines::add_to(vtkRenderer* renderer) const {
  renderer->AddActor(dark_);
  renderer->AddActor(bright_);
  for (const auto& text : texts_) renderer->AddViewProp(text);
}

void IsoluxLines::set(const PatchMesh& mesh, const FineRoundShapes& spheres,
                      const std::vector<ElementKind>& kinds, const std::vector<float>& lux,
                      const BandArray& radiance, const std::vector<double>& levels, double lift) {
  segments_.clear();
  const auto triangles = lit_triangles(mesh, spheres, kinds, lux, radiance);
  for (const double level : levels) {
    vtkNew<vtkContourFilter> contour;
    contour->SetInputData(triangles);
    contour->SetValue(0, level);
    contour->ComputeScalarsOff();
    contour->Update();
    vtkPolyData* const lines = contour->GetOutput();
    vtkDataArray* const normals = lines->GetPointData()->GetNormals();
    vtkNew<vtkIdList> ends;
    lines->GetLines()->InitTraversal();
    while (normals && lines->GetLines()->GetNextCell(ends)) {
      Segment segment;
      segment.level = level;
      normals->GetTuple(ends->GetId(0), segment.normal.data());
      segment.normal.normalize();
      lines->GetPoint(ends->GetId(0), segment.from.data());
      lines->GetPoint(ends->GetId(1), segment.to.data());
      segment.from += lift * segment.normal;
      segment.to += lift * segment.normal;
      segments_.push_back(segment);
    }
  }
  // Multiple of the lift; with SolutionView's lift, 0.3 of the scene's diagonal.
  constexpr double apart = 300.0;
  place_labels(apart * lift);
}

// Labels are at least `apart` (m) from labels of the same level, and a tenth of that from others.
void IsoluxLines::place_labels(double apart) {
  labels_.clear();
  for (const Segment& segment : segments_) {
    if (labels_.size() >= texts_.size()) break;
    const Eigen::Vector3d place = 0.5 * (segment.from + segment.to);
    const bool is_free = std::none_of(labels_.begin(), labels_.end(), [&](const Label& label) {
      const double room = label.level == segment.level ? apart : 0.1 * apart;
      return (label.place - place).norm() < room;
    });
    if (!is_free) continue;
    vtkTextActor* const text = texts_[labels_.size()];
    text->SetInput(fmt::format(" {:g} ", segment.level).c_str());
    text->GetPositionCoordinate()->SetValue(place.x(), place.y(), place.z());
    labels_.push_back({place, segment.normal, segment.level});
  }
}

void IsoluxLines::show(bool shown) {
  shown_ = shown;
  dark_->SetVisibility(shown);
  bright_->SetVisibility(shown);
  for (const auto& text : texts_) text->VisibilityOff();
}

void IsoluxLines::look_from(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                            const Camera& camera, const VisibleHitOptions& options) {
  if (!shown_) return;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> lines;
  for (const Segment& segment : segments_) {
    if (!(segment.normal.dot(sight_to(segment.from, camera)) < 0.0)) continue;
    const vtkIdType ends[2] = {points->InsertNextPoint(segment.from.data()),
                               points->InsertNextPoint(segment.to.data())};
    lines->InsertNextCell(2, ends);
  }
  data_->SetPoints(points);
  data_->SetLines(lines);
  data_->Modified();

  std::vector<Ray> rays;
  for (const Label& label : labels_) {
    const Eigen::Vector3d sight = sight_to(label.place, camera);
    rays.push_back({.origin = label.place - sight, .direction = sight});
  }
  const std::vector<VisibleHit> seen = visible_hits(caster, kinds, rays, options);
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    // Share of the distance to a label: labels are lifted off their surface.
    constexpr double just_before = 0.999;
    const bool faces = labels_[i].normal.dot(rays[i].direction) < 0.0;
    const bool in_front = rays[i].direction.dot(camera.direction) > 0.0;
    const bool is_free = !seen[i] || seen[i].distance > just_before;
    texts_[i]->SetVisibility(faces && in_front && is_free);
  }
}

}  // namespace lightwell
