// Frame rate of the window, beside plain VTK.
//
//   xvfb-run -a frame_bench [ELEMENTS ...]
//
// Prints for each number of elements (100 000 and 1 000 000) of a room: frames per second of the
// walk's window while the eye turns, and of a plain VTK window with the same triangles and colours,
// both of 1280 x 720 pixels, frame by frame in one run; and their ratio. Then the time from a
// change of exposure, and from a change of a channel's scale, to the next picture.
#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "bench/stopwatch.h"
#include "mesh/build_patches.h"
#include "radiosity/solution/relight.h"
#include "viewer/export/appearance.h"
#include "viewer/window/walk_window.h"
#include "viewer/window/x_display.h"

namespace {

using namespace lightwell;

constexpr int width = 1280, height = 720;
constexpr int frames = 20;
constexpr double room_area = 2.0 * (6.0 * 4.0 + 6.0 * 3.0 + 4.0 * 3.0);  // m^2

Scene empty_room() {
  Scene scene;
  scene.bands = rgb_bands();
  scene.materials.push_back({.name = "wall",
                             .reflectance = constant_spectrum(scene.bands, 0.7f),
                             .specular = constant_spectrum(scene.bands, 0.0f),
                             .emission = constant_spectrum(scene.bands, 1.0f),
                             .one_sided = true});
  PolygonMesh box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.emplace_back(i & 1 ? 6.0 : 0.0, i & 2 ? 4.0 : 0.0, i & 4 ? 3.0 : 0.0);
  }
  const std::array<std::vector<int>, 6> inwards = {
      {{2, 6, 4, 0}, {5, 7, 3, 1}, {4, 5, 1, 0}, {3, 7, 6, 2}, {1, 3, 2, 0}, {6, 7, 5, 4}}};
  for (const std::vector<int>& face : inwards) box.facets.push_back({.boundary = face});
  scene.surfaces.push_back({.name = "room", .material = 0, .shape = std::move(box)});
  scene.cameras.push_back({.name = "middle",
                           .position = {3.0, 2.0, 1.6},
                           .direction = {1.0, 0.0, 0.0},
                           .up = {0.0, 0.0, 1.0},
                           .fov_degrees = 70.0,
                           .width = width,
                           .height = height});
  return scene;
}

/// A mesh of the room with arbitrary light in two channels.
SolvedScene lit_room(const Scene& scene, int elements) {
  const double size = std::sqrt(room_area / elements);
  SolvedScene lit{.mesh = build_patches(scene, {.max_element_size = size})};
  RadiositySolution& s = lit.solution;
  s.bands = scene.bands;
  const auto vertices = lit.mesh.vertex_count();
  for (int c = 0; c < 2; ++c) {
    BandArray E(vertices, 3);
    for (int v = 0; v < vertices; ++v) {
      E.row(v) = static_cast<float>(5.0 + std::sin((c + 1) * lit.mesh.position(v).sum()));
    }
    s.channels.push_back({.name = fmt::format("channel {}", c),
                          .scale = constant_spectrum(s.bands, 1.0f),
                          .patch_radiosity = BandArray::Ones(lit.mesh.patch_count(), 3),
                          .direct_irradiance = E,
                          .indirect_irradiance = E,
                          .energy = BandEnergy::Ones(4, 3)});
  }
  s.patch_channel.assign(static_cast<std::size_t>(lit.mesh.patch_count()), 0);
  s.full_emission = lit.mesh.emission;
  relight(lit, std::vector<Spectrum>(2, constant_spectrum(s.bands, 1.0f)));
  return lit;
}

