#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radiosity/solve.h"
#include "raytrace/display/light_meter.h"
#include "raytrace/scene_renderer.h"
#include "scene/io/read_scene.h"

namespace lightwell::four_materials {

inline constexpr int room_width = 160, room_height = 80;
inline constexpr std::array materials = {"white", "grey", "wood", "paper"};

// The wall at y = 3 has a strip of each material, 1 m wide; the opposite wall has room for a
// window.
inline constexpr const char* room_of_materials = R"(
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

inline std::string lit_by_lamp(double kelvin) {
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

/// An overcast sky, bluer as the sun sets: lx on open ground and the colour.
inline std::string lit_by_sky(double lux, const char* colour) {
  return fmt::format(R"(
[sky]
kind = "cie-overcast"
illuminance = {}
color = {}
up = [0, 0, 1]
north = [0, 1, 0]
)",
                     lux, colour);
}

/// The lights of the table in docs/tone-mapping.md.
inline std::vector<std::pair<const char*, std::string>> lights_of_materials() {
  return {{"lamp, 2700 K", lit_by_lamp(2700.0)},
          {"lamp, 4000 K", lit_by_lamp(4000.0)},
          {"lamp, 6500 K", lit_by_lamp(6500.0)},
          {"window, sky", lit_by_sky(10000.0, "[0.85, 1.0, 1.25]")},
          {"window, dusk", lit_by_sky(50.0, "[0.6, 0.95, 1.6]")}};
}

/// The room in a light, solved on vertices 0.25 m apart with gathers of 256 rays.
inline SolvedScene solved_room(const Scene& scene) {
  SolveOptions solving{.mesh = {.max_patch_size = 0.25}, .gather = {.rays = 256}};
  solving.refine.tolerance = 0.0;
  return solve_scene(scene, solving);
}

using Rgb = std::array<double, 3>;

/// Rendered from the room's camera, sRGB bytes, as lit or with the automatic white.
inline std::vector<std::uint8_t> rendered_room(const Scene& scene, const SolvedScene& solved,
                                               WhitePoint::Kind kind) {
  const Camera& camera = scene.cameras.front();
  SceneRenderer renderer(scene, solved.mesh, solved.solution);
  const Image image = renderer.render(camera);
  const std::optional<IncidentLight> incident = renderer.incident_light(camera);
  if (!incident) return {};
  return tone_map(
      image, scene.bands,
      {.metered_scale = incident->exposure, .balance = white_balance({.kind = kind}, incident)});
}

/// The mean colour around the middle of a strip, sRGB bytes.
inline Rgb reading_of(const std::vector<std::uint8_t>& picture, int strip) {
  // Half the picture is 2.8 m tan 33 deg = 1.82 m wide, and x = 4 is on the right.
  const double half = 2.8 * std::tan(33.0 * std::numbers::pi / 180.0);
  const int x = static_cast<int>(0.5 * room_width * (1.0 + (strip + 0.5 - 2.0) / half)),
            y = room_height / 2;
  constexpr int reach = 3;
  Rgb sum{};
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      const std::size_t pixel = 3 * (static_cast<std::size_t>(y + j) * room_width + x + i);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += picture[pixel + c];
    }
  }
  for (double& c : sum) c /= (2 * reach + 1) * (2 * reach + 1);
  return sum;
}

/// "224 210 190"
inline std::string text_of(const Rgb& rgb) {
  return fmt::format("{:.0f} {:.0f} {:.0f}", rgb[0], rgb[1], rgb[2]);
}

}  // namespace lightwell::four_materials
