#include "raytrace/shading/irradiance_records.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>
#include <utility>

#include "radiosity/solve.h"
#include "raytrace/picture_records.h"
#include "raytrace/scene_renderer.h"
#include "raytrace/seen_places.h"
#include "scene/parallel.h"
#include "scene/sampling.h"
#include "tests/raytrace/lit_scene.h"

namespace lightwell::irradiance_records_test {
namespace {

using Eigen::Vector3d;

const Vector3d up = Vector3d::UnitZ();

IrradianceRecord record(const Vector3d& at, float E, double radius) {
  return {.position = at,
          .normal = up,
          .radius = radius,
          .irradiance = constant_spectrum(rgb_bands(), E)};
}

// Records on a grid of steps of one over a square, E by place.
template <class Light>
std::vector<IrradianceRecord> grid(int half, double radius, Light E) {
  std::vector<IrradianceRecord> records;
  for (int x = -half; x <= half; ++x) {
    for (int y = -half; y <= half; ++y) {
      records.push_back(record(Vector3d(x, y, 0.0), static_cast<float>(E(x, y)), radius));
    }
  }
  return records;
}

double at(const IrradianceRecords& records, double x, double y) {
  return static_cast<double>(records.fit(Vector3d(x, y, 0.0), up).value().irradiance[0]);
}

// Places about which the grid is symmetric: there, the ridge draws no value towards the mean.
TEST(IrradianceRecords, FollowAPlane) {
  const auto E = [](double x, double y) { return 10.0 + 0.5 * x - 0.25 * y; };
  const IrradianceRecords records(grid(4, 2.5, E));
  const double roundings = std::ldexp(8.0, -24) * 13.0;  // of floats of up to 13
  for (const double step : {0.0, 0.5}) {
    EXPECT_NEAR(at(records, step, step), E(step, step), roundings);
    EXPECT_NEAR(at(records, 1.0 + step, step), E(1.0 + step, step), roundings);
  }
}

TEST(IrradianceRecords, ServeTheirOwnSurfaceAlone) {
  const IrradianceRecords records({record(Vector3d::Zero(), 1.0f, 1.0)});
  EXPECT_GT(records.coverage({0.5, 0.0, 0.0}, up), 0.0);
  EXPECT_EQ(records.coverage({1.1, 0.0, 0.0}, up), 0.0) << "beyond the radius";
  EXPECT_EQ(records.coverage({0.0, 0.0, 0.3}, up), 0.0) << "another surface above";
  EXPECT_EQ(records.coverage({0.0, 0.0, 0.0}, -up), 0.0) << "the other side";
  const Vector3d turned = Vector3d(std::sin(0.3), 0.0, std::cos(0.3));
  EXPECT_EQ(records.coverage({0.0, 0.0, 0.0}, turned), 0.0) << "17 degrees about an edge";
  EXPECT_FALSE(records.fit({3.0, 0.0, 0.0}, up).has_value());
}

TEST(IrradianceRecords, NoneServeAnywhere) {
  EXPECT_FALSE(IrradianceRecords({}).fit(Vector3d::Zero(), up).has_value());
}

// Light of 1 and of 3 with an edge between, and noise of 5 %, whose variance the records know. Near
// the edge no fit agrees with a record, which keeps its value. Far off, the widest fit holds some
// 200 records, or 50 at a corner. Its weights, which fall evenly to 0, leave 1.3 / sqrt(50) of the
// noise of 50 records at most.
TEST(EvenOut, CalmsNoiseAndKeepsAnEdge) {
  constexpr double noise = 0.05, edge = -0.5, bright = 3.0;
  constexpr int half = 20;
  const auto light = [](double x) { return x < edge ? 1.0 : bright; };
  std::vector<IrradianceRecord> records = grid(half, 2.0, [&](int x, int y) {
    const auto key =
        random_key(static_cast<std::uint64_t>(x + half), static_cast<std::uint64_t>(y + half));
    return light(x) * (1.0 + noise * std::sqrt(12.0) * (random_uniform(key) - 0.5));
  });
  for (IrradianceRecord& each : records) {
    each.variance = std::pow(noise * light(each.position.x()), 2);
  }
  even_out(records);
  double far = 0.0, worst = 0.0;
  int count = 0;
  for (const IrradianceRecord& each : records) {
    const double x = each.position.x();
    const double error = static_cast<double>(each.irradiance[0]) / light(x) - 1.0;
    worst = std::max(worst, std::abs(error) * light(x) / bright);
    if (std::abs(x - edge) < 8.0) continue;
    far += error * error;
    ++count;
  }
  std::printf("noise far off %.4f, worst %.4f\n", std::sqrt(far / count), worst);
  EXPECT_LT(std::sqrt(far / count), 1.3 / std::sqrt(50.0) * noise);
  // Three standard errors by which a fit may differ from a record, by the noise of the bright
  // records around, and the noise of the record, which is even within sqrt(3) standard errors.
  EXPECT_LT(worst, (3.0 + std::sqrt(3.0)) * noise);
}

// Light of 1 with noise of 10 %, which each record tells by the difference between two halves of a
// gather: its square has a deviation of sqrt(2) times itself. A record has four others within its
// radius. The widest fit, a cone of the radius R = 4.8 over a grid of steps of one, weighs like
// (2 / 3) pi R^2 = 48 records. One record of some 300 differs by more than three standard errors
// by chance and keeps a fit of five records or more, so that the mean square of the noise left is
// at most 1 / 48 + 1 / 300 of that of the records, which is itself known to sqrt(2 / 961) = 5 %.
TEST(EvenOut, KnowsTheNoiseByAllAround) {
  constexpr double noise = 0.1;
  constexpr int half = 20, margin = 5;
  std::vector<IrradianceRecord> records = grid(half, 1.2, [](int, int) { return 1.0; });
  for (std::size_t i = 0; i < records.size(); ++i) {
    const auto of_half = [&](std::uint64_t number) {
      const double spread = std::sqrt(2.0) * noise * std::sqrt(12.0);
      return 1.0 + spread * (random_uniform(random_key(i, number)) - 0.5);
    };
    const double first = of_half(0), second = of_half(1);
    records[i].irradiance.setConstant(static_cast<float>(0.5 * (first + second)));
    records[i].variance = 0.25 * (first - second) * (first - second);
  }
  even_out(records);
  double squares = 0.0;
  int count = 0;
  for (const IrradianceRecord& each : records) {
    if (each.position.cwiseAbs().maxCoeff() > half - margin) continue;
    squares += std::pow(static_cast<double>(each.irradiance[0]) - 1.0, 2);
    ++count;
  }
  std::printf("noise left %.4f\n", std::sqrt(squares / count));
  EXPECT_LT(squares / count, 1.05 * (1.0 / 48.0 + 1.0 / 300.0) * noise * noise);
}

// A record of radius 44 m, 20 m from one of 0.2 m.
TEST(IrradianceRecords, ReachNoFartherThanNeighboursAllow) {
  constexpr double growth = 0.1;
  const double roundings = std::ldexp(4.0 * 2.2, -53);  // of growth, distance, product and sum
  const IrradianceRecord in_the_open = record({20, 0, 0}, 1.0f, 44.0);
  const IrradianceRecord in_a_room = record({0, 0, 0}, 4.0f, 0.2);
  const RecordNeighbours neighbours({in_the_open, in_a_room}, growth);
  EXPECT_NEAR(neighbours.allowed_radius(in_the_open), 0.2 + growth * 20.0, roundings);
  EXPECT_EQ(neighbours.allowed_radius(in_a_room), 0.2);
  IrradianceRecord wall = in_the_open;
  wall.normal = Vector3d::UnitX();
  EXPECT_EQ(neighbours.allowed_radius(wall), 44.0) << "which serves no floor";
  EXPECT_EQ(neighbours.allowed_radius(record({20, 0, 0}, 1.0f, 19.0)), 19.0) << "too far away";
}

// A room, solved on a mesh of one element a patch that is not refined.
struct SolvedRoom {
  Scene scene{};
  Camera camera{};
  SolvedScene solved{};

