// The sky in pictures: directly visible, mirrored, and with the same light in every pass.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "radiosity/refine/error_reference.h"
#include "radiosity/solution/relight.h"
#include "radiosity/solve.h"
#include "raytrace/render.h"
#include "raytrace/shading/dome_on_mesh.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::daylight_test {
namespace {

using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;

Sky grey_sky(const Bands& bands, float radiance) {
  return {.up = Vector3d::UnitZ(),
          .north = Vector3d::UnitY(),
          .bright = Vector3d::UnitZ(),
          .scale = constant_spectrum(bands, radiance),
          .ground = constant_spectrum(bands, 0.25f * radiance)};
}

Camera looking(const Vector3d& from, const Vector3d& direction, double fov) {
  Camera camera{.position = from, .direction = direction.normalized(), .fov_degrees = fov};
  camera.up = camera.direction.unitOrthogonal();
  camera.width = camera.height = 8;
  return camera;
}

Image picture(const Scene& scene, const Camera& camera, Pass pass) {
  const SolvedScene solved = solve_scene(scene, {.form_factors = {.rays_per_patch = 128},
                                                 .gather = {.rays = 128},
                                                 .refine = {.tolerance = 0.0},
                                                 .error_points = 0});
  const ElementCaster caster(solved.mesh);
  const DirectLight light(scene, solved.mesh);
  return render(scene, caster, light, solved.solution, camera,
                {.pass = pass, .photons = 0, .max_subdivision = 0});
}

TEST(DaylightPictures, ShowTheSkyTheGroundAndTheSun) {
  Scene scene =
      SceneBuilder().square({.reflectance = 0.5f}, {0, 0, 0}, Vector3d::UnitZ(), 1).build();
  scene.sky = grey_sky(scene.bands, 4.0f);
  const Vector3d to_sun = Vector3d(1, 2, 2).normalized();
  scene.sky->sun = Sun{.direction = to_sun, .irradiance = constant_spectrum(scene.bands, 10.0f)};
  const auto mean = [&](const Vector3d& direction, double fov) {
    return static_cast<double>(
        picture(scene, looking({0, 0, 5}, direction, fov), Pass::direct).radiance.mean());
  };
  constexpr double rounding = 1e-6;  // relative error of weighted means in floats
  EXPECT_NEAR(mean({1, -1, 0.5}, 2.0), 4.0, 4.0 * rounding);
  EXPECT_NEAR(mean({1, -1, -0.2}, 2.0), 1.0, rounding);
  const double of_sun = 10.0 / scene.sky->sun->solid_angle();
  EXPECT_NEAR(mean(to_sun, 0.1), 4.0 + of_sun, rounding * of_sun);
  // Open ground has no noise: L = rho (pi L_sky + E_sun cos) / pi.
  EXPECT_NEAR(mean({0, 0, -1}, 5.0), 0.5 * (pi * 4.0 + 10.0 * 2.0 / 3.0) / pi, 4.0 * rounding);
}

TEST(DaylightPictures, MirrorShowsTheSkyBehind) {
  Scene scene = SceneBuilder()
                    .square({.reflectance = 0.5f}, {0, 0, -3}, Vector3d::UnitZ(), 1)
                    .square({.specular = 0.5f}, {0, 0, 0}, Vector3d::UnitZ(), 1)
                    .build();
  scene.sky = grey_sky(scene.bands, 4.0f);
  const Image image = picture(scene, looking({0, 0, 5}, {0, 0, -1}, 5.0), Pass::direct);
  EXPECT_NEAR(image.radiance.mean(), 2.0f, 2e-6f);
}

// A room of 3 m x 3 m x 2 m without its eastern wall, under a sky.
Scene room_under_a_sky() {
  Scene scene = SceneBuilder()
                    .square({.reflectance = 0.5f}, {0, 0, 0}, Vector3d::UnitZ(), 1.5)
                    .square({.reflectance = 0.5f}, {0, 0, 2}, -Vector3d::UnitZ(), 1.5)
                    .square({.reflectance = 0.5f}, {-1.5, 0, 1}, Vector3d::UnitX(), 1.5)
                    .square({.reflectance = 0.5f}, {0, 1.5, 1}, -Vector3d::UnitY(), 1.5)
                    .square({.reflectance = 0.5f}, {0, -1.5, 1}, Vector3d::UnitY(), 1.5)
                    .build();
  scene.sky = grey_sky(scene.bands, 4.0f);
  return scene;
}

TEST(DaylightPictures, PassesAgreeInARoomWithAWindow) {
  Scene scene = room_under_a_sky();
  const Camera camera = looking({-0.8, 0, 1.9}, {0.2, 0, -1}, 40.0);
  const double interpolated = picture(scene, camera, Pass::interpolate).radiance.mean();
  const double direct = picture(scene, camera, Pass::direct).radiance.mean();
  const double gathered = picture(scene, camera, Pass::gather).radiance.mean();
  // Each of 64 pixels has 128 rays of its own with a noise of a tenth: 0.1 / 8. Linear
  // interpolation of curved light has an error of (element / room)^2, here 1 %.
  EXPECT_NEAR(direct, interpolated, 0.02 * interpolated);
  EXPECT_NEAR(gathered, interpolated, 0.02 * interpolated);
}

// The room with a lamp.
Scene lit_by_two() {
  Scene scene = room_under_a_sky();
  scene.lamps.push_back(
      {.name = "lamp", .position = {0, 0, 1.5}, .intensity = constant_spectrum(scene.bands, 2.0f)});
  return scene;
}

// Relative error of interpolation to which elements are refined: well below
// DomeOnMesh::small_error, so that the dome's light comes from the mesh.
constexpr double mesh_error = 0.005;

// The scene of lit_by_two(), with an estimate of its error.
struct Solved {
  explicit Solved(bool by_kind)
      : solved(solve_scene(scene,
                           {.gather = {.rays = 256},
                            .refine = {.tolerance = mesh_error},
                            .channels = by_kind ? channels_by_kind(scene) : EmitterChannels{}})) {}

