#include "radiosity/paths/free_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/gather/caustic_irradiance.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/gather/vertex_points.h"
#include "radiosity/paths/caustic_photons.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solution/relight.h"
#include "radiosity/solve.h"
#include "scene/optics.h"
#include "scene/parallel.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::free_light_test {
namespace {

constexpr double pi = std::numbers::pi;

// A closed box of 4 x 5 x 3 m with a block in it.
Scene box(float rho) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, rho));
  const std::array<int, 6> all{grey, grey, grey, grey, grey, grey};
  test::add_box(scene, {0, 0, 0}, {4, 5, 3}, all, true);
  test::add_box(scene, {0.5, 0.5, 0}, {1.5, 1.2, 0.8}, all, false);
  return scene;
}

Lamp point_lamp(const Scene& scene, float intensity = 10.0f) {
  return {.name = "bulb",
          .position = {2.0, 2.5, 2.2},
          .axes = lamp_axes(-Eigen::Vector3d::UnitZ()),
          .intensity = constant_spectrum(scene.bands, intensity)};
}

SharedWeb lambertian_web() {
  std::vector<double> gammas;
  for (int g = 0; g <= 90; ++g) gammas.push_back(g);
  Eigen::ArrayXXd values(1, 91);
  for (int g = 0; g <= 90; ++g) values(0, g) = std::cos(g * pi / 180.0);
  values(0, 90) = 0.0;
  return std::make_shared<const PhotometricWeb>(std::vector<double>{0.0}, gammas, values);
}

SolveOptions quick() {
  SolveOptions options;
  options.mesh.max_patch_size = 0.5;
  options.form_factors.rays_per_patch = 256;
  options.gather.rays = 128;
  options.refine.tolerance = 0.0;
  options.error_points = 64;
  return options;
}

double direct(const Scene& scene, const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  return light.irradiance(caster, {.at = {point, normal}, .key = 7})[0];
}

TEST(FreeSources, PointGivesIntensityTimesCosineOverSquaredDistance) {
  Scene scene = box(0.5f);
  scene.lamps = {point_lamp(scene)};
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(2.0, 2.5, 0.1), Eigen::Vector3d(3.7, 4.1, 0.1),
                                   Eigen::Vector3d(2.3, 1.9, 1.4)}) {
    const Eigen::Vector3d to = scene.lamps[0].position - p;
    const double E = 10.0 * to.z() / std::pow(to.norm(), 3);
    EXPECT_NEAR(direct(scene, p, Eigen::Vector3d::UnitZ()) / E, 1.0, 1e-6);
  }
}

// 100 lm of a Lambertian lamp straight below at 1 m: I = 100 / pi cd, so 31.8 lx.
TEST(FreeSources, HundredLumensOfLambertianLightAtOneMetre) {
  Scene scene = box(0.0f);
  Lamp lamp = point_lamp(scene);
  lamp.shape = lambertian_web();
  const double watts = 100.0 / scene.bands.lumens_per_watt;
  lamp.intensity = constant_spectrum(scene.bands, static_cast<float>(watts / relative_flux(lamp)));
  scene.lamps = {lamp};
  const double E =
      direct(scene, lamp.position - Eigen::Vector3d(0, 0, 1), Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(E * scene.bands.lumens_per_watt, 100.0 / pi, 0.01);
}

TEST(FreeSources, BlockHidesAPointWhollyOrNotAtAll) {
  Scene scene = box(0.5f);
  scene.lamps = {point_lamp(scene)};
  EXPECT_EQ(direct(scene, {0.3, 0.3, 1e-6}, Eigen::Vector3d::UnitZ()), 0.0);
  EXPECT_GT(direct(scene, {1.6, 0.8, 1e-6}, Eigen::Vector3d::UnitZ()), 0.0);
}

// A rectangle of Lambertian intensity is that rectangle emitting M = pi L, L = I / A.
TEST(FreeSources, LambertianRectangleIsTheRectangleEmitting) {
  Scene emitting = box(0.5f);
  const float M = 100.0f;
  const int shining = test::add_material(emitting, test::diffuse(emitting.bands, 0.0f, M));
  const Eigen::Vector3d middle(2.0, 2.5, 2.2);
  test::add_polygon(
      emitting, "panel", shining,
      {middle + Eigen::Vector3d(-0.3, -0.6, 0), middle + Eigen::Vector3d(-0.3, 0.6, 0),
       middle + Eigen::Vector3d(0.3, 0.6, 0), middle + Eigen::Vector3d(0.3, -0.6, 0)});
  Scene with_lamp = box(0.5f);
  Lamp lamp = point_lamp(with_lamp, static_cast<float>(M * 0.6 * 1.2 / pi));
  lamp.shape = lambertian_web();
  lamp.axes = lamp_axes(-Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX());
  lamp.opening = {.along_c0 = 0.6, .along_c90 = 1.2};
  with_lamp.lamps = {lamp};
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), right = Eigen::Vector3d::UnitX();
  for (const auto& [p, n] : {std::pair(Eigen::Vector3d(2.0, 2.5, 2.1), up),
                             std::pair(Eigen::Vector3d(2.25, 2.2, 1.9), up),
                             std::pair(Eigen::Vector3d(3.9, 4.8, 0.1), up),
                             std::pair(Eigen::Vector3d(1.0, 2.5, 1.0), right)}) {
    EXPECT_NEAR(direct(with_lamp, p, n) / direct(emitting, p, n), 1.0, 2e-3) << p.transpose();
  }
  // The penumbra of the block as well, to the noise of shadow rays.
  const Eigen::Vector3d shaded(0.2, 0.94, 1e-6);  // behind a vertical edge
  const double of_panel = direct(emitting, shaded, up);
  EXPECT_GT(of_panel, 0.1);
  EXPECT_NEAR(direct(with_lamp, shaded, up) / of_panel, 1.0, 0.1);
}

