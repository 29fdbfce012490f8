#include "viewer/window/sky_actor.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTexture.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewer/export/appearance.h"

namespace lightwell {
namespace {

/// Columns of the sky's texture, 0.35 degrees each: too coarse for the sun, which is a disc of its
/// own.
constexpr int azimuths = 1025;
/// Facets of the dome, 5 degrees each. Texture coordinates are linear over a facet, which puts them
/// off by less than a texel.
constexpr int facets_around = 72, facets_upwards = 18;
constexpr int sun_corners = 48;
constexpr double sun_distance = 0.95;  ///< share of the dome's radius

vtkSmartPointer<vtkActor> make_sky_actor(vtkPolyData* data) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->PickableOff();
  actor->UseBoundsOff();  // the dome is not part of the scene's bounds
  actor->GetProperty()->LightingOff();
  return actor;
}

/// Adds the upper or the lower half of the unit sphere, with texture coordinates in the grid's rows
/// above or below the horizon.
void add_half(const Sky& sky, const SkyGrid& grid, bool is_above, vtkPoints* points,
              vtkFloatArray* places, vtkCellArray* quads) {
  const auto first = static_cast<vtkIdType>(points->GetNumberOfPoints());
  const int from = is_above ? 0 : grid.rows_above;
  const int to = is_above ? grid.rows_above - 1 : grid.rows() - 1;
  for (int row = 0; row <= facets_upwards; ++row) {
    const double share = static_cast<double>(row) / facets_upwards;
    const double altitude = is_above ? 90.0 * (1.0 - share) : -90.0 * share;
    const double v = (from + share * (to - from) + 0.5) / grid.rows();
    for (int c = 0; c <= facets_around; ++c) {
      const double turn = static_cast<double>(c) / facets_around;
      points->InsertNextPoint(sky_direction(sky, 360.0 * turn, altitude).data());
      places->InsertNextTuple2((turn * (grid.columns - 1) + 0.5) / grid.columns, v);
    }
  }
  for (vtkIdType row = 0; row < facets_upwards; ++row) {
    for (vtkIdType c = 0; c < facets_around; ++c) {
      const vtkIdType at = first + row * (facets_around + 1) + c, below = at + facets_around + 1;
      quads->InsertNextCell({at, below, below + 1, at + 1});
    }
  }
}

vtkSmartPointer<vtkPolyData> dome_of(const Sky& sky, const SkyGrid& grid) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> places;
  places->SetNumberOfComponents(2);
  vtkNew<vtkCellArray> quads;
  for (const bool is_above : {true, false}) add_half(sky, grid, is_above, points, places, quads);
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->GetPointData()->SetTCoords(places);
  data->SetPolys(quads);
  return data;
}

/// The disc of the sun, nearer than the dome.
vtkSmartPointer<vtkPolyData> disc_of(const Sky& sky) {
  const Sun& sun = *sky.sun;
  const double radius = std::tan(0.5 * sun.angle_degrees * std::numbers::pi / 180.0);
  const Eigen::Vector3d side = sun.direction.unitOrthogonal();
  const Eigen::Vector3d other = sun.direction.cross(side);
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> polygons;
  polygons->InsertNextCell(sun_corners);
  for (int i = 0; i < sun_corners; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / sun_corners;
    const Eigen::Vector3d corner =
        sun.direction + radius * (std::cos(turn) * side + std::sin(turn) * other);
    polygons->InsertCellPoint(points->InsertNextPoint((sun_distance * corner).eval().data()));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(polygons);
  return data;
}

}  // namespace

SkyActor::SkyActor(const Sky& sky)
    : sky_(sky),
      grid_(sky_grid(sky, azimuths)),
      texels_(vtkSmartPointer<vtkImageData>::New()),
      dome_(make_sky_actor(dome_of(sky, grid_))) {
  texels_->SetDimensions(grid_.columns, grid_.rows(), 1);
  texels_->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  vtkNew<vtkTexture> texture;
  texture->SetInputData(texels_);
  texture->SetColorModeToDirectScalars();
  texture->InterpolateOn();
  texture->SetWrap(vtkTexture::ClampToEdge);
  dome_->SetTexture(texture);
  if (sky.sun) sun_ = make_sky_actor(disc_of(sky));
}

SkyActor::~SkyActor() = default;

void SkyActor::add_to(vtkRenderer* renderer) const {
  renderer->AddActor(dome_);
  if (sun_) renderer->AddActor(sun_);
}

void SkyActor::set_sky(const Sky& sky) {
  sky_ = sky;
  grid_ = sky_grid(sky, azimuths);
}

void SkyActor::expose(const Bands& bands, const Eigen::Array3f& scale) {
  const std::vector<std::uint8_t> bytes = display_colors(grid_.radiance, bands, scale);
  std::copy(bytes.begin(), bytes.end(), static_cast<std::uint8_t*>(texels_->GetScalarPointer()));
  texels_->Modified();
  if (!sun_) return;
  const Spectrum L = radiance_outside(sky_, sky_.sun->direction);
  const std::vector<std::uint8_t> disc = display_colors(L.transpose(), bands, scale);
  sun_->GetProperty()->SetColor(disc[0] / 255.0, disc[1] / 255.0, disc[2] / 255.0);
  sun_->SetVisibility(dome_->GetVisibility() && (sky_.sun->irradiance > 0.0f).any());
}

void SkyActor::place(const Eigen::Vector3d& eye, double radius) {
  for (vtkActor* const actor : {dome_.Get(), sun_.Get()}) {
    if (!actor) continue;
    actor->SetPosition(eye.x(), eye.y(), eye.z());
    actor->SetScale(radius);
  }
}

void SkyActor::show(bool shown) {
  dome_->SetVisibility(shown);
  if (sun_) sun_->SetVisibility(shown && (sky_.sun->irradiance > 0.0f).any());
}

}  // namespace lightwell
