#include "radiosity/gather/gap_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "radiosity/gather/final_gather.h"
#include "scene/coat.h"
#include "tests/radiosity/gather/test_plates.h"
#include "tests/sample_mean.h"

namespace lightwell::gap_light_test {
namespace {

using Eigen::Vector3d;

using test::B0, test::between_long_plates, test::desk_facet, test::Plates;
constexpr double width = test::plate_width;

// The widest gap is half as wide as the plates.
TEST(GapLight, BetweenLongPlatesIsThatOfTheIntegralEquation) {
  for (const double gap : {0.002, 0.01, 0.1}) {
    const Plates plates(gap);
    for (const double depth : {0.5, 1.0, 2.0, 5.0}) {
      const double x = depth * gap;
      if (x > 0.5 * width) continue;
      const double expected = between_long_plates(x, gap);
      constexpr int rays = 1 << 14;
      // Paths bring B0 or nothing: four standard errors. 1 % for the plates' finite length.
      const double p = expected / B0;
      const double noise = 4.0 * B0 * std::sqrt(p * (1.0 - p) / rays);
      EXPECT_NEAR(plates.gathered(x, rays), expected, noise + 0.01 * expected)
          << "gap " << gap << ", depth " << x;
    }
  }
}

// Between plates that reflect 99 % light is nearly even: of the light in their middle the share
// `covered` comes from the other plate, so that there are covered / (1 - covered) reflections in
// the mean, or fewer, and 1 % is lost at each. Rays read the light of the open there, which the
// plates' vertices have, and lose 1 % of that share. Between plates that reflect half, paths go on.
TEST(GapLight, BetweenWhitePlatesIsThatOfTheMesh) {
  constexpr double gap = 0.09, x = 0.5 * width, rho = 0.99;
  const double covered = x / std::hypot(x, gap);
  EXPECT_NEAR(between_long_plates(x, gap, rho), double{B0},
              (1.0 - rho) * covered / (1.0 - covered) * B0);
  const Plates white(gap, static_cast<float>(rho)), grey(gap);
  constexpr int rays = 512, replicas = 32;
  std::vector<double> in_white, in_grey;
  for (int i = 0; i < replicas; ++i) {
    in_white.push_back(white.gathered(x, rays, static_cast<std::uint64_t>(i)));
    in_grey.push_back(grey.gathered(x, rays, static_cast<std::uint64_t>(i)));
  }
  const test::SampleMean E = test::mean_of(in_white), less = test::mean_of(in_grey);
  EXPECT_NEAR(E.value, (1.0 - (1.0 - rho) * covered) * B0, 4.0 * E.standard_error)
      << "four standard errors";
  EXPECT_NEAR(less.value, between_long_plates(x, gap), 4.0 * less.standard_error + 0.01 * B0)
      << "four standard errors; 1 % for the plates' finite length";
  // Neither could be taken for the other.
  EXPECT_LT(4.0 * (E.standard_error + less.standard_error) + 0.01 * B0, 0.1 * B0);
  EXPECT_LT(between_long_plates(x, gap), 0.8 * B0);
}

// Deep in a gap one cosine-distributed ray in thousands gets out.
TEST(GapLight, DeepInAGapIsKnownByAFewHundredRays) {
  for (const double gap : {0.001, 0.004}) {
    const Plates plates(gap);
    const double x = 0.4 * width, expected = between_long_plates(x, gap);
    constexpr int rays = 512, replicas = 64;
    Eigen::ArrayXd found(replicas);
    for (int i = 0; i < replicas; ++i) {
      found[i] = plates.gathered(x, rays, static_cast<std::uint64_t>(i));
    }
    const double deviation = std::sqrt((found - found.mean()).square().sum() / (replicas - 1));
    // Cosine-distributed rays alone bring B0 or nothing and deviate by 0.5 at least, as a share.
    ASSERT_GT(std::sqrt(B0 / (rays * expected)), 0.5);
    // A fifth of a place's own light is what gathers at points promise in gaps.
    EXPECT_LT(deviation, 0.2 * expected) << "gap " << gap;
    // Four standard errors; 1 % for the plates' finite length.
    EXPECT_NEAR(found.mean(), expected, 4.0 * deviation / std::sqrt(replicas) + 0.01 * expected)
        << "gap " << gap;
  }
}

// A path in a narrow gap between plates that reflect half comes to a first surface with a chance of
// one half, and to each further one likewise: shares of 1/2 + 1/4 + ... in the mean, also where one
// surface stands for several.
TEST(GapLight, SurfacesOfPathsCountInFull) {
  const Plates plates(0.0005);
  const LightPaths paths(plates.scene, plates.caster, 8);
  const GapLight gaps({plates.scene, plates.caster, plates.light},
                      {plates.caster.mesh(), plates.radiosity}, paths);
  const Ray ray{
      .origin = {0.5 * width, 0.0, 0.0}, .direction = {0.0, 0.0, 1.0}, .origin_group = desk_facet};
  ElementHit hit;
  plates.caster.closest_hits({&ray, 1}, {&hit, 1});
  ASSERT_TRUE(gaps.is_gap(Vector3d::UnitZ(), ray, hit));
  constexpr int count = 1 << 16;
  double sum = 0.0, squares = 0.0, deep = 0.0;
  for (int i = 0; i < count; ++i) {
    double shares = 0.0;
    gaps.follow(plates.caster, ray, hit, static_cast<std::uint64_t>(i), {},
                {.at_surface =
                     [&](const GapLight::Stop& stop) {
                       shares += double{stop.share[0]};
                       deep += stop.share[0] > 1.5f ? 1.0 : 0.0;
                     },
                 .at_coat = {},
                 .at_end = [](const GapLight::Stop&) {}});
    sum += shares;
    squares += shares * shares;
  }
  const double mean = sum / count, noise = std::sqrt((squares / count - mean * mean) / count);
  // One ray in (r / w)^2 goes farther than r, and the ends of the plates are 200 widths away.
  constexpr double leaving = 2.0 / (200.0 * 200.0);
  EXPECT_NEAR(mean, 1.0, 4.0 * noise + leaving);
  EXPECT_GT(deep, 0.0);
}

// Base and coat of a white plate reflect all light together, at every angle. Between two of them,
// in a room of radiosity B0, all light is B0.
TEST(GapLight, BetweenWhiteCoatedPlatesIsEven) {
  constexpr double gap = 0.004;
  Scene room = Plates::room(gap);
  Material& white = room.materials.back();
  white.coat = Coat{.index_of_refraction = 1.5f};
  white.specular.setOnes();
  white.reflectance.setConstant(1.0f - static_cast<float>(CoatedBase(white).mean_mirrored()));
  const Plates plates(room);
  for (const double depth : {1.0, 4.0}) {
    constexpr int rays = 512, replicas = 32;
    std::vector<double> found;
    for (int i = 0; i < replicas; ++i) {
      found.push_back(plates.gathered(depth * gap, rays, static_cast<std::uint64_t>(i)));
    }
    const test::SampleMean E = test::mean_of(found);
    EXPECT_NEAR(E.value, double{B0}, 4.0 * E.standard_error)
        << "four standard errors, at " << depth;
    // Four standard errors show losses of 12 %; without what coats mirror, 43 and 76 % of the light
    // are lost.
    EXPECT_LT(E.standard_error, 0.12 / 4.0 * B0);
  }
}

TEST(GapLight, IsNotLookedForBetweenPlatesFarApart) {
  // Elements of 0.2 x 1 m have a size of 0.447 m, a fifth of which is 0.089 m.
  const Plates plates(0.1);
  const Ray ray{
      .origin = {0.1, 0.0, 0.0}, .direction = {0.0, 0.0, 1.0}, .origin_group = desk_facet};
  ElementHit hit;
  plates.caster.closest_hits({&ray, 1}, {&hit, 1});
  ASSERT_GE(hit.element, 0);
  const LightPaths paths(plates.scene, plates.caster, 8);
  const GapLight gaps({plates.scene, plates.caster, plates.light},
                      {plates.caster.mesh(), plates.radiosity}, paths);
  EXPECT_NEAR(std::sqrt(plates.mesh.element_area[hit.element]), 0.447, 0.001);
  EXPECT_FALSE(gaps.is_gap(Vector3d::UnitZ(), ray, hit));
  // Seen from nearer it would be a gap; walls that stand on the plate never are.
  const Ray near{.origin = {0.1, 0.0, 0.05}, .direction = {0.0, 0.0, 1.0}};
  plates.caster.closest_hits({&near, 1}, {&hit, 1});
  EXPECT_TRUE(gaps.is_gap(Vector3d::UnitZ(), near, hit));
  EXPECT_FALSE(gaps.is_gap(Vector3d::UnitX(), near, hit));
}

// Irradiance between two upright plates, 1 cm apart, that stand in the middle of `scene`: 2 cm
// above the lower brink, by replicas of a gather that reads no light from the mesh. Of lamps it is
// the indirect irradiance, of the sky, which no caustics hold, all of it.
Eigen::ArrayXd between_plates(Scene scene, int replicas) {
  const int plate = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const int left = static_cast<int>(scene_facets(scene).size());
  const double gap = 0.01, w = 0.2, l = 2.0;
  test::add_polygon(scene, "left", plate, {{0, -l, 0}, {0, l, 0}, {0, l, w}, {0, -l, w}});
  test::add_polygon(scene, "right", plate, {{gap, -l, 0}, {gap, -l, w}, {gap, l, w}, {gap, l, 0}});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 2.0});
  const ElementCaster caster(mesh);
  const DirectLight light(scene, mesh);
  const BandArray none = BandArray::Zero(mesh.vertex_count(), light.column_count());
  const std::vector<GatherPoint> points = {
      {.position = {0, 0, 0.02}, .normal = Vector3d::UnitX(), .facet = left}};
  Eigen::ArrayXd found(replicas);
  for (int i = 0; i < replicas; ++i) {
    const GatherOptions options{
        .rays = 1 << 12, .replica = static_cast<std::uint64_t>(i), .aims_out_of_gaps = true};
    const GatheredIrradiance E = gather_irradiance({scene, caster, light}, none, points, options);
    found[i] = E.indirect(0, 0) + (scene.sky ? E.direct(0, 0) : 0.0f);
  }
  return found;
}

