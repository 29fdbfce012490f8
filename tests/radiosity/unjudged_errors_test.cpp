#include "radiosity/unjudged_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/build_patches.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/inner_errors.h"
#include "tests/radiosity/even_light.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::unjudged_errors_test {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr float exitance = 3.0f;
const Loop lamp = {{0.5, 0.5, 1}, {0.5, 1.5, 1}, {1.5, 1.5, 1}, {1.5, 0.5, 1}};

/// A floor of 2 m x 2 m that has no diffuse reflectance, a lamp above, and a diffuse wall that
/// turns its black back to both.
Scene dark_floor(float specular) {
  Scene scene;
  Material floor = diffuse(scene.bands, 0.0f);
  floor.specular = constant_spectrum(scene.bands, specular);
  add_polygon(scene, "floor", add_material(scene, floor),
              {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  add_polygon(scene, "lamp", add_material(scene, diffuse(scene.bands, 0.0f, exitance)), lamp);
  add_polygon(scene, "wall", add_material(scene, diffuse(scene.bands, 0.5f)),
              {{5, 0, 0}, {5, 1, 0}, {5, 1, 1}, {5, 0, 1}});
  return scene;
}

TEST(UnjudgedErrors, AreTheDifferenceFromTheLightOfTheLamp) {
  for (const float specular : {0.0f, 0.8f}) {
    const Scene scene = dark_floor(specular);
    const PatchMesh mesh =
        build_patches(scene, {.max_patch_size = 0.5, .elements_per_patch_edge = 2});
    const ElementCaster caster(mesh);
    RadiositySolution solution = even_light(scene, mesh);
    add_unjudged_errors({scene, caster, DirectLight(scene, mesh)}, {}, solution);
    int on_floor = 0;
    for (int e = 0; e < mesh.element_count(); ++e) {
      const float error = solution.interpolation_error[e];
      if (mesh.surface[mesh.patch[e]] == 2) {
        EXPECT_EQ(error, 0.0f) << "refinement measures walls";
      }
      if (mesh.surface[mesh.patch[e]] != 0) continue;
      ++on_floor;
      double square = 0.0;
      for (int k = 0; k < inner_point_count; ++k) {
        const double E = double{exitance} * std::abs(point_to_polygon(inner_position(mesh, e, k),
                                                                      Vector3d::UnitZ(), lamp));
        square += std::pow(1.0 - E, 2) / inner_point_count;
      }
      // Light is in floats, of which a difference of at most 1.5 has sixteen roundings.
      EXPECT_NEAR(error, std::sqrt(square), std::ldexp(1.5 * 16.0, -24)) << specular;
    }
    EXPECT_GE(on_floor, 64);
  }
}

// A low lamp lights a few places of a large floor steeply and the rest evenly. Elements that are
// not measured have the error that the range of their corners lets expect.
TEST(InnerErrors, OfElementsThatAreNotMeasuredFollowTheRange) {
  Scene scene;
  add_polygon(scene, "floor", add_material(scene, diffuse(scene.bands, 0.0f)),
              {{-4, -4, 0}, {6, -4, 0}, {6, 6, 0}, {-4, 6, 0}});
  add_polygon(scene, "lamp", add_material(scene, diffuse(scene.bands, 0.0f, exitance)), lamp);
  const PatchMesh mesh =
      build_patches(scene, {.max_patch_size = 0.5, .elements_per_patch_edge = 2});
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  RadiositySolution solution = even_light(scene, mesh);
  std::vector<InnerError> elements;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.surface[mesh.patch[e]] != 0 || mesh.is_back[mesh.patch[e]] != 0) continue;
    elements.push_back({e});
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const int v = mesh.corners[e][c];
      const double E = std::abs(point_to_polygon(mesh.position(v), Vector3d::UnitZ(), lamp));
      solution.direct_irradiance.row(v).setConstant(exitance * static_cast<float>(E));
    }
  }
  const auto squares = [&](int most) {
    std::vector<InnerError> measured = elements;
    measure_inside({scene, caster, direct_light}, {}, solution, {.most = most}, measured);
    return measured;
  };
  const auto all = static_cast<int>(elements.size());
  const std::vector<InnerError> truth = squares(all), some = squares(all / 16);
  int exceeded = 0;
  double sum = 0.0, sum_of_truth = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // Bounds are twice the error.
    exceeded += truth[i].square > 4.0 * some[i].square ? 1 : 0;
    sum += some[i].square;
    sum_of_truth += truth[i].square;
  }
  std::printf("%d elements, %d measured: %d beyond their bounds, squares %.3g of %.3g\n", all,
              all / 16, exceeded, sum, sum_of_truth);
  EXPECT_LE(exceeded, all / 20);
}

TEST(UnjudgedErrors, LeaveScenesAloneInWhichAllSurfacesCount) {
  Scene scene = dark_floor(0.0f);
  scene.materials[0].reflectance.setConstant(0.5f);
  scene.materials[1].reflectance.setConstant(0.5f);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  RadiositySolution solution = even_light(scene, mesh);
  add_unjudged_errors({scene, caster, DirectLight(scene, mesh)}, {}, solution);
  EXPECT_TRUE((solution.interpolation_error == 0.0f).all());
}

}  // namespace
}  // namespace lightwell::unjudged_errors_test
