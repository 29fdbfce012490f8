#include "scene/io/sheets.h"

#include <gtest/gtest.h>

#include <vector>

#include "scene/coat.h"
#include "scene/io/glossy.h"
#include "scene/optics.h"
#include "scene/specular.h"
#include "tests/pictures.h"

namespace lightwell::sheets_test {
namespace {

Spectrum grey(float value) {
  return Spectrum::Constant(3, value);
}

Material opaque(float reflectance, float specular = 0.0f) {
  return {.reflectance = grey(reflectance),
          .specular = grey(specular),
          .emission = grey(0.0f),
          .one_sided = true};
}

TEST(Sheets, HaveTwoSidesOnceLightPasses) {
  Material material = opaque(0.5f);
  add_transmittance(material, grey(0.0f), 0.0);
  add_diffuse_transmittance(material, grey(0.0f));
  EXPECT_TRUE(material.one_sided);
  EXPECT_EQ(material.transmittance.size() + material.regular_transmittance.size(), 0);
  Material paper = material, gauze = material;
  add_diffuse_transmittance(paper, grey(0.1f));
  add_regular_transmittance(gauze, grey(0.1f));
  EXPECT_FALSE(paper.one_sided || gauze.one_sided);
}

TEST(Sheets, LightWithALobePassesStraightOrDiffusely) {
  Material material = opaque(0.2f);
  add_transmittance(material, grey(0.25f), straight_alpha);
  add_transmittance(material, grey(0.25f), straight_alpha);
  add_transmittance(material, grey(0.125f), 2.0 * straight_alpha);
  EXPECT_FLOAT_EQ(material.regular_transmittance[0], 0.5f);
  EXPECT_FLOAT_EQ(material.transmittance[0], 0.125f);
}

// A quarter of the surface is holes: the other three quarters keep their shares.
TEST(Sheets, OpacityScalesEveryShareAndLetsTheRestThrough) {
  Material material = opaque(0.4f, 0.2f);
  material.transmittance = grey(0.2f);
  material.regular_transmittance = grey(0.1f);
  material.texture = ReflectanceTexture{.image = picture_of(1, 1, {0.5f}), .factor = grey(0.8f)};
  let_through(material, grey(0.75f));
  EXPECT_FLOAT_EQ(material.reflectance[0], 0.3f);
  EXPECT_FLOAT_EQ(material.specular[1], 0.15f);
  EXPECT_FLOAT_EQ(material.transmittance[2], 0.15f);
  EXPECT_FLOAT_EQ(material.regular_transmittance[0], 0.075f + 0.25f);
  EXPECT_FLOAT_EQ(material.texture->factor[0], 0.6f);
  EXPECT_FALSE(material.one_sided);
  Material whole = opaque(0.4f);
  let_through(whole, grey(1.0f));
  EXPECT_TRUE(whole.one_sided && !whole.passes_straight());
}

TEST(Sheets, PicturesCutHolesUnlessMostTexelsAreBetween) {
  const auto opacity = [](const std::vector<float>& texels) {
    return even_opacity(*picture_of(static_cast<int>(texels.size()), 1, texels).picture);
  };
  EXPECT_FALSE(opacity({0.0f, 1.0f, 0.5f}));
  EXPECT_FALSE(opacity({0.95f, 0.95f}));
  // Texels have 16 bits, of the square root: steps of 2e-5 here.
  EXPECT_NEAR(opacity({0.3f, 0.3f}).value_or(0.0f), 0.3f, 2e-5f);
  EXPECT_NEAR(opacity({0.2f, 0.6f, 1.0f}).value_or(0.0f), 0.6f, 2e-5f);
}

TEST(Sheets, LampsAreClosed) {
  Material lamp = opaque(0.4f);
  let_through(lamp, grey(0.5f));
  EXPECT_FALSE(close_lamp(lamp));
  lamp.emission = grey(1.0f);
  EXPECT_TRUE(close_lamp(lamp));
  EXPECT_FALSE(lamp.passes_straight() || close_lamp(lamp));
}

// A coated sheet under even light on both sides sends on the share of a coated base of the
// reflectance rho + tau. Light that is opposite on both sides leaves a sheet of rho = tau as
// nothing, so rho and tau stay alike.
TEST(Sheets, CoatsCoverBothSidesOfATranslucentBase) {
  Material opal = opaque(0.5f), white = opaque(0.8f), even = opaque(0.3f);
  opal.transmittance = grey(0.3f);
  even.transmittance = grey(0.3f);
  for (Material* material : {&opal, &white, &even}) lay_coat(*material, 1.5, 0.0, grey(1.0f));
  // Sums and differences of a few floats below 1.
  EXPECT_NEAR(opal.reflectance[0] + opal.transmittance[0], white.reflectance[0], 1e-6f);
  EXPECT_NEAR(even.reflectance[0], even.transmittance[0], 1e-6f);
  EXPECT_LE((opal.reflectance + opal.transmittance + mean_specular(opal)).maxCoeff(), 1.0f);
  EXPECT_LT(opal.transmittance[0], 0.3f);
  Material gauze = opaque(0.0f);
  gauze.regular_transmittance = grey(1.0f);
  lay_coat(gauze, 1.5, 0.0, grey(1.0f));
  EXPECT_NEAR(mean_specular(gauze)[0], 1.0f, 1e-6f);
}

}  // namespace
}  // namespace lightwell::sheets_test
