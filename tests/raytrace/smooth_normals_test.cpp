// Normals at vertices in pictures: a tessellated sphere beside the exact one, furnaces, and no
// light from behind.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radiosity/paths/caustic_photons.h"
#include "radiosity/solve.h"
#include "raytrace/caustics/caustic_map.h"
#include "scene/facet_normals.h"
#include "scene/io/corner_maps.h"
#include "scene/io/mesh_builder.h"
#include "scene/io/placed_mesh.h"
#include "scene/io/polygon.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::smooth_normals_test {
namespace {

using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;
constexpr auto pi_f = std::numbers::pi_v<float>;

// A sphere of radius 1 in facets between 8 rings of latitude and 16 of longitude, with vertices on
// the sphere.
PolygonMesh tessellated_sphere(bool with_normals) {
  constexpr int rings = 8, sectors = 16;
  const auto point = [&](int ring, int sector) {
    const double latitude = pi * ring / rings - 0.5 * pi;
    const double longitude = 2.0 * pi * (sector % sectors) / sectors;
    const bool is_pole = ring == 0 || ring == rings;
    const double r = is_pole ? 0.0 : std::cos(latitude);
    return Vector3d(r * std::cos(longitude), r * std::sin(longitude), std::sin(latitude));
  };
  MeshBuilder mesh;
  for (int ring = 0; ring < rings; ++ring) {
    for (int s = 0; s < sectors; ++s) {
      Loop loop = {point(ring, s)};
      if (ring > 0) loop.push_back(point(ring, s + 1));
      loop.push_back(point(ring + 1, s + 1));
      if (ring + 1 < rings) loop.push_back(point(ring + 1, s));
      mesh.add({.boundary = loop}, {}, with_normals ? loop : NormalLoop{});
    }
  }
  return mesh.mesh();
}

enum class Ball { exact, smooth, faceted };

void add_ball(Scene& scene, Ball ball, int material) {
  Surface surface{.name = "ball", .material = material};
  if (ball == Ball::exact) {
    surface.shape = Sphere{};
  } else {
    surface.shape = tessellated_sphere(ball == Ball::smooth);
  }
  scene.surfaces.push_back(surface);
}

// A picture of a ball with a lamp at its side: the terminator runs down the middle.
Image side_lit_ball(Ball ball) {
  Scene scene = SceneBuilder().square({.exitance = 100.0f}, {6, -2, 1}, {-6, 2, -1}, 0.2).build();
  scene.materials.push_back(scene.materials[0]);
  scene.materials.back().reflectance = constant_spectrum(scene.bands, 0.5f);
  scene.materials.back().emission.setZero();
  add_ball(scene, ball, 1);
  const TracedScene lit(scene);
  Camera camera = camera_towards({0, -8, 0}, {0, 0, 0}, 18, 96);
  camera.up = Vector3d::UnitZ();
  return lit.render(camera);
}

// Visits the pixels inside a circle of 0.8 of the outline's radius.
template <class Visit>
void for_each_inside(const Image& image, Visit&& visit) {
  const double half = 0.5 * image.width,
               outline = half * std::tan(std::asin(1.0 / 8.0)) / std::tan(pi / 20.0);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (std::hypot(x + 0.5 - half, y + 0.5 - half) > 0.8 * outline) continue;
      visit(Eigen::Index{y} * image.width + x);
    }
  }
}

TEST(SmoothNormals, BallLooksLikeTheSphereAndHasNoDarkFacetsAtTheShadow) {
  const Image exact = side_lit_ball(Ball::exact), smooth = side_lit_ball(Ball::smooth),
              faceted = side_lit_ball(Ball::faceted);
  double brightest = 0.0, smooth_error = 0.0, faceted_error = 0.0, worst = 0.0,
         worst_in_shade = 0.0, all = 0.0;
  for_each_inside(exact, [&](Eigen::Index i) {
    brightest = std::max(brightest, double{exact.radiance(i, 0)});
  });
  int count = 0;
  for_each_inside(exact, [&](Eigen::Index i) {
    const double L = exact.radiance(i, 0);
    const double off = smooth.radiance(i, 0) - L;
    smooth_error += off * off;
    faceted_error += std::pow(faceted.radiance(i, 0) - L, 2);
    all += L;
    worst = std::max(worst, std::abs(off));
    if (L < 0.05 * brightest) worst_in_shade = std::max(worst_in_shade, std::abs(off));
    ++count;
  });
  smooth_error = std::sqrt(smooth_error / count) / (all / count);
  faceted_error = std::sqrt(faceted_error / count) / (all / count);
  RecordProperty("smooth", std::to_string(smooth_error));
  RecordProperty("faceted", std::to_string(faceted_error));
  RecordProperty("worst", std::to_string(worst / brightest));
  EXPECT_GT(all, 0.0);
  EXPECT_LT(smooth_error, 0.04);  // a facet lies up to 0.04 below the sphere, which shifts the hit
  EXPECT_LT(smooth_error, 0.2 * faceted_error);
  // No pixel is black or too bright, also at the terminator.
  EXPECT_LT(worst, 0.05 * brightest);
  EXPECT_LT(worst_in_shade, 0.01 * brightest);
}