// Means agree to four standard errors. One is at most a twentieth of the mean, so that a fifth of
// the light cannot be missing: mirrors bring more than a third of it in the scenes below.
void expect_same(const Eigen::ArrayXd& found, const Eigen::ArrayXd& expected) {
  const auto variance = [](const Eigen::ArrayXd& x) {
    const auto n = static_cast<double>(x.size());
    return (x - x.mean()).square().sum() / (n * (n - 1.0));
  };
  const double noise = std::sqrt(variance(found) + variance(expected));
  EXPECT_NEAR(found.mean(), expected.mean(), 4.0 * noise);
  EXPECT_LT(noise, 0.05 * expected.mean());
}

constexpr double mirror_below = 5.0;
void add_mirror(Scene& scene) {
  const double h = mirror_below;
  test::add_polygon(scene, "mirror", test::add_material(scene, test::mirror(scene.bands, 1.0f)),
                    {{-10, -10, -h}, {10, -10, -h}, {10, 10, -h}, {-10, 10, -h}});
}

// A black hall with a luminous panel of 10 m x 10 m 5 m above. The panel also shines from 15 m
// below: by way of a mirror, or as a second panel in its place. The lower one gives most light
// there.
Scene hall(bool by_mirror) {
  Scene scene;
  const int black = test::add_material(scene, test::diffuse(scene.bands, 0.0f));
  const int panel = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 10.0f));
  test::add_box(scene, {-10, -10, -20}, {10, 10, 10}, {black, black, black, black, black, black},
                true);
  const double p = 5.0, h = mirror_below;
  test::add_polygon(scene, "panel", panel, {{-p, -p, h}, {-p, p, h}, {p, p, h}, {p, -p, h}});
  if (by_mirror) {
    add_mirror(scene);
  } else {
    test::add_polygon(scene, "image", panel,
                      {{-p, -p, -3 * h}, {p, -p, -3 * h}, {p, p, -3 * h}, {-p, p, -3 * h}});
  }
  return scene;
}

TEST(GapLight, ComesFromLampsByWayOfMirrors) {
  constexpr int replicas = 32;
  expect_same(between_plates(hall(true), replicas), between_plates(hall(false), replicas));
}

// Below an even sky and above ground as bright, a mirror changes nothing.
TEST(GapLight, ComesFromTheSkyByWayOfMirrors) {
  constexpr int replicas = 32;
  Scene scene;
  scene.sky = test::even_sky(scene.bands, 10.0f, 10.0f);
  Scene with_mirror = scene;
  add_mirror(with_mirror);
  expect_same(between_plates(with_mirror, replicas), between_plates(scene, replicas));
}

}  // namespace
}  // namespace lightwell::gap_light_test
