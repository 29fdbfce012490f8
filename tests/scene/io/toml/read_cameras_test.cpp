// [[cameras]] tables: projections, lenses, windows, and what is wrong with them.
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::read_cameras_test {
namespace {

Scene read_camera_scene(const std::string& keys) {
  const TemporaryFolder folder;
  return read_scene(folder.write("room.toml",
                                 "unit = \"cm\"\n[materials.white]\nreflectance = 0.5\n"
                                 "[[surfaces]]\nmaterial = \"white\"\n"
                                 "polygon = [[0, 0, 0], [100, 0, 0], [0, 100, 0]]\n"
                                 "[[cameras]]\nname = \"eye\"\nposition = [10, 20, 30]\n"
                                 "direction = [0, 0, -1]\n" +
                                     keys));
}

Camera camera(const std::string& keys) {
  return read_camera_scene(keys).cameras.at(0);
}

TEST(ReadCameras, EveryProjectionHasItsUsualAngleAndSize) {
  for (const NamedProjection& kind : named_projections) {
    const bool is_parallel = kind.projection == Projection::orthographic;
    const Camera read = camera("projection = \"" + std::string(kind.name) + "\"\n" +
                               (is_parallel ? "view_width = 250\n" : ""));
    EXPECT_EQ(read.projection, kind.projection);
    EXPECT_EQ(read.fov_degrees, kind.usual) << kind.name;
    EXPECT_EQ(projection_fault(read), "") << kind.name;
    EXPECT_DOUBLE_EQ(read.view_width, is_parallel ? 2.5 : 1.0);
  }
  EXPECT_EQ(camera("projection = \"equirectangular\"\n").width, 1024);
  EXPECT_EQ(camera("projection = \"equirectangular\"\n").height, 512);
  EXPECT_EQ(camera("projection = \"cube\"\n").height, 1024);
  EXPECT_EQ(camera("").fov_degrees, 40.0);
}

TEST(ReadCameras, KeysAreRead) {
  const Camera lens = camera(
      "shift = [0.1, -0.25]\nnear = 50\nfar = 800\nsize = [200, 100]\n"
      "crop = [0.25, 0.1, 0.75, 0.5]\ndistortion = { k1 = -0.2, p2 = 0.01 }\n");
  EXPECT_EQ(lens.shift, Eigen::Vector2d(0.1, -0.25));
  EXPECT_DOUBLE_EQ(lens.near_distance, 0.5);
  EXPECT_DOUBLE_EQ(lens.far_distance, 8.0);
  EXPECT_EQ(lens.width, 100);
  EXPECT_EQ(lens.height, 40);
  EXPECT_EQ(lens.distortion.k1, -0.2);
  EXPECT_EQ(lens.distortion.p2, 0.01);
  EXPECT_EQ(lens.distortion.k2, 0.0);
  const Camera eyes = camera("projection = \"stereo\"\neye_separation = 7\n");
  EXPECT_DOUBLE_EQ(eyes.eye_separation, 0.07);
  EXPECT_EQ(camera("projection = \"fisheye\"\nfov = 120\ncircle = 360\n").circle_degrees, 360.0);
}

TEST(ReadCameras, WhatIsWrongIsNamedWithItsLine) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"projection = \"fishey\"\n", "is 'fishey'; choose 'perspective'"},
      {"projection = \"fishey\"\n", "Did you mean 'fisheye'?"},
      {"fov = 360\n", "room.toml:11:"},
      {"fov = 360\n", "it must lie between 0 and 180, so choose the projection 'fisheye'"},
      {"fov = 180\n", "it must lie between 0 and 180"},
      {"projection = \"hemispherical\"\nfov = 200\n", "room.toml:12:"},
      {"projection = \"hemispherical\"\nfov = 200\n", "shows angles above 0 and up to 180"},
      {"projection = \"stereographic\"\nfov = 360\n", "shows angles above 0 and below 360"},
      {"projection = \"orthographic\"\n", "view_width"},
      {"projection = \"orthographic\"\nfov = 40\n", "give 'view_width'"},
      {"view_width = 40\n", "give 'fov', an angle, or the projection 'orthographic'"},
      {"projection = \"cube\"\nfov = 90\n", "six faces show everything"},
      {"projection = \"cube\"\nsize = [300, 300]\n", "give 300 x 200"},
      {"projection = \"equirectangular\"\nsize = [300, 300]\n", "give at most 300 x 150"},
      {"circle = 200\n", "only fisheyes have a circle"},
      {"eye_separation = 6\n", "give the projection 'stereo'"},
      {"near = -1\n", "near"},
      {"near = 5\nfar = 4\n", "must lie behind the beginning"},
      {"shift = [1]\n", "two shares of the picture"},
      {"crop = [0.5, 0, 0.4, 1]\n", "in rising order"},
      {"crop = [0, 1]\n", "four shares"},
      {"distortion = { k4 = 1 }\n", "k4"},
      {"distortion = { k1 = 1e9 }\n", "coefficients lie between"},
      {"projection = \"fisheye\"\ndistortion = { k1 = 0.1 }\n", "only perspective cameras"},
      {"projection = \"fisheye\"\nf_number = 4\nfocus_distance = 100\n", "have a lens"},
      {"projection = \"stereo\"\ncrop = [0, 0, 0.5, 1]\n", "render the whole picture"},
      {"zoom = 2\n", "zoom"},
  };
  for (const auto& [keys, wanted] : cases) {
    EXPECT_TRUE(says(message_of<InputError>([&, &k = keys] { read_camera_scene(k); }), wanted))
        << keys;
  }
}

}  // namespace
}  // namespace lightwell::read_cameras_test
