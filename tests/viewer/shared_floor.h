#pragma once

#include <array>
#include <memory>
#include <utility>

#include "mesh/cleaning/joined_surfaces.h"
#include "radiosity/solve.h"

namespace lightwell {

/// A floor of the surfaces "left" (x < 1) and "right", of materials that differ in name, under a
/// lamp: joined to one polygon, and solved.
struct SharedFloor {
  Scene scene{};
  std::shared_ptr<const JoinedSurfaces> names{};
  SolvedScene solved{};

  SharedFloor() {
    const auto add = [&](const char* name, float rho, float M, double z,
                         std::array<std::pair<double, double>, 4> corners) {
      scene.surfaces.push_back(
          {.name = name, .material = static_cast<int>(scene.materials.size())});
      scene.materials.push_back({.name = std::string(name) + " paint",
                                 .reflectance = constant_spectrum(scene.bands, rho),
                                 .specular = constant_spectrum(scene.bands, 0.0f),
                                 .emission = constant_spectrum(scene.bands, M),
                                 .one_sided = true});
      PolygonMesh mesh{.facets = {{.boundary = {0, 1, 2, 3}}}};
      for (const auto& [x, y] : corners) mesh.vertices.emplace_back(x, y, z);
      scene.surfaces.back().shape = std::move(mesh);
    };
    add("left", 0.5f, 0.0f, 0.0, {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
    add("right", 0.5f, 0.0f, 0.0, {{{1, 0}, {2, 0}, {2, 1}, {1, 1}}});
    add("lamp", 0.0f, 1.0f, 1.0, {{{0, 0}, {0, 1}, {2, 1}, {2, 0}}});
    names = join_surfaces(scene);
    SolveOptions options{
        .mesh = {.max_patch_size = 0.5}, .gather = {.rays = 16}, .error_points = 16};
    options.refine.tolerance = 0.0;
    solved = solve_scene(scene, options);
  }
};

}  // namespace lightwell
