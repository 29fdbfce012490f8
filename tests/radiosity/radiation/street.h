#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "radiosity/form_factors/facet_view_factors.h"
#include "scene/io/default_material.h"
#include "scene/io/polygon_arrays.h"

// An endless street, of which sky view factors are closed forms.
namespace lightwell::street {

inline const Eigen::Vector3d zenith = Eigen::Vector3d::UnitZ();
inline constexpr double width = 10.0, height = 15.0;  // m, of the street

// Quadrilaterals, a surface each.
inline FacetViewFactors factors_between(const std::vector<std::array<Eigen::Vector3d, 4>>& quads) {
  Scene scene;
  scene.materials = {default_material(scene.bands)};
  PolygonArrays arrays{.first = {0}};
  for (const auto& quad : quads) {
    arrays.surface.push_back(static_cast<int>(scene.surfaces.size()));
    scene.surfaces.push_back({.name = "quad"});
    for (const Eigen::Vector3d& corner : quad) {
      arrays.corners.push_back(static_cast<int>(arrays.vertices.size()));
      arrays.vertices.push_back(corner);
    }
    arrays.first.push_back(arrays.corners.size());
  }
  const NumberedScene numbered = scene_of_polygons(scene, arrays);
  return facet_view_factors(numbered, check_facets(numbered.scene), {});
}

// A road, and walls at x = 0 and x = width, rows 0 to 2. Through each end goes less than (width +
// height) / length of the light of a row: 2.5e-5.
inline FacetViewFactors endless_street(double length = 1e6) {
  const double w = width, h = height, L = length;
  return factors_between({{{{0, 0, 0}, {w, 0, 0}, {w, L, 0}, {0, L, 0}}},
                          {{{0, 0, 0}, {0, L, 0}, {0, L, h}, {0, 0, h}}},
                          {{{w, L, 0}, {w, 0, 0}, {w, 0, h}, {w, L, h}}}});
}

}  // namespace lightwell::street
