// Time of a coated floor over that of a matt one, for solve and picture.
//
//   coat_bench [SCENE.toml [SURFACE]]
//
// Default: the room with a window of the gallery and its floor. The floor keeps its diffuse
// reflectance and gets a coat of index 1.5, smooth or of alpha 0.1. Times are processor seconds of
// default options, the least of three solves and pictures of 320 pixels in width, in turn.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "radiosity/solve.h"
#include "raytrace/scene_renderer.h"
#include "scene/io/read_scene.h"

namespace {

using namespace lightwell;

double processor_seconds(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

struct Floor {
  const char* name;
  std::optional<Coat> coat{};
  float roughness = 0.0f;
};

struct Seconds {
  double solve = std::numeric_limits<double>::max(), picture = solve;
};

// The scene with a material of its own on the surface.
Scene with_floor(Scene scene, const std::string& surface, const Floor& floor) {
  for (Surface& each : scene.surfaces) {
    if (each.name != surface) continue;
    Material material = scene.materials[static_cast<std::size_t>(each.material)];
    material.name = floor.name;
    material.coat = floor.coat;
    material.specular = constant_spectrum(scene.bands, floor.coat ? 1.0f : 0.0f);
    material.specular_roughness = floor.roughness;
    each.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material);
    return scene;
  }
  throw std::invalid_argument("coat_bench: the scene has no surface '" + surface + "'");
}

void measure(const Scene& scene, Seconds& least) {
  SolvedScene solved;
  const double solve = processor_seconds([&] { solved = solve_scene(scene, {}); });
  Camera camera = scene.cameras.front();
  camera.height = camera.height * 320 / camera.width;
  camera.width = 320;
  const double picture = processor_seconds([&] {
    const ElementCaster caster(solved.mesh);
    const DirectLight light(scene, solved.mesh);
    render(scene, caster, light, solved.solution, camera);
  });
  least.solve = std::min(least.solve, solve);
  least.picture = std::min(least.picture, picture);
}

void run(const std::string& file, const std::string& surface) {
  const Scene scene = read_scene(file);
  const std::array<Floor, 3> floors = {
      {{"matt"}, {"smooth coat", Coat{}}, {"rough coat", Coat{}, 0.1f}}};
  std::array<Seconds, 3> seconds;
  constexpr int rounds = 3;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < floors.size(); ++i) {
      measure(with_floor(scene, surface, floors[i]), seconds[i]);
    }
  }
  fmt::print(
      "| floor | solve | picture | solve over matt | picture over matt |\n|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < floors.size(); ++i) {
    fmt::print("| {} | {:.1f} s | {:.1f} s | {:.2f} | {:.2f} |\n", floors[i].name, seconds[i].solve,
               seconds[i].picture, seconds[i].solve / seconds[0].solve,
               seconds[i].picture / seconds[0].picture);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc > 1 ? argv[1] : "docs/gallery/window.toml", argc > 2 ? argv[2] : "floor");
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
}