// Walls with light that varies over them, in a ball.
Image mirrored_room(Ball ball, const Paint& paint) {
  Scene scene = SceneBuilder().box({.reflectance = 0.5f}, {-6, -6, -6}, {6, 6, 6}, true).build();
  const Scene painted = SceneBuilder().sphere(paint, {0, 0, 0}, 1.0).build();
  scene.materials.push_back(painted.materials[0]);
  add_ball(scene, ball, 1);
  TracedScene lit(scene);
  lit.set_indirect([](const Vector3d& p) {
    return static_cast<float>(2.0 * pi * (1.0 + 0.1 * (p.x() + 0.5 * p.y() - 0.7 * p.z())));
  });
  return lit.render(camera_towards({0, -4, 0}, {0, 0, 0}, 34, 64), {.pass = Pass::interpolate});
}

double relative_rms(const Image& a, const Image& b, double field_share) {
  double sum = 0.0, all = 0.0;
  int count = 0;
  const double half = 0.5 * a.width;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (std::hypot(x + 0.5 - half, y + 0.5 - half) > field_share * half) continue;
      const Eigen::Index i = Eigen::Index{y} * a.width + x;
      sum += std::pow(a.radiance(i, 0) - b.radiance(i, 0), 2);
      all += b.radiance(i, 0);
      ++count;
    }
  }
  return std::sqrt(sum / count) / (all / count);
}

// Errors of a tessellated ball's picture against the exact sphere's, within a share of the
// picture's half width; the sphere's outline is at 0.85.
struct BallErrors {
  double smooth = 0.0, faceted = 0.0;
};
BallErrors errors_of(const Paint& paint, double share) {
  const Image exact = mirrored_room(Ball::exact, paint);
  const BallErrors errors{
      .smooth = relative_rms(mirrored_room(Ball::smooth, paint), exact, share),
      .faceted = relative_rms(mirrored_room(Ball::faceted, paint), exact, share)};
  testing::Test::RecordProperty("smooth", std::to_string(errors.smooth));
  testing::Test::RecordProperty("faceted", std::to_string(errors.faceted));
  return errors;
}

TEST(SmoothNormals, MirrorBallShowsTheRoomAsTheSphereDoes) {
  const BallErrors errors = errors_of({.specular = 1.0f}, 0.6);
  // Hits are shifted by h / r of the ball's size, where h = 0.03 r is the depth of facets below the
  // sphere.
  EXPECT_LT(errors.smooth, 0.03);
  EXPECT_LT(errors.smooth, 0.2 * errors.faceted);
}

TEST(SmoothNormals, GlassBallBendsLightAsTheSphereDoes) {
  const BallErrors errors = errors_of({.index_of_refraction = 1.5f}, 0.5);
  EXPECT_LT(errors.smooth, 0.01);
  EXPECT_LT(errors.smooth, 0.2 * errors.faceted);
}

// Radiance of a ball in a room of constant radiance 1: 1 everywhere if the ball loses no light.
Eigen::ArrayXf ball_in_furnace(Ball ball, const Paint& paint) {
  Scene scene = SceneBuilder().box({.exitance = pi_f}, {-6, -6, -6}, {6, 6, 6}, true).build();
  scene.materials.push_back(SceneBuilder().sphere(paint, {0, 0, 0}, 1.0).build().materials[0]);
  add_ball(scene, ball, 1);
  const RenderOptions options{.pass = Pass::gather, .gather_rays = 64, .photons = 0};
  return TracedScene(scene)
      .render(camera_towards({0, -4, 0}, {0, 0, 0}, 34, 24), options)
      .radiance.col(0);
}

TEST(SmoothNormals, FurnaceIsKept) {
  for (const Paint& paint : {Paint{.reflectance = 1.0f}, Paint{.specular = 1.0f},
                             Paint{.specular = 1.0f, .roughness = 0.3f},
                             Paint{.index_of_refraction = 1.5f, .roughness = 0.3f}}) {
    const Eigen::ArrayXf L = ball_in_furnace(Ball::smooth, paint);
    EXPECT_NEAR(L.minCoeff(), 1.0f, 2e-6f);  // every ray has radiance 1: only float rounding
    EXPECT_NEAR(L.maxCoeff(), 1.0f, 2e-6f);
  }
  // Interpolated normals trap light beyond the critical angle at grazing incidence. Flat normals
  // trap none that the depth of paths does not let out.
  const Paint glass{.index_of_refraction = 1.5f};
  const float smooth = ball_in_furnace(Ball::smooth, glass).mean();
  EXPECT_NEAR(smooth, 1.0f, 5e-3f);
  EXPECT_NEAR(ball_in_furnace(Ball::faceted, glass).mean(), 1.0f, 2e-6f);
}

