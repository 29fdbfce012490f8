// Pictures of every projection: what their pixels show, and what is measured in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "raytrace/cameras/camera_ray.h"
#include "raytrace/cameras/pixel_solid_angle.h"
#include "raytrace/display/light_meter.h"
#include "raytrace/pictures/image.h"
#include "raytrace/readings/probe.h"
#include "tests/raytrace/lit_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::projected_pictures_test {
namespace {

using std::numbers::pi;

// Irradiance of the walls of a room, which is continuous around its edges, and which elements
// interpolate exactly.
float field(const Eigen::Vector3d& p) {
  return static_cast<float>(10 + p.x() + 2 * p.y() + 3 * p.z());
}

// A white cube of edge 2 about the origin, seen from inside.
TracedScene room() {
  return TracedScene(
      SceneBuilder()
          .box({.reflectance = 1.0f, .one_sided = true}, {-1, -1, -1}, {1, 1, 1}, true)
          .build());
}

// Radiance of the room along a ray from within.
double radiance(const Ray& ray) {
  double t = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis];
    if (d != 0.0) t = std::min(t, ((d > 0.0 ? 1.0 : -1.0) - ray.origin[axis]) / d);
  }
  return double{field(ray.origin + t * ray.direction)} / pi;
}

Camera camera_in_room(Projection projection) {
  Camera camera{.name = "test",
                .position = {0.1, -0.2, 0.15},
                .direction = Eigen::Vector3d(1, 0.3, -0.4).normalized(),
                .width = 96,
                .height = 96};
  camera.up = (Eigen::Vector3d(0, 0, 1) - camera.direction.z() * camera.direction).normalized();
  camera = with_projection(camera, projection);
  camera.view_width = 0.4;
  return camera;
}

// Expects the picture of a room to be between the radiances at the corners of each pixel, but for
// `slack` times their difference, and black where nothing is shown.
void expect_room(const Camera& camera, const Image& image, double slack) {
  const CameraRays rays(camera);
  int shown = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const int panel = rays.panel_at(x + 0.5, y + 0.5);
      const double L = image.radiance(Eigen::Index{y} * camera.width + x, 0);
      double low = std::numeric_limits<double>::infinity(), high = 0.0;
      int seen = 0;
      for (int c = 0; c < 4; ++c) {
        const auto ray = rays.ray_at(x + (c & 1), y + (c >> 1), panel);
        if (!ray) continue;
        ++seen;
        low = std::min(low, radiance(*ray));
        high = std::max(high, radiance(*ray));
      }
      if (seen == 4) {
        ++shown;
        // Float distances and radiances have an error of 1e-6.
        const double room = slack * (high - low) + 1e-4;
        EXPECT_GT(L, low - room) << named(camera.projection).name << " at " << x << ", " << y;
        EXPECT_LT(L, high + room) << named(camera.projection).name << " at " << x << ", " << y;
      } else if (pixel_solid_angle(camera, x, y) < 1e-12 && is_fisheye(camera.projection)) {
        EXPECT_EQ(L, 0.0) << x << ", " << y;
      }
    }
  }
  EXPECT_GT(shown, camera.width * camera.height / 2);
}

TEST(ProjectedPictures, EveryPixelShowsTheRoomInItsDirection) {
  TracedScene lit = room();
  lit.set_indirect(field);
  for (const NamedProjection& kind : named_projections) {
    const Camera camera = camera_in_room(kind.projection);
    // The light of a pixel is that of its points; edges of the room within it add at most as much
    // as the corners differ.
    expect_room(camera, lit.render(camera, {.pass = Pass::interpolate}), 1.0);
  }
}

TEST(ProjectedPictures, ManySamplesShowTheSame) {
  TracedScene lit = room();
  lit.set_indirect(field);
  RenderOptions options{.pass = Pass::interpolate};
  options.sampling.most = options.sampling.least = 16;
  for (const Projection projection :
       {Projection::equidistant, Projection::cube_map, Projection::stereo_panorama}) {
    const Camera camera = camera_in_room(projection);
    const Image image = lit.render(camera, options);
    if (is_fisheye(projection)) {
      // The filter, 3 pixels wide, takes in the black about the circle.
      const CameraRays rays(camera);
      const Eigen::Index middle = Eigen::Index{camera.height / 2} * camera.width + camera.width / 2;
      EXPECT_NEAR(image.radiance(middle, 0), radiance(rays.ray(48.5, 48.5)), 0.1);
      EXPECT_EQ(image.radiance(0, 0), 0.0f);
      continue;
    }
    // The filter is 3 pixels wide: its points are within 1 pixel of the pixel.
    expect_room(camera, image, 2.0);
  }
}

