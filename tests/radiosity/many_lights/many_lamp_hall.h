#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "mesh/build_patches.h"
#include "scene/projected_picture.h"
#include "tests/radiosity/many_lights/random_lamps.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::test {

/// A beam narrower than a step of IntensityByAngle, beside a wide part that ends at once at 130
/// degrees and is twice as bright along C = 90 as along C = 0.
inline SharedWeb narrow_web() {
  Eigen::ArrayXXd values(2, 5);
  values << 1.0, 1.0, 9.0, 1.0, 0.5,  //
      1.0, 1.0, 9.0, 2.0, 1.0;
  return std::make_shared<const PhotometricWeb>(
      std::vector<double>{0.0, 90.0}, std::vector<double>{0.0, 17.0, 17.5, 18.0, 130.0}, values);
}

/// A picture of 8 x 6 texels of many colours; every other one in focus at 3 m alone.
inline SharedPicture colour_picture(int k) {
  std::vector<Texture::Code> codes;
  for (int i = 0; i < 8 * 6 * 3; ++i) {
    codes.push_back(static_cast<Texture::Code>(65535.0 * uniform(i, 40)));
  }
  ProjectorOptics optics{.beam = 0.2 + uniform(k, 41), .shutters = {.left = 0.3 * uniform(k, 42)}};
  if (k % 2 == 0) optics.focus = 3.0;
  return std::make_shared<const ProjectedPicture>(
      std::make_shared<const PictureSums>(std::make_shared<const Texture>(8, 6, 3, codes)), optics,
      RgbBasis());
}

/// A black hall of 20 x 20 x 6 m with screens, `panels` that face everywhere, and `lamps`: spots,
/// lamps with openings, measured ones, coloured ones that project a picture, and even ones.
struct ManyLampHall {
  Scene scene;
  PatchMesh mesh;

  /// `down`: panels face down instead.
  ManyLampHall(int panels, int lamps, bool down = false) {
    const int black = add_material(scene, diffuse(scene.bands, 0.0f));
    add_box(scene, {-10, -10, 0}, {10, 10, 6}, {black, black, black, black, black, black}, true);
    const int screens = 6;
    for (int k = 0; k < screens; ++k) {
      const double x = -8.0 + 3.0 * k;
      add_box(scene, {x, -4, 1}, {x + 0.2, 4, 4}, {black, black, black, black, black, black},
              false);
    }
    for (int k = 0; k < panels; ++k) {
      const float M = 1.0f + 9.0f * static_cast<float>(uniform(k, 1));
      const int bright = add_material(scene, diffuse(scene.bands, 0.0f, M));
      const Eigen::Vector3d at = place_of_lamp(k, 2);
      const Eigen::Vector3d normal =
          down ? Eigen::Vector3d(-Eigen::Vector3d::UnitZ()) : unit_direction(k, 5);
      Eigen::Vector3d a, b;
      tangent_frame(normal, a, b);
      const double h = 0.02 + 0.1 * uniform(k, 7);
      add_polygon(scene, "panel" + std::to_string(k), bright,
                  {at - h * a - h * b, at + h * a - h * b, at + h * a + h * b, at - h * a + h * b});
    }
    for (int k = 0; k < lamps; ++k) {
      Lamp lamp = random_lamp(k, scene.bands);
      if (k % 6 == 2) lamp.shape = narrow_web();
      if (k % 6 == 5) {
        lamp.shape = colour_picture(k / 6);
        lamp.intensity *= Eigen::Array3f(1.0f, 0.2f, 0.5f);
      }
      scene.lamps.push_back(lamp);
    }
    mesh = build_patches(scene, {.max_patch_size = 4.0, .elements_per_patch_edge = 1});
  }
};

/// A point in the air of the hall.
inline SurfacePoint point_in_hall(int k) {
  return {.position = {-9.0 + 18.0 * uniform(k, 30), -9.0 + 18.0 * uniform(k, 31),
                       0.1 + 4.0 * uniform(k, 32)},
          .normal = unit_direction(k, 33),
          .facet = -1};
}

}  // namespace lightwell::test