  Image picture(Pass pass) const {
    Camera camera = looking({-0.8, 0, 1.9}, {0.2, 0, -1}, 40.0);
    camera.width = camera.height = 24;
    return render(scene, ElementCaster(solved.mesh), DirectLight(scene, solved.mesh),
                  solved.solution, camera, {.pass = pass, .max_subdivision = 0});
  }

  Scene scene = lit_by_two();
  SolvedScene solved;
};

// Mean square of the second differences along rows, in which smooth light is almost nothing, over
// the square of the mean.
double graininess(const Image& image) {
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 1; x + 1 < image.width; ++x, ++count) {
      const auto at = [&](int column) {
        return double{image.radiance.row(y * image.width + column).mean()};
      };
      const double bend = at(x - 1) - 2.0 * at(x) + at(x + 1);
      sum += bend * bend;
    }
  }
  const double mean = image.radiance.mean();
  return sum / count / (mean * mean);
}

TEST(DaylightPictures, TheSkyKeptApartComesFromTheMeshWithoutNoise) {
  const Solved apart(true);
  const Image direct = apart.picture(Pass::direct), automatic = apart.picture(Pass::automatic);
  // The solution is off by its estimate at most, twice in a hundred pictures; the noise of the
  // shadow rays, a few per cent of a pixel, has a mean over 576 pixels of a twentieth of that.
  ASSERT_GT(apart.solved.solution.error_estimate, 0.0);
  EXPECT_NEAR(automatic.radiance.mean(), direct.radiance.mean(),
              (2.0 * apart.solved.solution.error_estimate + 0.002) * direct.radiance.mean());
  // Second differences of smooth light are nothing. The mesh has kinks, of twice its error, in at
  // most every fourth pixel of a row; shadow rays have noise beyond that.
  constexpr double of_kinks = 0.25 * 4.0 * mesh_error * mesh_error;
  std::printf("graininess: %.3g direct, %.3g automatic\n", graininess(direct),
              graininess(automatic));
  EXPECT_GT(graininess(direct), of_kinks);
  EXPECT_LT(graininess(automatic), of_kinks);
}

