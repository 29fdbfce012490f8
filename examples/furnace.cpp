// The white furnace: in a closed room whose surfaces all reflect rho and all emit M, every
// radiosity is M + rho M + rho^2 M + ... = M / (1 - rho), whatever the shape of the room.
#include <cmath>
#include <cstdio>
#include <initializer_list>

#include "radiosity/solve.h"
#include "scene/scene.h"

using namespace lightwell;

// A box of `size` metres; all faces look inwards (corners counter-clockwise seen from inside).
PolygonMesh box(const Eigen::Vector3d& size) {
  PolygonMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(size.cwiseProduct(Eigen::Vector3d(i & 1, (i >> 1) & 1, i >> 2)));
  }
  mesh.facets = {{.boundary = {0, 1, 3, 2}}, {.boundary = {4, 6, 7, 5}},
                 {.boundary = {0, 4, 5, 1}}, {.boundary = {2, 3, 7, 6}},
                 {.boundary = {0, 2, 6, 4}}, {.boundary = {1, 5, 7, 3}}};
  return mesh;
}

int main() {
  bool all_good = true;
  for (const double rho : {0.2, 0.5, 0.9}) {
    Scene scene;
    const float M = 1.0f;  // W/m^2 in each band
    scene.materials = {{.name = "glowing",
                        .reflectance = constant_spectrum(scene.bands, static_cast<float>(rho)),
                        .specular = constant_spectrum(scene.bands, 0),
                        .emission = constant_spectrum(scene.bands, M),
                        .one_sided = true}};
    scene.surfaces = {{.name = "room", .shape = box({4, 3, 2.5})}};
    validate(scene);

    SolveOptions options;
    options.mesh.max_patch_size = 0.5;  // metres
    const SolvedScene solved = solve_scene(scene, options);

    const double expected = M / (1.0 - rho);
    const BandArray& B = solved.solution.patch_radiosity;
    double worst = 0.0;
    for (int i = 0; i < solved.mesh.patch_count(); ++i) {
      worst = std::fmax(worst, (B.row(i).cast<double>() / expected - 1.0).abs().maxCoeff());
    }
    std::printf("rho %.1f: M / (1 - rho) = %.6f, mean B = %.6f, largest error %.1e\n", rho,
                expected, static_cast<double>(B.mean()), worst);
    // The solver stops when its bound on the relative error of B is below 1e-5
    // (SolverOptions::tolerance). Rows of form factors add up to 1 within 1e-8 before they are
    // stored as floats.
    all_good = all_good && worst < 2e-5;
  }
  return all_good ? 0 : 1;
}
