// Readings of `render` and of the window's picture off screen, in rooms of four materials.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "radiosity/solve.h"
#include "raytrace/light_meter.h"
#include "raytrace/scene_renderer.h"
#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"
#include "viewer/window/solution_view.h"
#include "viewer/window/x_display.h"

namespace lightwell::white_balance_test {
namespace {

constexpr int width = 160, height = 80;
constexpr std::array materials = {"white", "grey", "wood", "paper"};

// The wall at y = 3 has a strip of each material, 1 m wide; the opposite wall has room for a
// window.
constexpr const char* room = R"(
[materials.white]
reflectance = 0.88
[materials.grey]
reflectance = 0.18
[materials.wood]
reflectance = [0.42, 0.27, 0.15]
[materials.paper]
reflectance = [0.78, 0.76, 0.70]
[materials.plaster]
reflectance = 0.7
[[surfaces]]
name = "white"
material = "white"
polygon = [[1, 3, 0], [1, 3, 2], [0, 3, 2], [0, 3, 0]]
[[surfaces]]
name = "grey"
material = "grey"
polygon = [[2, 3, 0], [2, 3, 2], [1, 3, 2], [1, 3, 0]]
[[surfaces]]
name = "wood"
material = "wood"
polygon = [[3, 3, 0], [3, 3, 2], [2, 3, 2], [2, 3, 0]]
[[surfaces]]
name = "paper"
material = "paper"
polygon = [[4, 3, 0], [4, 3, 2], [3, 3, 2], [3, 3, 0]]
[[surfaces]]
name = "others"
material = "plaster"
polygons = [
  [[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0]], [[0, 0, 2], [0, 3, 2], [4, 3, 2], [4, 0, 2]],
  [[0, 0, 0], [0, 0, 2], [0.8, 0, 2], [0.8, 0, 0]], [[3.2, 0, 0], [3.2, 0, 2], [4, 0, 2], [4, 0, 0]],
  [[4, 0, 0], [4, 0, 2], [4, 3, 2], [4, 3, 0]], [[0, 3, 0], [0, 3, 2], [0, 0, 2], [0, 0, 0]],
]
[[cameras]]
name = "front"
position = [2, 0.2, 1]
look_at = [2, 3, 1]
up = [0, 0, 1]
fov = 66
size = [160, 80]
)";

std::string lit_by_lamp(double kelvin) {
  const Eigen::Array3f c = 50.0f * colour_of_black_body(kelvin);
  return fmt::format(R"(
[materials.lamp]
exitance = [{}, {}, {}]
[[surfaces]]
name = "lamp"
material = "lamp"
polygon = [[1, 1, 1.95], [1, 2, 1.95], [3, 2, 1.95], [3, 1, 1.95]]
[[surfaces]]
name = "closed"
material = "plaster"
polygon = [[0.8, 0, 0], [0.8, 0, 2], [3.2, 0, 2], [3.2, 0, 0]]
)",
                     c[0], c[1], c[2]);
}

constexpr const char* lit_by_sky = R"(
[sky]
kind = "cie-overcast"
illuminance = 10000
color = [0.85, 1.0, 1.25]
up = [0, 0, 1]
north = [0, 1, 0]
)";

using Rgb = std::array<double, 3>;

/// The mean colour around the middle of a strip, sRGB bytes.
Rgb reading(const std::vector<std::uint8_t>& picture, int strip) {
  // Half the picture is 2.8 m tan 33 deg = 1.82 m wide, and x = 4 is on the right.
  const double half = 2.8 * std::tan(33.0 * std::numbers::pi / 180.0);
  const int x = static_cast<int>(0.5 * width * (1.0 + (strip + 0.5 - 2.0) / half)), y = height / 2;
  constexpr int reach = 3;
  Rgb sum{};
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      const std::size_t pixel = 3 * (static_cast<std::size_t>(y + j) * width + x + i);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += picture[pixel + c];
    }
  }
  for (double& c : sum) c /= (2 * reach + 1) * (2 * reach + 1);
  return sum;
}

/// One formula and one meter: what differs is the light, interpolated from the mesh in the window,
/// and direct light traced anew in `render`. Gathers of 256 rays at vertices 0.25 m apart have 2 %
/// of noise and interpolation, which is at most 0.02 * 255 / 2.2 = 2.3 bytes; rounding adds 0.5.
TEST(WhiteBalance, TheWindowShowsTheColoursOfRender) {
  const DisplayConnection display;
  const std::array<std::pair<const char*, std::string>, 4> lights = {
      {{"lamp, 2700 K", lit_by_lamp(2700.0)},
       {"lamp, 4000 K", lit_by_lamp(4000.0)},
       {"lamp, 6500 K", lit_by_lamp(6500.0)},
       {"window, sky", lit_by_sky}}};
  std::printf(
      "| light | material | as lit: render | window | auto: render | window |\n"
      "|---|---|---|---|---|---|\n");
  for (const auto& [light, text] : lights) {
    const TemporaryFolder folder;
    const Scene scene = read_scene(folder.write("room.toml", text + room));
    SolveOptions solving{.mesh = {.max_patch_size = 0.25}, .gather = {.rays = 256}};
    solving.refine.tolerance = 0.0;
    const SolvedScene solved = solve_scene(scene, solving);
    const Camera& camera = scene.cameras.front();
    SceneRenderer renderer(scene, solved.mesh, solved.solution);
    const Image rendered = renderer.render(camera);
    const std::optional<IncidentLight> incident = renderer.incident_light(camera);
    ASSERT_TRUE(incident.has_value());
    std::array<std::array<std::vector<std::uint8_t>, 2>, 2> pictures;
    for (const auto kind : {WhitePoint::Kind::as_lit, WhitePoint::Kind::automatic}) {
      ViewOptions options{
          .camera = camera, .cameras = scene.cameras, .width = width, .height = height};
      options.white.kind = kind;
      options.materials = scene.materials;
      options.scene = &scene;
      const SolutionView view(solved, options);
      const ToneMapping tones{.metered_scale = incident->exposure,
                              .balance = white_balance(options.white, incident)};
      auto& of_kind = pictures[kind == WhitePoint::Kind::automatic ? 1 : 0];
      of_kind[0] = tone_map(rendered, scene.bands, tones);
      of_kind[1] = draw_offscreen(view, width, height);
    }
    for (std::size_t m = 0; m < materials.size(); ++m) {
      std::string row = fmt::format("| {} | {} |", light, materials[m]);
      for (const auto& of_kind : pictures) {
        const Rgb wanted = reading(of_kind[0], static_cast<int>(m));
        const Rgb seen = reading(of_kind[1], static_cast<int>(m));
        for (const Rgb& rgb : {wanted, seen}) {
          row += fmt::format(" {:.0f} {:.0f} {:.0f} |", rgb[0], rgb[1], rgb[2]);
        }
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], wanted[c], 3.0) << row;
      }
      std::printf("%s\n", row.c_str());
    }
    // Under a warm lamp paper is orange as lit, and grey by the light in view: the walls around are
    // grey, so its colour is that of the light to a few bytes.
    const Rgb lit = reading(pictures[0][1], 0), balanced = reading(pictures[1][1], 0);
    if (std::string(light) == "lamp, 2700 K") {
      EXPECT_GT(lit[0] - lit[2], 40.0);
    }
    EXPECT_NEAR(balanced[0], balanced[2], 12.0) << light;
  }
}

}  // namespace
}  // namespace lightwell::white_balance_test