TEST(DaylightPictures, WithoutAChannelTheSkyComesByShadowRays) {
  const Solved together(false);
  EXPECT_TRUE(
      (together.picture(Pass::automatic).radiance == together.picture(Pass::direct).radiance)
          .all());
}

TEST(DaylightPictures, ASkyThatIsSwitchedOffLeavesTheLamp) {
  Solved apart(true);
  std::vector<Spectrum> scales = effective_scales(apart.solved.solution);
  scales[static_cast<std::size_t>(find_channel(apart.solved.solution, "sky"))].setZero();
  relight(apart.solved, scales);
  const Image direct = apart.picture(Pass::direct), automatic = apart.picture(Pass::automatic);
  // Nothing is left that the two passes compute in different ways.
  EXPECT_TRUE((automatic.radiance == direct.radiance).all());
}

// Errors are relative to the mean irradiance. Of light that is dimmed as a whole they stay; where
// the lamp is off, the sky's error is a greater share of what is left, and where the sky is dim, a
// smaller one.
TEST(DaylightPictures, ErrorsOfTheSkyFollowTheLightAsRelit) {
  const Solved apart(true);
  const auto sky = static_cast<std::size_t>(find_channel(apart.solved.solution, "sky"));
  const auto fine = [&](float of_sky, float of_lamp) {
    SolvedScene relit = apart.solved;
    std::vector<Spectrum> scales = effective_scales(relit.solution);
    for (std::size_t c = 0; c < scales.size(); ++c) {
      scales[c] = constant_spectrum(relit.solution.bands, c == sky ? of_sky : of_lamp);
    }
    relight(relit, scales);
    // Errors about the limit, as of a coarser mesh.
    relit.solution.interpolation_error *= 4.0f;
    const DomeOnMesh dome =
        dome_on_mesh(relit.mesh, DirectLight(apart.scene, relit.mesh), relit.solution);
    return std::ranges::count_if(dome.excess, [](float excess) { return excess <= 1.0f; });
  };
  const auto as_solved = fine(1.0f, 1.0f);
  EXPECT_GT(as_solved, 0);
  EXPECT_LE(std::abs(fine(0.5f, 0.5f) - as_solved), as_solved / 100) << "roundings at the limit";
  EXPECT_LT(fine(1.0f, 0.0f), as_solved);
  EXPECT_GE(fine(0.1f, 1.0f), as_solved);
}

// A mesh and its solution, with errors and light of one's own.
struct WithErrors {
  WithErrors() { solution.channels.clear(); }

  // Excess of element 0 when its error is `error`, the part's `of_part`, and the element's light
  // `share` of the reference.
  float excess(float error, double of_part, double share) {
    Scene dome = scene;
    dome.lamps.clear();
    RadiositySolution changed = solution;
    changed.interpolation_error.setZero();
    changed.interpolation_error[0] = error;
    changed.error_estimate = of_part;
    for (ScenePart& part : changed.parts.parts) part.error_estimate = of_part;
    // All elements but the first shine on with what makes its light the `share`. Its corners
    // differ, so that it is not even.
    changed.indirect_irradiance.setZero();
    changed.direct_irradiance.setConstant(1.0f);
    const int n = mesh.corner_count(0);
    for (int c = 0; c < n; ++c) {
      const double of_corner = c == 0 ? 0.0 : share * n / (n - 1);
      changed.direct_irradiance.row(mesh.corners[0][c]) = static_cast<float>(of_corner);
    }
    const Eigen::ArrayXd reference =
        error_references(mesh, changed.direct_irradiance, changed.parts);
    own_over_reference = share / reference[0];
    return dome_on_mesh(mesh, DirectLight(dome, mesh), changed).excess[0];
  }