TEST(FreeSources, OpeningFarAwayIsAPoint) {
  Scene scene = box(0.5f);
  Lamp lamp = point_lamp(scene);
  scene.lamps = {lamp};
  const Eigen::Vector3d p(2.0, 2.5, 0.2);
  const double of_point = direct(scene, p, Eigen::Vector3d::UnitZ());
  for (const bool is_round : {false, true}) {
    scene.lamps[0].opening = {.along_c0 = 0.02, .along_c90 = 0.02, .is_round = is_round};
    EXPECT_NEAR(direct(scene, p, Eigen::Vector3d::UnitZ()) / of_point, 1.0, 1e-4);
  }
}

TEST(FreeLight, FluxOfALampIsAbsorbedAndEscaped) {
  for (const bool open : {false, true}) {
    for (const bool shoots : {false, true}) {
      Scene scene = box(0.6f);
      if (open) scene.surfaces.erase(scene.surfaces.begin());
      scene.lamps = {point_lamp(scene)};
      SolveOptions options = quick();
      if (shoots) options.progressive.emplace();
      const EnergyBalance e = solve_scene(scene, options).solution.energy;
      std::printf("%s, %s: emitted %.6f absorbed %.6f escaped %.6f (missed %.6f) unshot %.1e\n",
                  open ? "open" : "closed", shoots ? "shooting" : "equations", e.emitted,
                  e.absorbed, e.escaped, e.missed, e.unshot);
      // Floats hold the intensity and what surfaces get, to 6e-8 each, with errors of either sign.
      EXPECT_NEAR(e.emitted, 3 * 10.0 * 4 * pi, 1.2e-7 * e.emitted);
      EXPECT_NEAR(e.from_lamps, e.emitted, 1e-12 * e.emitted);
      EXPECT_NEAR((e.absorbed + e.escaped + e.unshot) / e.emitted, 1.0, 2e-7);
      if (open) {
        EXPECT_GT(e.missed, 0.05 * e.emitted);
        EXPECT_GT(e.escaped, e.missed);
      } else {
        EXPECT_EQ(e.escaped, 0.0);
      }
    }
  }
}

// No ray of a lamp that touches the ceiling begins behind the ceiling, and no ground around the
// room makes rays begin farther from their lamp.
TEST(FreeLight, LampsUnderACeilingLightIt) {
  for (const double around : {0.0, 3000.0}) {
    for (const double below : {0.0, 1e-7, 1e-5, 1e-3, 0.05}) {
      Scene scene = box(0.5f);
      if (around > 0.0) {
        test::add_polygon(scene, "ground", 0,
                          {{-around, -around, 0},
                           {around, -around, 0},
                           {around, around, 0},
                           {-around, around, 0}});
      }
      scene.lamps = {point_lamp(scene)};
      scene.lamps[0].position.z() = 3.0 - below;
      const PatchMesh mesh = build_patches(scene);
      const ElementCaster caster(mesh);
      const DirectLight lights(scene, mesh);
      const FreeLight light =
          cast_free_light(scene, caster, LightPaths(scene, caster, 8), lights, 1 << 14);
      EXPECT_EQ(light.missed[0], 0.0) << below << " m below, ground of " << around;
      double on_ceiling = 0.0;
      for (int p = 0; p < mesh.patch_count(); ++p) {
        const bool is_ceiling = scene.surfaces[mesh.surface[p]].name == "z1";
        if (is_ceiling) on_ceiling += mesh.area[p] * light.irradiance(p, 0);
      }
      // Half of the rays go up. From 5 cm below the ceiling those whose sine over the horizon is
      // below 0.05 / 2, one in 40, meet a wall 2 m away. Independent rays have a standard error of
      // 0.5 / sqrt(2^14); four of them.
      constexpr double noise = 4.0 * 0.5 / 128.0;
      EXPECT_NEAR(on_ceiling / light.emitted[0], 0.5, below < 0.05 ? noise : noise + 0.5 / 40.0);
    }
  }
}

