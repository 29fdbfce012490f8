#pragma once

#include <Eigen/Geometry>
#include <stdexcept>

#include "mesh/build_patches.h"
#include "mesh/geometry/cut_size.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/solve.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::test {

/// A level rectangle that shines down with M = 1, so that E = F.
inline Loop lamp_loop(const Eigen::Vector3d& middle, double half) {
  const Eigen::Vector3d x = half * Eigen::Vector3d::UnitX(), y = half * Eigen::Vector3d::UnitY();
  return {middle - x - y, middle - x + y, middle + x + y, middle + x - y};
}

/// Floor of 50 % (surface and facet 0) and a black lamp.
inline Scene lit_floor(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Loop& lamp) {
  Scene scene;
  const int grey = add_material(scene, diffuse(scene.bands, 0.5f));
  const int light = add_material(scene, diffuse(scene.bands, 0.0f, 1.0f));
  add_polygon(scene, "floor", grey,
              {{low.x(), low.y(), 0},
               {high.x(), low.y(), 0},
               {high.x(), high.y(), 0},
               {low.x(), high.y(), 0}});
  add_polygon(scene, "lamp", light, lamp);
  return scene;
}

inline int add_black(Scene& scene) {
  return add_material(scene, diffuse(scene.bands, 0.0f));
}

/// For scenes in which a floor sees nothing that reflects: the gather's rays find 0, any number.
inline SolveOptions direct_alone() {
  return {.gather = {.rays = 16}, .error_points = 0};
}

/// For what asks about elements of even size.
inline SolveOptions even(SolveOptions options) {
  options.refine.tolerance = 0.0;
  return options;
}

/// A solved scene that can be asked for irradiance at places of its surfaces.
class Lit {
 public:
  Lit(const Scene& scene, const SolveOptions& options)
      : element_size(cut_size(scene, options.mesh).element_size()),
        solved(solve_scene(scene, options)),
        E(solved.solution.irradiance()),
        caster_(solved.mesh) {}
  Lit(const Lit&) = delete;
  Lit& operator=(const Lit&) = delete;

  double irradiance(const Eigen::Vector3d& place,
                    const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ()) const {
    return read(E, place, normal);
  }
  double direct(const Eigen::Vector3d& place, const Eigen::Vector3d& normal) const {
    return read(solved.solution.direct_irradiance, place, normal);
  }

  const double element_size;
  const SolvedScene solved;
  const BandArray E;  ///< at vertices

 private:
  double read(const BandArray& values, const Eigen::Vector3d& place,
              const Eigen::Vector3d& normal) const {
    const Ray ray{.origin = place + 1e-3 * element_size * normal, .direction = -normal};
    ElementHit hit;
    caster_.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.element < 0) throw std::logic_error("no surface at the place asked for");
    return interpolate(solved.mesh, values, hit)[0];
  }

  ElementCaster caster_;
};

}  // namespace lightwell::test
