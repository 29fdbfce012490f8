// View factors (form factors) of two parallel plates and of all faces of a box, beside their closed
// forms.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "mesh/build_patches.h"
#include "mesh/elements/element_caster.h"
#include "radiosity/form_factors/form_factors.h"

using namespace lightwell;

// Factor C-11 of Howell's catalogue: opposite rectangles a x b at distance c, X = a / c, Y = b / c.
double parallel(double X, double Y) {
  const double x = std::sqrt(1 + X * X), y = std::sqrt(1 + Y * Y);
  return 2 / (std::numbers::pi * X * Y) *
         (std::log(x * y / std::sqrt(X * X + y * y)) + X * y * std::atan(X / y) +
          Y * x * std::atan(Y / x) - X * std::atan(X) - Y * std::atan(Y));
}

int main() {
  const double a = 4, c = 2.5;  // metres: a square floor and the height
  // The rest follows from symmetry, closure (rows add up to 1) and reciprocity A_i F_ij = A_j F_ji.
  const double floor_ceiling = parallel(a / c, a / c), floor_wall = (1 - floor_ceiling) / 4;
  const double wall_floor = floor_wall * (a * a) / (a * c), wall_wall = parallel(1, c / a);
  const double wall_beside = (1 - wall_wall - 2 * wall_floor) / 2;
  const auto closed_form = [&](int i, int j) {  // faces 0 to 3 are walls, 4 and 5 floor and ceiling
    if (i / 2 == j / 2) return i < 4 ? wall_wall : floor_ceiling;
    return i >= 4 ? floor_wall : j >= 4 ? wall_floor : wall_beside;
  };

  PolygonMesh box;  // all faces look inwards: corners counter-clockwise seen from inside
  for (int i = 0; i < 8; ++i) box.vertices.push_back({a * (i & 1), a * (i / 2 & 1), c * (i / 4)});
  box.facets = {{.boundary = {0, 2, 6, 4}}, {.boundary = {1, 5, 7, 3}}, {.boundary = {0, 4, 5, 1}},
                {.boundary = {2, 3, 7, 6}}, {.boundary = {0, 1, 3, 2}}, {.boundary = {4, 6, 7, 5}}};
  PolygonMesh plates = box;
  plates.facets.erase(plates.facets.begin(), plates.facets.begin() + 4);

  double worst = 0;
  for (const PolygonMesh& polygons : {plates, box}) {
    Scene scene;
    const Spectrum black = constant_spectrum(scene.bands, 0);
    scene.materials = {
        {.reflectance = black, .specular = black, .emission = black, .one_sided = true}};
    scene.surfaces = {{.name = "faces", .shape = polygons}};
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 10});  // one patch for each face
    const auto F = compute_form_factors({scene, ElementCaster(mesh), DirectLight(scene, mesh)},
                                        {.method = FormFactorMethod::analytic});
    const int first = 6 - F->patch_count();
    for (int i = first; i < 6; ++i) {
      for (const auto& [patch, value] : F->row(i - first)) {
        const int j = first + patch;
        std::printf("F %d -> %d: %.7f, closed form %.7f\n", i, j, value, closed_form(i, j));
        worst = std::fmax(worst, std::abs(value - closed_form(i, j)));
      }
    }
  }
  // Closed forms take the place of sampling here; factors are stored as floats (6e-8 of 1).
  return worst < 1e-6 ? 0 : 1;
}
