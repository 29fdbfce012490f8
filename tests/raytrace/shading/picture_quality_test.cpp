#include "raytrace/shading/picture_quality.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "raytrace/cameras/choose_camera.h"
#include "scene/errors.h"

namespace lightwell::picture_quality_test {
namespace {

TEST(PictureOptions, OfGoodPicturesAreTheDefaults) {
  const RenderOptions options = picture_options("auto", "good", picture_quality("good"));
  const RenderOptions usual;
  EXPECT_EQ(options.pass, usual.pass);
  EXPECT_EQ(options.photons, usual.photons);
  EXPECT_EQ(options.sampling.noise, usual.sampling.noise);
  EXPECT_EQ(options.shadows.max_rays, usual.shadows.max_rays);
  EXPECT_EQ(options.max_subdivision, usual.max_subdivision);
}

TEST(PictureOptions, AreValidForEveryName) {
  for (const std::string& pass : pass_names()) {
    for (const std::string& quality : picture_quality_names()) {
      const RenderOptions options = picture_options(pass, quality, picture_quality(quality));
      EXPECT_NO_THROW(validate(options)) << pass << " " << quality;
      const bool is_quick = pass == "virtual-lights" && quality == "draft";
      EXPECT_EQ(options.pass == Pass::interpolate, pass == "interpolate" || is_quick);
      EXPECT_LE(options.shadows.min_rays, options.shadows.max_rays);
    }
  }
}

TEST(PictureOptions, RefuseOtherNamesAndListTheRightOnes) {
  EXPECT_THROW(picture_quality("best"), std::invalid_argument);
  try {
    picture_options("both", "good", picture_quality("good"));
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()),
              "there is no pass 'both'; choose from: auto, interpolate, direct, gather, "
              "virtual-lights");
  }
}

TEST(ChooseCamera, FindsByNameOrSaysWhatThereIs) {
  Scene scene;
  EXPECT_THROW(choose_camera(scene, ""), InputError);
  scene.cameras = {{.name = "door"}, {.name = "window"}};
  EXPECT_EQ(choose_camera(scene, "").name, "door");
  EXPECT_EQ(choose_camera(scene, "window").name, "window");
  try {
    choose_camera(scene, "windwo");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("Did you mean 'window'?"), std::string::npos);
  }
}

}  // namespace
}  // namespace lightwell::picture_quality_test