// In a closed room that reflects rho, what leaves all surfaces is rho flux / (1 - rho).
TEST(FreeLight, ClosedRoomAddsUpAllReflections) {
  Scene scene = box(0.5f);
  scene.lamps = {point_lamp(scene)};
  const SolvedScene solved = solve_scene(scene, quick());
  const PatchMesh& mesh = solved.mesh;
  double reflected = 0.0;
  for (int i = 0; i < mesh.patch_count(); ++i) {
    if (mesh.is_back[i] != 0) continue;
    reflected += mesh.area[i] * solved.solution.patch_radiosity(i, 0);
  }
  const double flux = 10.0 * 4.0 * pi;
  EXPECT_NEAR(reflected, 0.5 * flux / (1.0 - 0.5), 1e-6 * flux);  // the solver's tolerance
}

// E of patches by rays is the mean of E at points of them.
TEST(FreeLight, RaysAgreeWithTheClosedForm) {
  Scene scene = box(0.5f);
  Lamp lamp = point_lamp(scene);
  lamp.shape = SpotCone{.inner = 0.4, .outer = 1.1};
  scene.lamps = {lamp, point_lamp(scene, 3.0f)};
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  const FreeLight cast = cast_free_light(scene, caster, LightPaths(scene, caster, 8), light);
  double squares = 0.0, sum = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    double mean = 0.0, all = 0.0;
    for (int e = mesh.first_element[p]; e < mesh.first_element[p + 1]; ++e) {
      const PatchPoint at = element_center(mesh, e);
      mean +=
          mesh.element_area[e] *
          light.irradiance(caster, {.at = {at.position, at.normal, mesh.facet[e]}, .key = 3})[0];
      all += mesh.element_area[e];
    }
    squares += mesh.area[p] * std::pow(cast.irradiance(p, 0) - mean / all, 2);
    sum += mesh.area[p] * mean / all;
  }
  const double rms = std::sqrt(squares / mesh.area.sum()) / (sum / mesh.area.sum());
  std::printf("rays against centres of elements: %.3f of the mean\n", rms);
  // A million rays for some 400 patches, 2500 each: sqrt(1 / 2500) of noise in each.
  EXPECT_LT(rms, 0.02);
}

TEST(FreeLight, SameBitsOnAnyNumberOfThreads) {
  Scene scene = box(0.5f);
  scene.lamps = {point_lamp(scene)};
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  const LightPaths paths(scene, caster, 8);
  std::vector<BandArray> found;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    found.push_back(cast_free_light(scene, caster, paths, light).irradiance);
  }
  EXPECT_TRUE((found[0] == found[1]).all());
  EXPECT_TRUE((found[0] == found[2]).all());
}

TEST(FreeLight, ChannelsOfLampsAddUpAndRelight) {
  Scene scene = box(0.5f);
  Lamp other = point_lamp(scene, 4.0f);
  other.name = "desk";
  other.position = {3.2, 0.8, 1.2};
  scene.lamps = {point_lamp(scene), other};
  SolveOptions options = quick();
  const SolvedScene together = solve_scene(scene, options);
  options.channels = channels_per_luminaire(scene);
  ASSERT_EQ(options.channels.names, (std::vector<std::string>{"bulb", "desk"}));
  SolvedScene apart = solve_scene(scene, options);
  const BandArray E = together.solution.irradiance();
  EXPECT_LT((apart.solution.irradiance() - E).abs().maxCoeff(), 2e-6f * E.maxCoeff())
      << "the same rays, solved to 1e-6";

  // With the first off what is left is the room with the second alone.
  relight(apart, std::vector<Spectrum>{Spectrum::Zero(3), Spectrum::Ones(3)});
  scene.lamps = {other};
  const SolvedScene alone = solve_scene(scene, quick());
  EXPECT_NEAR(apart.solution.energy.from_lamps, alone.solution.energy.from_lamps,
              1.2e-7 * alone.solution.energy.from_lamps);
  const BandArray mean = apart.solution.irradiance().colwise().mean();
  // Other rays, as they are shared out by flux: a million and more leave a thousandth in all.
  EXPECT_NEAR(mean(0, 0) / alone.solution.irradiance().col(0).mean(), 1.0, 1e-3);

  scene.lamps = {point_lamp(scene), other};
  const ElementCaster caster(apart.mesh);
  const DirectLight dimmed(scene, apart.mesh);
  EXPECT_FALSE(dimmed.free_sources()[0].is_on());
  EXPECT_TRUE(dimmed.free_sources()[1].is_on());
}