TEST(ProjectedPictures, AFisheyeMeasuresTheIlluminanceOfItsEye) {
  // A furnace, in which E = B and L = B / pi. Sum of L cos theta w over the pixels of half the
  // sphere. The cosine at a pixel's centre differs from its mean over the pixel of edge h by
  // h^2 / 24 times its curvature of 2, relative to 1. Pixels at the rim, whose radiance is that of
  // the part within the circle already, lie within h of cosine 0: 2 pi h times h / 2 of pi.
  constexpr float rho = 0.6f, M = 1.0f, B = M / (1.0f - rho);
  TracedScene lit(
      SceneBuilder()
          .box({.reflectance = rho, .exitance = M, .one_sided = true}, {0, 0, 0}, {2, 1, 1.5}, true)
          .build());
  lit.set_indirect([](const auto&) { return B; });
  Camera camera{.position = {0.7, 0.4, 0.8}, .direction = {1, 0, 0}, .up = {0, 0, 1}};
  camera.width = camera.height = 96;
  camera = with_projection(camera, Projection::equidistant);
  const Image image = lit.render(camera, {.pass = Pass::interpolate});
  const CameraRays rays(camera);
  double E = 0.0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const auto ray = rays.ray_at(x + 0.5, y + 0.5);
      if (!ray) continue;
      E += image.radiance(Eigen::Index{y} * camera.width + x, 0) * pixel_solid_angle(camera, x, y) *
           ray->direction.dot(camera.direction);
    }
  }
  const Probe probe{.position = camera.position, .normal = camera.direction};
  const BandArray measured =
      probe_irradiance(lit.scene, lit.caster, lit.direct_light, lit.solution, {&probe, 1});
  EXPECT_NEAR(measured(0, 0), B, 1e-4 * B);  // every ray finds B / pi
  const double h = pi / camera.width;
  EXPECT_NEAR(E, measured(0, 0), (h * h / 12 + h * h) * B + 1e-4 * B);
}

TEST(ProjectedPictures, AHemisphericalFisheyeMeasuresBySums) {
  // Pixels of r = sin theta have equal projected solid angles, so E is their mean times pi over the
  // share pi / 4 of the circle. A square luminaire of exitance M, 1 m ahead and 1 m wide.
  constexpr float M = 100.0f;
  const TracedScene lit(SceneBuilder()
                            .square({.exitance = M, .one_sided = true}, {1, 0, 0}, {-1, 0, 0}, 0.5)
                            .build());
  Camera camera{.position = {0, 0, 0}, .direction = {1, 0, 0}, .up = {0, 0, 1}};
  camera.width = camera.height = 64;
  camera = with_projection(camera, Projection::hemispherical);
  constexpr int levels = 4;
  const Image image = lit.render(camera, {.max_subdivision = levels});
  const double E = image.radiance.col(0).mean() * 4.0;
  // Form factor of a point to a quarter of the square, parallel to it: X = Y = 1/2.
  const double s = std::sqrt(1.25), quarter = 2 * 0.5 / s * std::atan(0.5 / s) / (2 * pi);
  // Each of about 4 * 32 pixels at the luminaire's edges has an error of at most half a cell's row,
  // 0.5 / 2^levels, of alternating sign; a bound without cancellation is 128 / 32 of 64^2 pixels.
  const double bound = M / pi * 4.0 * (128.0 / 32.0) / (64.0 * 64.0);
  EXPECT_NEAR(E, 4 * quarter * M, bound);
}

TEST(ProjectedPictures, ANearPlaneOpensTheRoom) {
  TracedScene lit = room();
  lit.set_indirect(field);
  Camera plan{.position = {0, 0, 3},
              .direction = {0, 0, -1},
              .up = {0, 1, 0},
              .width = 40,
              .height = 40,
              .projection = Projection::orthographic,
              .view_width = 1.8};
  const Image closed = lit.render(plan, {.pass = Pass::interpolate});
  EXPECT_EQ(closed.radiance.maxCoeff(), 0.0f);  // backs of the ceiling
  plan.near_distance = 2.5;
  const Image open = lit.render(plan, {.pass = Pass::interpolate});
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      // Linear, so the mean over a pixel is the value at its centre.
      const Eigen::Vector3d p(0.045 * (x - 19.5), 0.045 * (19.5 - y), -1);
      EXPECT_NEAR(open.radiance(40 * y + x, 0), field(p) / pi, 1e-4);
    }
  }
  plan.far_distance = 3.5;  // before the floor
  EXPECT_EQ(lit.render(plan, {.pass = Pass::interpolate}).radiance.maxCoeff(), 0.0f);
}

