// Solves a scene and writes it as a glTF model (.glb) with the light at its vertices, for engines
// and modelling programs.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "radiosity/solve.h"
#include "scene/io/read_scene.h"
#include "viewer/export/export.h"

using namespace lightwell;

int main(int argc, char** argv) {
  const Scene scene = read_scene(argc > 1 ? argv[1] : "cornell/cornell.toml");
  const char* const file = argc > 2 ? argv[2] : "baked.glb";
  const SolvedScene solved = solve_scene(scene);
  const BakedModel model = bake_model(solved, scene);
  write_gltf(file, model);
  std::printf("%s: %d vertices, %d faces, brightest %.0f lx\n", file, model.vertex_count(),
              model.face_count(),
              *std::max_element(model.illuminance.begin(), model.illuminance.end()));

  // The integral of (1 - rho) E over all faces must be the power that surfaces absorb.
  double absorbed = 0;  // W, all bands
  for (int face = 0; face < model.face_count(); ++face) {
    Spectrum E = Spectrum::Zero(model.irradiance.cols());  // W/m^2, mean over the corners
    const int corners = model.corner_count(face);
    for (int k = 0; k < corners; ++k)
      E += model.irradiance.row(model.faces[face][k]).transpose() / static_cast<float>(corners);
    const int element = model.element[face], patch = solved.mesh.patch[element];
    absorbed += solved.mesh.element_area[element] *
                ((1 - solved.mesh.reflectance.row(patch).transpose()) * E).sum();
  }
  const double expected = solved.solution.energy.absorbed;
  std::printf("absorbed: %.4f W by the baked light, %.4f W by the energy balance of the patches\n",
              absorbed, expected);
  // The error of the mean is below the RMS error of interpolated irradiance, which is estimated.
  return std::abs(absorbed / expected - 1) < solved.solution.error_estimate ? 0 : 1;
}