/// A plain VTK window with the triangles of `solved`.
class BareWindow {
 public:
  BareWindow(const SolvedScene& solved, const Look& look) {
    vtkNew<vtkPoints> points;
    const PatchMesh& mesh = solved.mesh;
    for (int v = 0; v < mesh.vertex_count(); ++v) points->InsertNextPoint(mesh.position(v).data());
    vtkNew<vtkCellArray> triangles;
    for (int e = 0; e < mesh.element_count(); ++e) {
      const auto& c = mesh.corners[e];
      for (int k = 2; k < mesh.corner_count(e); ++k) {
        const std::array<vtkIdType, 3> corners = {c[0], c[k - 1], c[k]};
        triangles->InsertNextCell(3, corners.data());
      }
    }
    const auto bytes = display_colors(shown_radiance(solved, {}), solved.solution.bands, 0.1);
    vtkNew<vtkUnsignedCharArray> colors;
    colors->SetNumberOfComponents(3);
    colors->SetNumberOfTuples(mesh.vertex_count());
    std::copy(bytes.begin(), bytes.end(), colors->GetPointer(0));
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(triangles);
    data->GetPointData()->SetScalars(colors);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    renderer_->AddActor(actor);
    vtkCamera* eye = renderer_->GetActiveCamera();
    const Camera& camera = look.camera;
    const Eigen::Vector3d target = camera.position + camera.direction;
    eye->SetPosition(camera.position.data());
    eye->SetFocalPoint(target.data());
    eye->SetViewUp(camera.up.data());
    eye->SetUseHorizontalViewAngle(true);
    eye->SetViewAngle(camera.fov_degrees);
    eye->SetClippingRange(0.01, 20.0);
    window_->SetMultiSamples(0);
    window_->SetSize(width, height);
    window_->AddRenderer(renderer_);
    window_->Render();
  }
  void draw_turned(double degrees) {
    renderer_->GetActiveCamera()->Yaw(degrees);
    window_->Render();
    window_->WaitForCompletion();
  }
  std::string driver() { return window_->ReportCapabilities(); }

 private:
  vtkNew<vtkRenderer> renderer_;
  vtkNew<vtkRenderWindow> window_;
};

void press(WalkWindow& window, const char* key) {
  window.press(key);
  window.release(key);
}

void draw(WalkWindow& window) {
  window.tick(0.0);
  window.interactor()->GetRenderWindow()->WaitForCompletion();
}

void measure(const Scene& scene, int elements) {
  const SolvedScene solved = lit_room(scene, elements);
  ViewOptions options;
  options.cameras = scene.cameras;
  options.materials = scene.materials;
  options.scene = &scene;
  options.width = width;
  options.height = height;
  WalkWindow window(solved, options);
  window.interactor()->GetRenderWindow()->SetMultiSamples(0);
  const double first = seconds_of([&] { draw(window); });
  BareWindow bare(solved, window.look());
  if (const std::string text = bare.driver(); text.find("renderer string") != std::string::npos) {
    const std::size_t at = text.find("renderer string");
    fmt::print("{}\n", text.substr(at, text.find('\n', at) - at));
  }
  // The windows alternate, so that other work on the machine slows both.
  double ours = 0.0, theirs = 0.0;
  constexpr int pixels = 32;  // per drag: 3 degrees, since the width is 120 degrees
  for (int i = 0; i < frames; ++i) {
    ours += seconds_of([&] {
      window.drag(pixels, 0);
      draw(window);
    });
    theirs += seconds_of([&] { bare.draw_turned(-120.0 * pixels / width); });
  }
  const double exposing = seconds_of([&] {
                            for (int i = 0; i < frames; ++i) {
                              press(window, i % 2 ? "plus" : "minus");
                              draw(window);
                            }
                          }) /
                          frames;
  press(window, "bracketright");
  draw(window);
  const double first_relight = seconds_of([&] {
    press(window, "plus");
    draw(window);
  });
  const double relighting = seconds_of([&] {
                              for (int i = 0; i < frames; ++i) {
                                press(window, i % 2 ? "plus" : "minus");
                                draw(window);
                              }
                            }) /
                            frames;
  fmt::print(
      "{} elements, {} vertices: window {:.1f} frames/s, bare VTK {:.1f} frames/s, ratio {:.2f}\n"
      "    first picture {:.0f} ms, exposure {:.1f} ms, relighting {:.1f} ms (the first {:.0f} "
      "ms)\n",
      solved.mesh.element_count(), solved.mesh.vertex_count(), frames / ours, frames / theirs,
      theirs / ours, 1e3 * first, 1e3 * exposing, 1e3 * relighting, 1e3 * first_relight);
}

}  // namespace

int main(int count, char** words) {
  const DisplayConnection display;
  const Scene scene = empty_room();
  std::vector<int> sizes = {100'000, 1'000'000};
  if (count > 1) {
    sizes.clear();
    for (int i = 1; i < count; ++i) sizes.push_back(std::stoi(words[i]));
  }
  for (const int elements : sizes) measure(scene, elements);
}
