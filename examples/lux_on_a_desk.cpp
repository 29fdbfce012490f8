// Illuminance on a desk under a luminaire with a photometric file: mean and uniformity U0, beside
// the inverse-square law E = I cos(theta) / d^2.
#include <cmath>
#include <cstdio>

#include "mesh/elements/element_caster.h"
#include "radiosity/solve.h"
#include "raytrace/readings/lux_grid.h"
#include "scene/io/luminaires/luminaire_file.h"

using namespace lightwell;

Scene room_with_desk(float rho, const Lamp& lamp) {
  Scene scene;
  const Spectrum black = constant_spectrum(scene.bands, 0),
                 grey = constant_spectrum(scene.bands, rho);
  scene.materials = {{.name = "grey", .reflectance = grey, .specular = black, .emission = black}};
  PolygonMesh room, desk;  // metres
  for (int i = 0; i < 8; ++i) {
    room.vertices.push_back({4.0 * (i & 1), 3.0 * (i / 2 & 1), 2.8 * (i / 4)});
  }
  room.facets = {{.boundary = {0, 2, 6, 4}}, {.boundary = {1, 5, 7, 3}},
                 {.boundary = {0, 4, 5, 1}}, {.boundary = {2, 3, 7, 6}},
                 {.boundary = {0, 1, 3, 2}}, {.boundary = {4, 6, 7, 5}}};
  desk.vertices = {{1.2, 1.1, 0.75}, {2.8, 1.1, 0.75}, {2.8, 1.9, 0.75}, {1.2, 1.9, 0.75}};
  desk.facets = {{.boundary = {0, 1, 2, 3}}};
  scene.surfaces = {{.name = "room", .shape = room}, {.name = "desk", .shape = desk}};
  scene.lamps = {lamp};
  validate(scene);
  return scene;
}

int main(int argc, char** argv) {
  const LuminaireFile file = read_luminaire(argc > 1 ? argv[1] : "docs/luminaires/downlight.ies");
  Lamp lamp{.name = "downlight", .position = {2, 1.5, 2.75}};
  place_luminaire(file, rgb_bands(), constant_spectrum(rgb_bands(), 1), lamp);
  lamp.opening = {};  // a point, for which the inverse-square law is exact
  bool all_good = true;
  for (const float rho : {0.0f, 0.5f}) {
    const Scene scene = room_with_desk(rho, lamp);
    const SolvedScene solved = solve_scene(scene);
    const LuxGrid grid = lux_grid(scene, 1, Eigen::Vector3d::UnitZ(), {.spacing = 0.2});
    const LuxField field =
        measure_grid(scene, ElementCaster(solved.mesh), DirectLight(scene, solved.mesh),
                     solved.solution, grid, 1.0, {.rays = 1024});
    Eigen::ArrayXd direct(field.lux.size());
    for (int i = 0; i < direct.size(); ++i) {
      const Eigen::Vector3d way = grid.points[i].position - lamp.position;
      direct[i] = file.web->at(way) * -way.normalized().z() / way.squaredNorm();
    }
    const Eigen::ArrayXd reflected = field.lux - direct;
    std::printf("walls reflect %.1f: mean %.1f lx, U0 %.3f; direct %.1f lx, reflected %.1f lx\n",
                rho, field.mean, field.uniformity, direct.mean(), reflected.mean());
    // Without reflections only the rounding of floats is left, 3e-5 lx. With reflections the mean
    // over all 65.8 m^2 is rho Phi / ((1 - rho) A); the desk gets between half and twice as much.
    const double ratio = reflected.mean() * (1 - rho) * 65.8 / (rho * file.flux());
    all_good = all_good && (rho > 0 ? ratio > 0.5 && ratio < 2 : reflected.abs().maxCoeff() < 1e-3);
  }
  return all_good ? 0 : 1;
}
