// Light of lamps that project a picture, at points and by rays.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "mesh/build_patches.h"
#include "mesh/patches/patch_sampler.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/paths/free_light.h"
#include "radiosity/paths/light_path.h"
#include "scene/projected_picture.h"
#include "scene/sampling.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::projected_light_test {
namespace {

/// A grey room with a block on its floor.
Scene room() {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const std::array<int, 6> all = {grey, grey, grey, grey, grey, grey};
  test::add_box(scene, {0, 0, 0}, {4, 5, 3}, all, true);
  test::add_box(scene, {1, 1, 0}, {1.6, 1.7, 1.2}, all, false);
  return scene;
}

/// A picture of 4 x 2 texels, red, green, blue and white above grey and black.
Lamp projector(double focus = std::numeric_limits<double>::infinity()) {
  const Texture::Code one = 65535, some = 30000;
  const std::vector<Texture::Code> codes = {one, 0, 0, 0, one, 0, 0,    0,    one,  one, one, one,
                                            0,   0, 0, 0, 0,   0, some, some, some, 0,   0,   0};
  Lamp lamp{.name = "projector",
            .position = {2.0, 2.5, 2.5},
            .axes = lamp_axes({0.2, 0.1, -1.0}),
            .intensity = Eigen::Array3f(10.0f, 20.0f, 5.0f)};
  lamp.shape = std::make_shared<const ProjectedPicture>(
      std::make_shared<const PictureSums>(std::make_shared<const Texture>(4, 2, 3, codes)),
      ProjectorOptics{.beam = 1.3, .focus = focus}, RgbBasis());
  return lamp;
}

// E = I cos / r^2 with I = intensity * T / cos^3 of the angle to the axis, in each colour.
TEST(ProjectedLight, PicturesLightEachTexelsPartOfAWall) {
  Scene scene = room();
  const Lamp lamp = projector();
  scene.lamps = {lamp};
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  const auto& picture = std::get<SharedPicture>(lamp.shape)->slide().picture();
  const double texel = 2.0 * std::tan(0.65) / 4.0;
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x) {
      const Eigen::Vector3d way =
          lamp.axes * Eigen::Vector3d((x - 1.6) * texel, (0.6 - y) * texel, -1.0);
      // The point where the ray meets a plane across z below the lamp.
      const Eigen::Vector3d at = lamp.position - way * (0.4 / way.z());
      const Eigen::Vector3d to = lamp.position - at;
      const double cos_axis = 1.0 / way.norm();
      const double kernel = to.z() / std::pow(to.norm(), 3) / std::pow(cos_axis, 3);
      const Spectrum expected =
          lamp.intensity * picture.texel(0, x, y) * static_cast<float>(kernel);
      const Spectrum E = light.irradiance(caster, {.at = {at, Eigen::Vector3d::UnitZ()}, .key = 7});
      // Colour, kernel and light are floats.
      EXPECT_LT((E - expected).abs().maxCoeff(), 8.0f * 0x1p-24f * expected.maxCoeff() + 1e-12f)
          << x << ' ' << y;
    }
  }
}

// Rays bring each band to patches as points see it, and carry exactly the flux.
TEST(ProjectedLight, RaysOfPicturesAgreeWithPoints) {
  for (const double focus : {std::numeric_limits<double>::infinity(), 1.0}) {
    Scene scene = room();
    const Lamp lamp = projector(focus);
    scene.lamps = {lamp};
    const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
    const ElementCaster caster(mesh);
    const DirectLight light(scene, mesh);
    const LightPaths paths(scene, caster, 8);
    const FreeLight cast = cast_free_light(scene, caster, paths, light, 1 << 18);
    const Eigen::ArrayXd flux = lamp_flux(lamp).cast<double>();
    // The flux is a float.
    EXPECT_LT(((cast.emitted - flux) / flux).abs().maxCoeff(), 4.0 * 0x1p-24);
    EXPECT_EQ(cast.missed.maxCoeff(), 0.0);
    Eigen::ArrayXd arrived = Eigen::ArrayXd::Zero(3), seen = arrived;
    double difference = 0.0;
    for (int p = 0; p < mesh.patch_count(); ++p) {
      const PatchSampler sampler(mesh, p);
      constexpr int points = 1024;
      const SobolPoints sobol(points);
      Spectrum E = Spectrum::Zero(3);
      for (int i = 0; i < points; ++i) {
        const Eigen::Array4f u = sobol.point(i, static_cast<std::uint64_t>(p));
        const PatchPoint at = sampler.point(u[0], u[1]);
        E += light.irradiance(caster, {.at = {at.position, at.normal, mesh.facet[at.element]},
                                       .key = static_cast<std::uint64_t>(i)}) /
             float{points};
      }
      const Eigen::ArrayXd of_patch = mesh.area[p] * E.cast<double>();
      const Eigen::ArrayXd of_rays =
          mesh.area[p] * cast.irradiance.row(p).transpose().cast<double>();
      difference += (of_patch - of_rays).abs().sum();
      arrived += of_rays;
      seen += of_patch;
    }
    // All light meets the diffuse inside of the box; sums of 2^18 float weights.
    EXPECT_LT(((arrived - flux) / flux).abs().maxCoeff(), 1e-5);
    // 1024 points of a patch miss an edge of colour or shadow by 1024^(-3/4) of the patch. The lens
    // is a twentieth of the way, whose square changes light on walls along the axis.
    EXPECT_LT(((seen - flux) / flux).abs().maxCoeff(), 0.01);
    EXPECT_LT(difference / flux.sum(), 0.02);
  }
}

}  // namespace
}  // namespace lightwell::projected_light_test
