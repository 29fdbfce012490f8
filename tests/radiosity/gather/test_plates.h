#pragma once

#include <Eigen/LU>
#include <cmath>
#include <utility>
#include <vector>

#include "mesh/build_patches.h"
#include "radiosity/gather/final_gather.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::test {

inline constexpr double plate_width = 0.2, plate_length = 4.0;
inline constexpr float B0 = 3.0f, plate_rho = 0.5f;
inline constexpr int desk_facet = 6;  // facet, after the six walls

// Two plates that face each other across `gap`, in the middle of a wide room whose walls emit B0.
// The light of the plates' vertices is that of plates in the open, as coarse meshes have it.
struct Plates {
  explicit Plates(double gap, float rho = plate_rho) : Plates(room(gap, rho)) {}
  /// Plates in another room.
  explicit Plates(Scene of)
      : scene(std::move(of)),
        mesh(build_patches(scene, {.max_patch_size = 2.0})),
        caster(mesh),
        light(scene, mesh),
        radiosity(gatherable_radiosity(
            mesh, light, BandArray::Constant(mesh.vertex_count(), scene.bands.count(), B0))) {}

  static Scene room(double gap, float rho = plate_rho) {
    Scene scene;
    const int wall = add_material(scene, diffuse(scene.bands, 0.0f, B0));
    const int plate = add_material(scene, diffuse(scene.bands, rho));
    add_box(scene, {-10, -10, -10}, {10, 10, 10}, {wall, wall, wall, wall, wall, wall}, true);
    const double w = plate_width, l = 0.5 * plate_length;
    add_polygon(scene, "desk", plate, {{0, -l, 0}, {w, -l, 0}, {w, l, 0}, {0, l, 0}});
    add_polygon(scene, "foot", plate, {{0, -l, gap}, {0, l, gap}, {w, l, gap}, {w, -l, gap}});
    return scene;
  }

  double gathered(double x, int rays, std::uint64_t replica = 0) const {
    const std::vector<GatherPoint> points = {{.position = {x, 0.0, 0.0}, .facet = desk_facet}};
    const GatherOptions options{.rays = rays, .replica = replica, .aims_out_of_gaps = true};
    return gather_irradiance({scene, caster, light}, radiosity, points, options).indirect(0, 0);
  }

  Scene scene;
  PatchMesh mesh;
  ElementCaster caster;
  DirectLight light;
  BandArray radiosity;
};

// Irradiance at x between two infinitely long plates in a room of radiosity B0: by symmetry both
// plates have the same,
//     E(x) = B0 (1 - F(x)) + rho int K(x, y) E(y) dy,   K = g^2 / (2 ((x - y)^2 + g^2)^(3/2)),
// with F = int K dy in closed form. The unknowns stand in the midpoints of equal cells; K is
// integrated over each cell in closed form.
inline double between_long_plates(double x, double gap, double rho = double{plate_rho}) {
  constexpr int n = 800;
  const double h = plate_width / n;
  const auto reached = [&](double from, double to) {  // int K up to `to`
    return 0.5 * (to - from) / std::hypot(to - from, gap);
  };
  const auto covered = [&](double from) { return reached(from, plate_width) - reached(from, 0.0); };
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd b(n);
  for (int i = 0; i < n; ++i) {
    const double xi = (i + 0.5) * h;
    b[i] = B0 * (1.0 - covered(xi));
    for (int j = 0; j < n; ++j) {
      A(i, j) -= rho * (reached(xi, (j + 1) * h) - reached(xi, j * h));
    }
  }
  const Eigen::VectorXd E = A.partialPivLu().solve(b);
  double sum = B0 * (1.0 - covered(x));
  for (int j = 0; j < n; ++j) {
    sum += rho * E[j] * (reached(x, (j + 1) * h) - reached(x, j * h));
  }
  return sum;
}

}  // namespace lightwell::test