  Scene scene = room_under_a_sky();
  // Any solution with refined elements serves, since excess() sets its errors and its light.
  SolvedScene solved = solve_scene(scene, {.gather = {.rays = 64}, .refine = {.tolerance = 0.05}});
  PatchMesh& mesh = solved.mesh;
  RadiositySolution& solution = solved.solution;
  double own_over_reference = 0.0;
};

// Quotients of a few floats.
constexpr float of_quotients = 8 * std::numeric_limits<float>::epsilon();

// The excess is an element's error over the error that is allowed, both relative to the reference.
TEST(DaylightPictures, ElementsAsGoodAsTheirPartShowTheSky) {
  WithErrors with;
  // A part off by 5 %: as much is allowed, as a share of the element's own light, 0.05 / (0.05 x).
  const float of_part = with.excess(0.05f, 0.05, 1.0);
  EXPECT_NEAR(of_part, 1.0 / with.own_over_reference, of_quotients * of_part);
  // A dim element: the share of its own light is less than the 2 % of the reference that are
  // always allowed.
  const float dim = with.excess(0.05f, 0.05, 0.1);
  EXPECT_NEAR(dim, 0.05f / DomeOnMesh::small_error, of_quotients * dim);
  // A part off by half is no reason to show more than 10 %: 0.05 / (0.1 x).
  const float rough = with.excess(0.05f, 0.5, 1.0);
  EXPECT_NEAR(rough, 0.5 / with.own_over_reference, of_quotients * rough);
}

TEST(DaylightPictures, WeakReflectionsMayShowWeakErrors) {
  const DomeOnMesh dome{.excess = {4.0f}};
  EXPECT_FALSE(dome.serves(0, 1.0f));
  EXPECT_TRUE(dome.serves(0, 0.25f));
  EXPECT_FALSE(DomeOnMesh{}.serves(0, 0.01f)) << "nothing is known";
}

// Samples of a picture of a floor in a chimney, which sees a fifth of the sky with noise.
std::int64_t samples_of_floor(float noise) {
  SceneBuilder chimney;
  chimney.square({.reflectance = 0.5f}, {0, 0, 0}, Vector3d::UnitZ(), 1);
  for (const Vector3d& side :
       {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0)}) {
    chimney.square({.reflectance = 0.5f}, side + Vector3d::UnitZ(), -side, 1);
  }
  Scene scene = chimney.build();
  scene.sky = grey_sky(scene.bands, 4.0f);
  SolveOptions coarse;
  coarse.refine.tolerance = 0.0;
  const SolvedScene solved = solve_scene(scene, coarse);
  const ElementCaster caster(solved.mesh);
  const DirectLight light(scene, solved.mesh);
  Camera camera = looking({0, 0, 1.0}, -Vector3d::UnitZ(), 40.0);
  camera.width = camera.height = 16;
  RenderReport report;
  RenderOptions options{.pass = Pass::direct};
  options.sampling.noise = noise;
  render(scene, caster, light, solved.solution, camera, options, &report);
  return report.eye_rays;
}

// A pixel is split for the sky's noise where that is more than asked for, and not for differences
// that noise explains: the range of four samples is more than is allowed in 5 of 100 pixels, each
// of which then takes 21 samples at most beside its corners.
TEST(DaylightPictures, PixelsAreSplitForAsMuchNoiseAsIsAskedFor) {
  constexpr std::int64_t corners = 17 * 17, pixels = 16 * 16, most_of_a_pixel = 21;
  const std::int64_t rough = samples_of_floor(1.0f), fine = samples_of_floor(1e-4f);
  std::printf("%lld samples for any noise, %lld for 0.01 %%\n", static_cast<long long>(rough),
              static_cast<long long>(fine));
  // Twice the expected number, for the differences of neighbours are not independent.
  EXPECT_LE(rough, corners + 2 * pixels * most_of_a_pixel / 20);
  EXPECT_EQ(fine, corners + pixels * most_of_a_pixel);
}

}  // namespace
}  // namespace lightwell::daylight_test