TEST(SmoothNormals, SolvedIrradianceOfABallInAFurnaceIsEven) {
  Scene scene = SceneBuilder().box({.exitance = pi_f}, {-6, -6, -6}, {6, 6, 6}, true).build();
  scene.materials.push_back(
      SceneBuilder().sphere({.reflectance = 0.5f}, {0, 0, 0}, 1.0).build().materials[0]);
  add_ball(scene, Ball::smooth, 1);
  const SolvedScene solved = solve_scene(scene, {.mesh = {.max_patch_size = 3.0}});
  const PatchMesh& mesh = solved.mesh;
  const BandArray E = solved.solution.irradiance();
  int shared = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.position(v).norm() > 1.01 || mesh.vertex_normal[v].dot(mesh.position(v)) < 0.0)
      continue;
    EXPECT_NEAR(E(v, 0), pi_f, 2e-6f * pi_f);
    shared += mesh.vertex_normal[v].dot(mesh.position(v).normalized()) > 0.99 ? 1 : 0;
  }
  EXPECT_GT(shared, 16 * 7) << "facets share their vertices";
}

// Irradiance on the ceiling by a lamp's reflection in a mirror ball, W/m^2, at points of a grid.
Eigen::ArrayXd thrown_on_ceiling(Ball ball) {
  Scene scene = SceneBuilder()
                    .square({.exitance = 100.0f, .one_sided = true}, {0, 0, 6}, {0, 0, -1}, 0.2)
                    .square({.reflectance = 0.5f, .one_sided = true}, {0, 0, 7}, {0, 0, -1}, 9.0)
                    .build();
  scene.materials.push_back(
      SceneBuilder().sphere({.specular = 1.0f}, {0, 0, 0}, 1.0).build().materials[0]);
  add_ball(scene, ball, 2);
  const TracedScene lit(scene);
  const CausticMap map(lit.mesh, shoot_photons({scene, lit.caster, lit.direct_light}, 1 << 18, 4));
  constexpr int across = 24;
  Eigen::ArrayXd E(across * across);
  for (int i = 0; i < across * across; ++i) {
    const Vector3d place((i % across + 0.5) / across * 8.0 - 4.0,
                         (i / across + 0.5) / across * 8.0 - 4.0, 7.0);
    const Ray ray{.origin = place - Vector3d(0, 0, 0.5), .direction = {0, 0, 1}};
    ElementHit hit;
    lit.caster.closest_hits({&ray, 1}, {&hit, 1});
    E[i] = static_cast<double>(map.irradiance(place, -Vector3d::UnitZ(), hit.element)[0]);
  }
  return E;
}

// Flat facets reflect one spot of light each; normals at vertices spread the light like the sphere.
TEST(SmoothNormals, MirrorBallThrowsLightAsTheSphereDoes) {
  const Eigen::ArrayXd exact = thrown_on_ceiling(Ball::exact);
  const auto error = [&](Ball ball) {
    return std::sqrt((thrown_on_ceiling(ball) - exact).square().mean()) / exact.mean();
  };
  const double smooth = error(Ball::smooth), faceted = error(Ball::faceted);
  RecordProperty("smooth", std::to_string(smooth));
  RecordProperty("faceted", std::to_string(faceted));
  // Facets lie up to 0.04 r below the sphere. Two maps with 160 neighbours differ by sqrt(2) times
  // sqrt(4/3 / 160) = 0.13 with independent photons, and by less with stratified ones.
  EXPECT_LT(smooth, 0.13);
  EXPECT_LT(smooth, 0.05 * faceted);
}

// A sheet has strongly tilted normals that face a lamp behind the sheet.
TEST(SmoothNormals, NoLightComesThroughASheet) {
  Scene scene = SceneBuilder().square({.exitance = 100.0f}, {3, 0, -1}, {-3, 0, 1}, 0.3).build();
  scene.materials.push_back(
      SceneBuilder().sphere({.reflectance = 0.8f}, {0, 0, 0}, 1.0).build().materials[0]);
  MeshBuilder sheet;
  const Loop loop = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  for (const Vector3d& lean : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0)}) {
    NormalLoop normals;
    for (const Vector3d& p : loop)
      normals.push_back(Vector3d(0, 0, 1) + (0.9 + 0.3 * p.x()) * lean);
    MeshBuilder mesh;
    mesh.add({.boundary = loop}, {}, normals);
    scene.surfaces.resize(1);
    scene.surfaces.push_back({.name = "sheet", .material = 1, .shape = mesh.mesh()});
    ASSERT_FALSE(FacetNormals(scene).is_empty());
    const TracedScene lit(scene);
    const Image image = lit.render(camera_towards({0, 0, 8}, {0, 0, 0}, 12, 16));
    EXPECT_EQ(image.radiance.maxCoeff(), 0.0f);
  }
}

}  // namespace
}  // namespace lightwell::smooth_normals_test