// The light that a mirror throws on is the light that falls on the mirror less the absorbed share;
// at a point, that of the lamp's mirror image.
TEST(FreeLight, MirrorThrowsTheLampsLightOn) {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const int mirror = test::add_material(scene, test::mirror(scene.bands, 0.8f));
  test::add_box(scene, {0, 0, 0}, {4, 5, 3}, {mirror, grey, grey, grey, grey, grey}, true);
  scene.lamps = {point_lamp(scene)};
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  const FreeLight cast = cast_free_light(scene, caster, LightPaths(scene, caster, 8), light);
  const double thrown = cast.absorbed[0] / 0.2 * 0.8;
  const CausticPhotons photons = shoot_photons({scene, caster, light}, 1 << 18, 8);
  // One of 2^18 photons in six or so meets it, and one of a million rays: 1 / sqrt(2^18 / 6).
  EXPECT_NEAR(photons.power.col(0).sum() / thrown, 1.0, 0.005);

  const BandArray caustic = caustic_irradiance({scene, caster, light}, 1 << 19, 8);
  const std::vector<GatherPoint> points = vertex_gather_points(mesh);
  const Eigen::Vector3d image(-2.0, 2.5, 2.2);
  double found = 0.0, exact = 0.0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const Eigen::Vector3d to = image - points[v].position;
    const double height = to.dot(points[v].normal);
    const double E = height > 0.0 ? 0.8 * 10.0 * height / std::pow(to.norm(), 3) : 0.0;
    found += caustic(static_cast<Eigen::Index>(v), 0);
    exact += E;
  }
  // Photons are counted within a distance, which at edges of walls reaches over them: an element's
  // width in some hundred of them around, of which a fiftieth is missed or counted twice.
  EXPECT_NEAR(found / exact, 1.0, 0.02);
}

// Light goes straight on through a pane of glass, dimmed.
TEST(FreeSources, PanesPassLightStraightOn) {
  Scene scene = box(0.5f);
  scene.lamps = {point_lamp(scene)};
  const Eigen::Vector3d below(2.0, 2.5, 1e-6);
  const double open = direct(scene, below, Eigen::Vector3d::UnitZ());
  Material pane = test::clear_glass(scene.bands);
  pane.dielectric->thin = true;
  const int glass = test::add_material(scene, pane);
  test::add_polygon(scene, "pane", glass, {{1, 1.5, 1}, {3, 1.5, 1}, {3, 3.5, 1}, {1, 3.5, 1}});
  const double through = direct(scene, below, Eigen::Vector3d::UnitZ());
  const double R1 = 0.04, R = R1 + (1 - R1) * (1 - R1) * R1 / (1 - R1 * R1);  // both faces
  EXPECT_NEAR(through / open, (1.0 - R) * 0.9, 1e-6);
}

// A box with an opening of 2 x 1.5 m in its wall y0, above ground outside. A sun that stands at 45
// degrees shines on the ground and through the opening onto the floor.
Scene sunlit_room() {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_box(scene, {0, 0, 0}, {4, 5, 3}, {grey, grey, grey, grey, grey, grey}, true);
  auto& wall = std::get<PolygonMesh>(scene.surfaces[2].shape);
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(3, 0, 1),
                                        Eigen::Vector3d(3, 0, 2.5), Eigen::Vector3d(1, 0, 2.5)}) {
    wall.facets[0].holes.resize(1);
    wall.facets[0].holes[0].push_back(static_cast<int>(wall.vertices.size()));
    wall.vertices.push_back(corner);
  }
  test::add_polygon(scene, "ground", grey,
                    {{-4, -9, -0.5}, {8, -9, -0.5}, {8, -1, -0.5}, {-4, -1, -0.5}});
  scene.sky = Sky{.up = Eigen::Vector3d::UnitZ(),
                  .north = Eigen::Vector3d::UnitY(),
                  .scale = constant_spectrum(scene.bands, 0.0f),
                  .ground = constant_spectrum(scene.bands, 0.0f)};
  scene.sky->sun = Sun{.direction = Eigen::Vector3d(0, -1, 1).normalized(),
                       .irradiance = constant_spectrum(scene.bands, 1000.0f)};
  return scene;
}