TEST(ProjectedPictures, CoverageIsTheShareWithinTheCircle) {
  TracedScene lit = room();
  lit.set_indirect(field);
  const Camera camera = camera_in_room(Projection::equidistant);
  const Image image = lit.render(
      camera, {.pass = Pass::interpolate, .layers = {Layer::depth, Layer::patch, Layer::coverage}});
  ASSERT_EQ(image.layers.names, (std::vector<std::string>{"depth.Z", "patch.id", "A"}));
  const auto coverage = image.layers.values.col(2);
  // About 4 sqrt 2 * 96 pixels at the circle have an error of 1/64 at most half a row of 8 points.
  EXPECT_NEAR(coverage.mean(), pi / 4, 543.0 / 16 / (96 * 96));
  EXPECT_EQ(coverage(0), 0.0f);
  EXPECT_EQ(coverage(96 * 48 + 48), 1.0f);
  EXPECT_EQ(image.layers.values(0, 0), std::numeric_limits<float>::infinity());
  EXPECT_EQ(image.layers.values(0, 1), -1.0f);
  // Beyond 90 degrees nothing is ahead: the depth of a picture that is not flat is a distance.
  const auto ray = CameraRays(camera).ray(20.5, 48.5);
  const double distance = image.layers.values(96 * 48 + 20, 0);
  EXPECT_NEAR(radiance(ray), field(ray.origin + distance * ray.direction) / pi, 1e-5);
}

TEST(ProjectedPictures, ExposureIsMeteredInEveryProjection) {
  TracedScene lit = room();
  lit.set_indirect([](const auto&) { return 7.0f; });
  for (const NamedProjection& kind : named_projections) {
    const auto incident = meter_incident_light(lit.caster, lit.solution.irradiance(), {},
                                               lit.solution.bands, camera_in_room(kind.projection));
    ASSERT_TRUE(incident) << kind.name;
    EXPECT_NEAR(incident->exposure, pi / 7, 1e-5) << kind.name;
  }
}

TEST(RadiancePicture, HasTheLuminanceOfThePixels) {
  const TemporaryFolder folder;
  Image image{.width = 3, .height = 2};
  image.radiance.resize(6, 3);
  image.radiance << 1, 1, 1, 0, 0, 0, 100, 3, 0.02f, 1e-6f, 2e-6f, 0, 5, 0, 0, 0, 0, 9e5f;
  const Bands bands = rgb_bands();
  write_hdr(folder / "a.hdr", image, bands, {"VIEW= -vta -vh 180 -vv 180"});
  const std::string text = content_of(folder / "a.hdr");
  EXPECT_TRUE(text.starts_with("#?RADIANCE\nVIEW= -vta -vh 180 -vv 180\nFORMAT=32-bit_rle_rgbe\n"));
  const std::string size = "\n\n-Y 2 +X 3\n";
  const std::size_t begin = text.find(size) + size.size();
  ASSERT_EQ(text.size(), begin + 6 * 4);
  for (int i = 0; i < 6; ++i) {
    const auto byte = [&](int k) {
      return static_cast<double>(static_cast<unsigned char>(text[begin + 4 * i + k]));
    };
    const double step = std::ldexp(1.0, static_cast<int>(byte(3)) - 136);
    // RADIANCE's programs add half a step to every mantissa.
    const double luminance =
        byte(3) == 0.0
            ? 0.0
            : 179 * step *
                  (0.265 * (byte(0) + 0.5) + 0.670 * (byte(1) + 0.5) + 0.065 * (byte(2) + 0.5));
    const double expected = luminous(bands, image.radiance.row(i).transpose());
    // Half a step of each mantissa: the largest is at least 128, and may be that of blue.
    EXPECT_NEAR(luminance, expected, 0.5 * 179 * step) << i;
  }
}

}  // namespace
}  // namespace lightwell::projected_pictures_test