  void solve(double patch_size, int rays) {
    camera.up = (up - up.dot(camera.direction) * camera.direction).normalized();
    SolveOptions options;
    options.mesh.max_patch_size = patch_size;
    options.mesh.elements_per_patch_edge = 1;
    options.refine.tolerance = 0.0;
    options.gather.rays = rays;
    solved = solve_scene(scene, options);
  }
  Image picture(const RenderOptions& options) const {
    return SceneRenderer(scene, solved.mesh, solved.solution).render(camera, options);
  }
};

// A room with a block, lit by a lamp in the ceiling, on a coarse mesh.
SolvedRoom coarse_room() {
  SolvedRoom room{
      SceneBuilder()
          .box({.reflectance = 0.7f, .one_sided = true}, {0, 0, 0}, {4, 3, 2.5}, true)
          .box({.reflectance = 0.6f, .one_sided = true}, {1.6, 1, 0}, {2.2, 1.7, 1.1}, false)
          .square({.exitance = 20.0f, .one_sided = true}, {2.9, 1.5, 2.45}, -up, 0.3)
          .build(),
      {.position = {0.3, 0.4, 1.6},
       .direction = Vector3d(1.0, 0.8, -0.35).normalized(),
       .fov_degrees = 75.0,
       .width = 64,
       .height = 48}};
  room.solve(1.5, 64);
  return room;
}

double difference(const Image& a, const Image& b) {
  return std::sqrt((a.radiance - b.radiance).square().mean()) / b.radiance.mean();
}

// Records have the light that a gather at every pixel finds, but for their noise of 3 %; the mesh
// lacks the shadow of the block in indirect light.
TEST(PictureRecords, AreNearerToAGatherThanACoarseMesh) {
  const SolvedRoom room = coarse_room();
  const Image gathered = room.picture({.pass = Pass::gather, .gather_rays = 1024});
  const double with = difference(room.picture({}), gathered),
               without = difference(room.picture({.has_records = false}), gathered);
  std::printf("indirect light by records %.2f %% off a gather, by the mesh %.2f %%\n", 100 * with,
              100 * without);
  EXPECT_LT(with, IrradianceRecords::usual_error);
  EXPECT_GT(without, IrradianceRecords::usual_error) << "the mesh is too fine for this test";
}

// A mirror shows the dark floor below a board at a grazing angle, where pixels are a metre apart on
// the floor; records there do not serve on the bright floor that the picture shows from nearby.
TEST(PictureRecords, OfGrazingReflectionsDoNotServeWhereThePictureShowsMore) {
  SolvedRoom room{
      SceneBuilder()
          .box({.reflectance = 0.7f, .one_sided = true}, {0, 0, 0}, {6.5, 3, 2.5}, true)
          .box({.reflectance = 0.3f, .one_sided = true}, {3, 0.3, 0.15}, {4.2, 2.7, 0.2}, false)
          .polygon({.specular = 0.9f, .one_sided = true},
                   {{6, 0.2, 0.01}, {6, 0.2, 1.2}, {6, 2.8, 1.2}, {6, 2.8, 0.01}})
          .square({.exitance = 20.0f, .one_sided = true}, {1.5, 1.5, 2.45}, -up, 0.3)
          .build(),
      {.position = {0.3, 1.5, 1.2},
       .direction = Vector3d(1.0, 0.0, -0.25).normalized(),
       .fov_degrees = 60.0,
       .width = 64,
       .height = 48}};
  room.solve(1.5, 64);
  const Image gathered = room.picture({.pass = Pass::gather, .gather_rays = 1024});
  const double off = difference(room.picture({}), gathered);
  std::printf("beside a mirror, records are %.2f %% off a gather\n", 100 * off);
  EXPECT_LT(off, IrradianceRecords::usual_error);
}

// Corners of a hole of 2 m x 1.2 m in a wall.
constexpr double left = 1.0, right = 3.0, low = 0.6, high = 1.8;

// A room of 4 m x 4 m on open ground, which is its floor too, with the hole in the wall y = 4.
SolvedRoom room_on_ground(SceneBuilder lamps, double patch_size, int rays,
                          std::optional<Sky> sky = {}) {
  constexpr double height = 2.5;
  const Paint wall{.reflectance = 0.7f};
  const auto part = [&](double x0, double x1, double z0, double z1) {
    lamps.polygon(wall, {{x0, 4, z0}, {x1, 4, z0}, {x1, 4, z1}, {x0, 4, z1}});
  };
  part(0, left, 0, height);
  part(right, 4, 0, height);
  part(left, right, 0, low);
  part(left, right, high, height);
  lamps.polygon(wall, {{0, 0, 0}, {4, 0, 0}, {4, 0, height}, {0, 0, height}})
      .polygon(wall, {{0, 0, 0}, {0, 4, 0}, {0, 4, height}, {0, 0, height}})
      .polygon(wall, {{4, 0, 0}, {4, 4, 0}, {4, 4, height}, {4, 0, height}})
      .polygon(wall, {{0, 0, height}, {4, 0, height}, {4, 4, height}, {0, 4, height}})
      .polygon({.reflectance = 0.3f, .one_sided = true},
               {{-30, -30, 0}, {30, -30, 0}, {30, 30, 0}, {-30, 30, 0}});
  // The ground that shows in the hole is up to 26 m away.
  SolvedRoom room{lamps.build(),
                  {.position = {2.0, 0.5, 1.5},
                   .direction = Vector3d(0.0, 1.0, -0.3).normalized(),
                   .fov_degrees = 80.0,
                   .width = 64,
                   .height = 64}};
  room.scene.sky = std::move(sky);
  room.solve(patch_size, rays);
  return room;
}

// The rays of places in the open miss the room, and their radii are as wide as the grid allows.
TEST(PictureRecords, OfTheOpenDoNotServeInARoomOnTheSameGround) {
  const SolvedRoom room = room_on_ground(
      SceneBuilder().square({.exitance = 20.0f, .one_sided = true}, {2, 2, 2.45}, -up, 0.3), 1.5,
      256);
  const Image gathered = room.picture({.pass = Pass::gather, .gather_rays = 1024});
  const Image by_records = room.picture({});
  constexpr int floor = 64 * 24;  // pixels of the lowest rows
  const auto mean = [&](const Image& image) { return image.radiance.bottomRows(floor).mean(); };
  const auto ratio = static_cast<double>(mean(by_records) / mean(gathered));
  std::printf("the floor by records over a gather %.4f\n", ratio);
  EXPECT_NEAR(ratio, 1.0, IrradianceRecords::usual_error);
}

// Light of the sky comes through a solid pane, which few of the 64 rays of a record meet; their
// noise is 17 % of the light. The error of the mesh, of gathers of 1024 rays, is 9 %.
TEST(PictureRecords, AreLeftOutWhereTheyAreNoisierThanTheMesh) {
  const Paint glass{.index_of_refraction = 1.5f};
  const Sky sky{.up = up,
                .north = Vector3d::UnitY(),
                .bright = up,
                .scale = constant_spectrum(rgb_bands(), 10.0f),
                .ground = constant_spectrum(rgb_bands(), 1.0f)};
  const SolvedRoom room = room_on_ground(
      SceneBuilder().box(glass, {left, 3.9, low}, {right, 3.95, high}, false), 0.5, 1024, sky);
  const Image by_default = room.picture({.gather_rays = 64});
  const Image by_mesh = room.picture({.has_records = false});
  EXPECT_TRUE((by_default.radiance == by_mesh.radiance).all());
}

// A record that serves farther than its neighbours allow is narrowed by the last grid, too, and
// leaves places to no record, where the coarse mesh shows. A record covers what is within three
// quarters of its radius, where its weight is 0.25; a place is a record itself or is covered so.
TEST(PictureRecords, LeaveNoPlaceUncovered) {
  SolvedRoom room{
      SceneBuilder()
          .box({.reflectance = 0.7f, .one_sided = true}, {0, 0, 0}, {4, 3, 2.5}, true)
          .box({.reflectance = 0.6f, .one_sided = true}, {1.6, 1, 0}, {2.2, 1.7, 1.1}, false)
          .box({.reflectance = 0.5f, .one_sided = true}, {2, 2.98, 1}, {2.6, 2.99, 1.6}, false)
          .square({.exitance = 20.0f, .one_sided = true}, {2.9, 1.5, 2.45}, -up, 0.3)
          .build(),
      coarse_room().camera};
  room.solve(1.5, 64);
  const DirectLight direct_light(room.scene, room.solved.mesh);
  const ElementCaster caster(room.solved.mesh);
  const LitScene lit{room.scene, caster, direct_light};
  const CameraRays rays(room.camera);
  const RenderOptions options;
  const auto records = find_records(lit, room.solved.solution, room.camera, rays, options);
  ASSERT_NE(records, nullptr);
  int places = 0, uncovered = 0;
  for (const auto& place : SeenPlaces(lit, room.camera, rays, options.max_depth).on_grid(1)) {
    if (!place) continue;
    ++places;
    uncovered += records->coverage(place->at.position, place->at.smooth_normal) < 0.25 ? 1 : 0;
  }
  std::printf("%d of %d places uncovered\n", uncovered, places);
  EXPECT_GT(places, 64 * 48 / 2);
  EXPECT_EQ(uncovered, 0);
}

// Pictures of the mesh's light show the indirect light of given records.
TEST(PictureRecords, ServePicturesOfTheMeshsLight) {
  const SolvedRoom room = coarse_room();
  const RenderOptions gather{
      .pass = Pass::gather, .gather_rays = 1024, .layers = {Layer::indirect}};
  const BandArray gathered = room.picture(gather).layers.values;
  SceneRenderer renderer(room.scene, room.solved.mesh, room.solved.solution);
  RenderOptions options{.pass = Pass::interpolate, .layers = {Layer::indirect}};
  options.records = renderer.records(room.camera, {});
  ASSERT_NE(options.records, nullptr);
  const BandArray by_records = renderer.render(room.camera, options).layers.values;
  EXPECT_LT(std::sqrt((by_records - gathered).square().mean()) / gathered.mean(),
            IrradianceRecords::usual_error);
}

// The time is up when the second grid begins.
TEST(PictureRecords, OfTheWidestGridsAreKeptForWantOfTime) {
  const SolvedRoom room = coarse_room();
  SceneRenderer renderer(room.scene, room.solved.mesh, room.solved.solution);
  RenderOptions hurried;
  bool is_up = false;
  hurried.run.progress = [&](std::string_view, double share) {
    is_up = share > 0.0;
    return true;
  };
  hurried.run.seconds_left = [&] { return is_up ? 0.0 : 1.0; };
  const auto few = renderer.records(room.camera, hurried);
  ASSERT_NE(few, nullptr);
  RenderOptions with_few, with_all;
  with_few.records = few;
  with_all.records = renderer.records(room.camera, {});
  EXPECT_FALSE((renderer.render(room.camera, with_few).radiance ==
                renderer.render(room.camera, with_all).radiance)
                   .all())
      << "all grids were done";
}

TEST(PictureRecords, AreTheSameForAnyNumberOfThreads) {
  const SolvedRoom room = coarse_room();
  const auto with_threads = [&](int n) {
    const ThreadLimit limit(n);
    return room.picture({});
  };
  EXPECT_TRUE((with_threads(1).radiance == with_threads(3).radiance).all());
}

}  // namespace
}  // namespace lightwell::irradiance_records_test