// A pane before the opening of sunlit_room(), larger than the opening; `lean` moves its upper edge
// outwards.
void add_pane(Scene& scene, float index, double before, double lean) {
  Material pane = test::clear_glass(scene.bands);
  pane.dielectric->index_of_refraction = index;
  pane.dielectric->thin = true;
  pane.dielectric->tint << 0.8f, 0.5f, 0.25f;
  test::add_polygon(scene, "pane", test::add_material(scene, pane),
                    {{0.5, -before, 0.5},
                     {3.5, -before, 0.5},
                     {3.5, -before - lean, 4.5},
                     {0.5, -before - lean, 4.5}});
}

BandArray arriving_light(const Scene& scene, const PatchMesh& mesh) {
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  return cast_free_light(scene, caster, LightPaths(scene, caster, 8), light).irradiance;
}

struct PanesBeforeARoom {
  int count = 1;
  float index = 1.0f;
  double lean = 0.0;
};

class SunBehindPanes : public testing::TestWithParam<PanesBeforeARoom> {};

TEST_P(SunBehindPanes, ReachesPatchesOnce) {
  const auto& [count, index, lean] = GetParam();
  const Scene open = sunlit_room();
  const PatchMesh open_mesh = build_patches(open, {.max_patch_size = 0.5});
  const BandArray without = arriving_light(open, open_mesh);
  Scene scene = open;
  for (int i = 0; i < count; ++i) add_pane(scene, index, 0.1 + 0.2 * i, lean);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  const BandArray with = arriving_light(scene, mesh);
  ASSERT_GE(mesh.patch_count(), open_mesh.patch_count());
  const Eigen::Vector3d normal = Eigen::Vector3d(0, 4.0, lean).normalized();
  const double angle = std::acos(std::abs(normal.dot(scene.sky->sun->direction)));
  const auto passed_at = [&](double at) {
    return std::pow(1.0 - pane_reflectance(std::cos(at), static_cast<double>(index)), count);
  };
  const double passed = passed_at(angle);
  // A patch at an edge of the shadow sees one side of the sun's disc alone. The sums of 64 rays in
  // single precision are off by 64 * 6e-8 at most.
  const double half_disc = 0.5 * scene.sky->sun->angle_degrees * pi / 180.0;
  const double tolerance =
      std::max(passed_at(angle - half_disc) - passed, passed - passed_at(angle + half_disc)) /
          passed +
      64 * 6e-8;
  const std::array<double, 3> tint = {0.8, 0.5, 0.25};
  int lit = 0;
  for (int i = 0; i < open_mesh.patch_count(); ++i) {
    // The ground also gets what panes reflect.
    if (open_mesh.surface[i] > 5 || !(without(i, 0) > 0.0f)) continue;
    ++lit;
    for (int k = 0; k < 3; ++k) {
      const double expected =
          static_cast<double>(without(i, k)) * passed * std::pow(tint[k], count);
      EXPECT_NEAR(static_cast<double>(with(i, k)), expected, tolerance * expected) << i << ' ' << k;
    }
  }
  EXPECT_GT(lit, 10);
}

INSTANTIATE_TEST_SUITE_P(FreeLight, SunBehindPanes,
                         testing::Values(PanesBeforeARoom{},  // upright, without reflection
                                         PanesBeforeARoom{.lean = 1.0},
                                         PanesBeforeARoom{.count = 2},
                                         PanesBeforeARoom{.count = 2, .lean = 1.0},
                                         PanesBeforeARoom{.index = 1.5f},
                                         PanesBeforeARoom{.index = 1.5f, .lean = 1.0}));

TEST(FreeLight, RoomOfLampsAloneThatReflectsNothingIsSolved) {
  Scene scene = box(0.0f);
  scene.lamps = {point_lamp(scene)};
  SolveOptions options = quick();
  const SolvedScene solved = solve_scene(scene, options);
  EXPECT_EQ(solved.solution.patch_radiosity.maxCoeff(), 0.0f);
  EXPECT_GT(solved.solution.direct_irradiance.maxCoeff(), 0.0f);
  EXPECT_NEAR(solved.solution.energy.absorbed / solved.solution.energy.emitted, 1.0, 2e-7);
}

}  // namespace
}  // namespace lightwell::free_light_test
