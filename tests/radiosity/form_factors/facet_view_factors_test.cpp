#include "radiosity/form_factors/facet_view_factors.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scene/errors.h"
#include "scene/io/polygon_arrays.h"

namespace lightwell::facet_view_factors_test {
namespace {

// Unit squares that face each other at distance 1.
NumberedScene plates() {
  Scene scene;
  const Spectrum black = constant_spectrum(scene.bands, 0.0f);
  scene.materials = {{.name = "black", .reflectance = black, .specular = black, .emission = black}};
  scene.surfaces = {{.name = "floor"}, {.name = "ceiling"}};
  return scene_of_polygons(
      scene,
      {.vertices =
           {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
       .corners = {0, 1, 2, 3, 7, 6, 5, 4},
       .first = {0, 4, 8},
       .surface = {0, 1}});
}

// F_12 of unit squares at distance 1 (Howell's catalogue, C-11).
constexpr double plates_F = 0.199824895698387;

TEST(FacetViewFactors, AreThoseOfParallelPlatesByEveryMethod) {
  const NumberedScene numbered = plates();
  const FacetCheck check = check_facets(numbered.scene);
  for (const NamedFormFactorMethod& known : form_factor_methods) {
    FacetViewFactorOptions options;
    options.method = known.method;
    const FacetViewFactors found = facet_view_factors(numbered, check, options);
    ASSERT_EQ(found.factors.row_count(), 2);
    // Closed forms are rounded to floats twice. Rays have the target as standard error, here at
    // most four of them. Hemicubes of 256 cells are good to a hundredth.
    const bool is_closed = known.name == "auto" || known.name == "analytic";
    const double tolerance = is_closed ? 2 * 6e-8 : known.name == "ray-cast" ? 4e-3 : 1e-2;
    EXPECT_NEAR(found.factors.factor(0, 1), plates_F, tolerance) << known.name;
    EXPECT_EQ(found.error.has_value(), known.name != "hemicube") << known.name;
  }
}

TEST(FacetViewFactors, OfPatchesHaveARowEach) {
  const NumberedScene numbered = plates();
  const FacetViewFactors found =
      facet_view_factors(numbered, check_facets(numbered.scene), {.max_patch_size = 0.5});
  ASSERT_EQ(found.factors.row_count(), 8);  // 2 x 2 patches each
  EXPECT_EQ(found.rows.facet, (std::vector<int>{1, 1, 1, 1, 2, 2, 2, 2}));
  double sum = 0.0;  // of the floor's light that reaches the ceiling
  for (int i = 0; i < 4; ++i) {
    for (int j = 4; j < 8; ++j) sum += 0.25 * found.factors.factor(i, j);
  }
  EXPECT_NEAR(sum, plates_F, 4 * 2 * 6e-8);
}

TEST(FacetViewFactors, SayRowsAndPhasesAndStopByAnException) {
  const NumberedScene numbered = plates();
  const FacetCheck check = check_facets(numbered.scene);
  std::string phases;
  FacetViewFactorOptions options;
  options.phase_done = [&](const char* phase) { phases += std::string(phase) + " "; };
  facet_view_factors(numbered, check, options);
  EXPECT_EQ(phases, "mesh form_factors ");
  options.rows_found = [](const ViewFactorRows& rows) {
    throw InputError("there are " + std::to_string(rows.count()));
  };
  EXPECT_THROW(facet_view_factors(numbered, check, options), InputError);
  options.rows_found = {};
  options.progress = [](std::string_view, double) { return false; };
  EXPECT_THROW(facet_view_factors(numbered, check, options), Interrupted);
}

}  // namespace
}  // namespace lightwell::facet_view_factors_test
