// A user's program: a room made by hand, solved, and asked for its light.
#include <cstdio>

#include "mesh/elements/element_caster.h"
#include "radiosity/solve.h"
#include "raytrace/readings/probe.h"
#include "scene/scene.h"

using namespace lightwell;

namespace {

// A rectangle from `corner` along `u` and `v`; its front is where u x v points.
Surface rectangle(const char* name, int material, const Eigen::Vector3d& corner,
                  const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  return {.name = name,
          .material = material,
          .shape = PolygonMesh{.vertices = {corner, corner + u, corner + u + v, corner + v},
                               .facets = {{.boundary = {0, 1, 2, 3}}}}};
}

Scene room() {
  Scene scene;
  const auto all = [&scene](float value) { return constant_spectrum(scene.bands, value); };
  scene.materials = {
      {.name = "white", .reflectance = all(0.7f), .specular = all(0), .emission = all(0)},
      {.name = "light", .reflectance = all(0), .specular = all(0), .emission = all(10)}};
  const Eigen::Vector3d x(4, 0, 0), y(0, 3, 0), z(0, 0, 2.5), o(0, 0, 0);
  scene.surfaces = {rectangle("floor", 0, o, x, y),
                    rectangle("ceiling", 0, z, y, x),
                    rectangle("front", 0, o, z, x),
                    rectangle("back", 0, y, x, z),
                    rectangle("left", 0, o, y, z),
                    rectangle("right", 0, x, z, y),
                    rectangle("light", 1, {1.5, 1, 2.4}, {0, 1, 0}, {1, 0, 0})};
  validate(scene);
  return scene;
}

}  // namespace

int main() {
  const Scene scene = room();
  SolveOptions options;
  options.mesh.max_patch_size = 0.5;
  const SolvedScene solved = solve_scene(scene, options);
  const ElementCaster caster(solved.mesh);
  const Probe middle{.position = {2.0, 1.5, 0.0}, .normal = {0, 0, 1}};
  const BandArray E = interpolate_irradiance(caster, solved.solution, {&middle, 1});
  std::printf("irradiance at the middle of the floor: %.4f W/m2 per band\n",
              static_cast<double>(E(0, 0)));
  // Straight from 1 m2 of 10 W/m2 at 2.4 m, opposite its middle: E = 10 F = 0.5225. The walls add
  // about their mean, rho P / (A (1 - rho)) = 0.7 * 10 / (59 * 0.3) = 0.40.
  return E(0, 0) > 0.5225f + 0.2f && E(0, 0) < 0.5225f + 0.6f ? 0 : 1;
}
