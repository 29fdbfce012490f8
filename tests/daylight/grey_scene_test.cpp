#include "daylight/grey_scene.h"

#include <gtest/gtest.h>

#include "tests/radiosity/test_scenes.h"

namespace lightwell::grey_scene_test {

TEST(GreyScene, OfEqualBandsHasOneBand) {
  Scene scene;
  test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  Material glass = test::diffuse(scene.bands, 0.0f);
  glass.dielectric = Dielectric{.tint = constant_spectrum(scene.bands, 0.9f), .thin = true};
  test::add_material(scene, glass);
  const Scene one = with_one_band_if_grey(scene);
  EXPECT_EQ(one.bands.count(), 1);
  EXPECT_EQ(one.materials[0].reflectance.size(), 1);
  EXPECT_EQ(one.materials[0].reflectance[0], 0.5f);
  EXPECT_EQ(one.materials[1].dielectric->tint[0], 0.9f);
  EXPECT_EQ(one.materials[1].dielectric->absorption.size(), 0);
  Spectrum watt = Spectrum::Ones(1);
  EXPECT_GT(luminous(one.bands, watt), 0.0);
}

TEST(GreyScene, OneColourKeepsAllBands) {
  for (const bool in_tint : {false, true}) {
    Scene scene;
    Material material = test::diffuse(scene.bands, 0.5f);
    material.dielectric = Dielectric{.tint = constant_spectrum(scene.bands, 0.9f)};
    (in_tint ? material.dielectric->tint : material.reflectance)[2] = 0.4f;
    test::add_material(scene, material);
    EXPECT_EQ(with_one_band_if_grey(scene).bands.count(), 3);
  }
}

}  // namespace lightwell::grey_scene_test
