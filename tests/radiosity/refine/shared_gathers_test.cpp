// Gathers that the vertices of crumbs share, and those that nobody reads.
#include "radiosity/refine/shared_gathers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>

#include "mesh/build_patches.h"
#include "radiosity/gather/patch_power.h"
#include "radiosity/reconstruct.h"
#include "radiosity/refine/error_reference.h"
#include "radiosity/refine/vertex_effort.h"
#include "radiosity/refine/vertex_gathers.h"
#include "radiosity/solve.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::shared_gathers_test {
namespace {

/// A ball of n rings and 2 n sectors of one surface, facing outwards.
void add_ball(Scene& scene, const Eigen::Vector3d& center, double radius, int n, int material) {
  PolygonMesh ball;
  const auto at = [&](int ring, int sector) {
    const double theta = std::numbers::pi * ring / n, phi = std::numbers::pi * sector / n;
    return Eigen::Vector3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                           std::cos(theta));
  };
  ball.vertices = {center + radius * at(0, 0), center + radius * at(n, 0)};
  for (int ring = 1; ring < n; ++ring) {
    for (int s = 0; s < 2 * n; ++s) ball.vertices.push_back(center + radius * at(ring, s));
  }
  const auto number = [n](int ring, int sector) {
    if (ring == 0) return 0;
    return ring == n ? 1 : 2 + (ring - 1) * 2 * n + sector % (2 * n);
  };
  for (int ring = 0; ring < n; ++ring) {
    for (int s = 0; s < 2 * n; ++s) {
      Facet facet;
      facet.boundary = {number(ring, s), number(ring + 1, s)};
      if (ring + 1 < n) facet.boundary.push_back(number(ring + 1, s + 1));
      if (ring > 0) facet.boundary.push_back(number(ring, s + 1));
      ball.facets.push_back(facet);
    }
  }
  scene.surfaces.push_back({.name = "ball", .material = material, .shape = ball});
}

/// A room of 4 x 4 x 3 m with a lamp under its ceiling, and a ball of 5 cm in 1152 facets over its
/// floor, of a material that `ball` adds.
template <class AddMaterial>
Scene room_with_ball(AddMaterial&& ball) {
  Scene scene;
  const int wall = test::add_material(scene, test::diffuse(scene.bands, 0.6f));
  const int red = test::add_material(scene, test::diffuse(scene.bands, 0.1f));
  const int lamp = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 100.0f));
  const std::array faces{red, wall, wall, wall, wall, wall};
  test::add_box(scene, {0, 0, 0}, {4, 4, 3}, faces, true);
  test::add_polygon(scene, "lamp", lamp,
                    {{2.5, 2.5, 2.9}, {2.5, 3.0, 2.9}, {3.0, 3.0, 2.9}, {3.0, 2.5, 2.9}});
  add_ball(scene, {1.3, 1.6, 0.3}, 0.05, 24, ball(scene));
  return scene;
}

Scene room_with_grey_ball() {
  return room_with_ball(
      [](Scene& scene) { return test::add_material(scene, test::diffuse(scene.bands, 0.5f)); });
}

/// A ball of brushed metal, which mirrors on both sides.
Scene room_with_metal_ball() {
  return room_with_ball([](Scene& scene) {
    Material metal = test::mirror(scene.bands, 0.8f);
    metal.specular_roughness = 0.2f;
    metal.one_sided = false;
    return test::add_material(scene, metal);
  });
}

constexpr int ball_surface = 7;

const MeshOptions mesh_options{.max_patch_size = 0.5, .to_be_refined = true};

SolveOptions options() {
  SolveOptions options{.mesh = mesh_options, .refine = {.tolerance = 0.05}};
  options.gather.rays = 256;
  options.caustic_rays = 1 << 12;
  return options;
}

TEST(SharedGathers, AreOfCrumbsAlone) {
  const Scene scene = room_with_grey_ball();
  const PatchMesh mesh = build_patches(scene, mesh_options);
  const std::vector<int> patch = vertex_patches(mesh);
  const SharedGathers shared = find_shared_gathers(scene, mesh);
  EXPECT_TRUE(shared.unread.empty());
  std::set<int> sharing, records;
  for (const InterpolatedVertex& at : shared.read) {
    EXPECT_EQ(mesh.surface[patch[at.vertex]], ball_surface);
    EXPECT_TRUE(sharing.insert(at.vertex).second);
    const std::set<int> ends(at.ends.begin(), at.ends.end());
    EXPECT_EQ(ends.size(), 4u);
    records.insert(ends.begin(), ends.end());
    for (const int end : ends) EXPECT_EQ(patch[end], patch[at.vertex]);
  }
  for (const int record : records) EXPECT_FALSE(sharing.contains(record));
  const auto of_ball = static_cast<std::size_t>(
      std::ranges::count_if(patch, [&](int p) { return mesh.surface[p] == ball_surface; }));
  std::printf("%zu vertices of %zu of the ball share the gathers of %zu\n", sharing.size(), of_ball,
              records.size());
  // Groups have more than 16 vertices and 4 records.
  EXPECT_GT(4 * sharing.size(), 3 * of_ball);
}

TEST(SharedGathers, AreNoneInRoomsOfLargeFacets) {
  Scene scene = room_with_grey_ball();
  scene.surfaces.pop_back();
  const SharedGathers shared = find_shared_gathers(scene, build_patches(scene, mesh_options));
  EXPECT_TRUE(shared.read.empty() && shared.unread.empty());
}

TEST(SharedGathers, OfMetalAreUnread) {
  const Scene scene = room_with_metal_ball();
  const PatchMesh mesh = build_patches(scene, mesh_options);
  const std::vector<char> unread = unread_patches(scene, mesh);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    EXPECT_EQ(unread[static_cast<std::size_t>(p)] != 0, mesh.surface[p] == ball_surface);
  }
  const SharedGathers shared = find_shared_gathers(scene, mesh);
  EXPECT_TRUE(shared.read.empty());
  EXPECT_FALSE(shared.unread.empty());
}

TEST(SharedGathers, BlackSurfacesAreMeasuredAndRead) {
  const Scene scene = room_with_ball(
      [](Scene& made) { return test::add_material(made, test::diffuse(made.bands, 0.0f)); });
  const std::vector<char> unread = unread_patches(scene, build_patches(scene, mesh_options));
  EXPECT_EQ(std::ranges::count(unread, 1), 0);
}

/// The pilot and the final gathers of a scene, with the rays that they cast.
struct Gathers {
  explicit Gathers(const Scene& scene) {
    const SolveOptions o = options();
    PatchMesh base = build_patches(scene, o.mesh);
    const ElementCaster base_caster(base);
    const DirectLight direct_light(scene, base);
    const auto form_factors =
        compute_form_factors({scene, base_caster, direct_light}, {.rays_per_patch = 128});
    solution = solve_radiosity(SolverMethod::automatic, base, *form_factors, o.solver);
    base_vertices = base.vertex_count();
    PilotGathers pilots(scene, base, direct_light, solution);
    pilot = pilots.gather(o).value();
    const ElementCaster caster = pilots.caster(*pilot.refined, pilot);
    reconstruct({scene, caster, direct_light}, o, pilot, solution, &kept);
  }

  RadiositySolution solution{};
  PilotGather pilot{};
  KeptGathers kept{};
  int base_vertices = 0;
  // Rays of the kept gather at the vertices of the ball, and their number.
  std::pair<std::int64_t, int> rays_on_ball(const KeptGather& of) const {
    const std::vector<int> patch = vertex_patches(*pilot.refined);
    std::int64_t rays = 0;
    int count = 0;
    for (int v = 0; v < pilot.refined->vertex_count(); ++v) {
      if (pilot.refined->surface[patch[v]] != ball_surface) continue;
      rays += of.rays[static_cast<std::size_t>(v)];
      ++count;
    }
    return {rays, count};
  }
};

TEST(SharedGathers, TakeHalfOfTheRaysAtMost) {
  const Gathers grey(room_with_grey_ball());
  const auto [rays, count] = grey.rays_on_ball(grey.kept.last);
  std::printf("grey ball: %lld rays at %d vertices\n", static_cast<long long>(rays), count);
  // Without sharing each vertex casts an eighth of 256 rays at least. Of more than 16 vertices of a
  // group, four cast those, or twice as many for the area that they stand for.
  EXPECT_LT(rays, std::int64_t{256 / 8} * count / 2);
  EXPECT_GT(rays, 0);
}

TEST(SharedGathers, OnMetalTakeFewRaysAndNoPilot) {
  const Scene scene = room_with_metal_ball();
  const Gathers metal(scene);
  const auto [pilot_rays, count] = metal.rays_on_ball(metal.kept.of_pilot);
  EXPECT_EQ(pilot_rays, 0);
  const auto [rays, all] = metal.rays_on_ball(metal.kept.last);
  std::printf("metal ball: %lld rays at %d vertices\n", static_cast<long long>(rays), all);
  // Two records of more than 32 vertices of a group, or of all of a smaller patch (8 at least),
  // with 256 / 32 rays each.
  EXPECT_LE(rays, std::int64_t{2} * 8 * all / 8);
  EXPECT_GT(rays, 0);
  const auto shared = static_cast<std::int64_t>(metal.pilot.unread.size());
  EXPECT_GT(2 * shared, all);
}

// Number of points of the base at which direct light is gathered, and of those that share.
std::pair<std::int64_t, std::int64_t> direct_gathers(const Scene& scene) {
  const PatchMesh mesh = build_patches(scene, mesh_options);
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  RefinedElements elements(mesh);
  const BandArray radiosity = BandArray::Ones(mesh.vertex_count(), scene.bands.count());
  const VertexGathers gathers({scene, caster, direct_light}, radiosity, {}, elements,
                              {.rays = 64, .shadows = {.min_rays = 4, .max_rays = 4}}, {});
  const auto shared = static_cast<std::int64_t>(gathers.shared().unread.size());
  return {gathers.gathers(), mesh.vertex_count() - shared};
}

TEST(SharedGathers, OnMetalGatherDirectLightAtRecordsAlone) {
  const auto [on_metal, records_and_room] = direct_gathers(room_with_metal_ball());
  EXPECT_EQ(on_metal, records_and_room);
  const auto [on_grey, all] = direct_gathers(room_with_grey_ball());
  EXPECT_EQ(on_grey, all);
  // Both sides of the metal have elements, and two of more than 8 vertices are records.
  EXPECT_LT(on_metal, all);
}

/// The interpolated light of a solution in the middles of elements of its ball, against gathers of
/// 4096 rays that read the same solution; relative to the mean light there.
struct BallErrors {
  explicit BallErrors(const Scene& scene) {
    const SolvedScene solved = solve_scene(scene, options());
    const PatchMesh& mesh = solved.mesh;
    const BandArray E = solved.solution.irradiance(), of_element = element_mean(mesh, E);
    const Eigen::ArrayXf within = error_bound(solved.solution);
    const Eigen::ArrayXd reference = error_references(mesh, E, solved.solution.parts);
    std::vector<GatherPoint> points;
    std::vector<int> elements;
    constexpr int one_in = 8;
    for (int e = 0; e < mesh.element_count(); e += one_in) {
      const int p = mesh.patch[e];
      if (mesh.surface[p] != ball_surface || mesh.is_back[p] != 0) continue;
      const PatchPoint at = element_center(mesh, e);
      points.push_back({at.position, at.normal, mesh.facet[e]});
      elements.push_back(e);
    }
    const ElementCaster caster(mesh);
    const DirectLight direct_light(scene, mesh);
    const GatheredIrradiance truth = gather_irradiance({scene, caster, direct_light},
                                                       gatherable_radiosity(mesh, direct_light, E),
                                                       points, {.rays = 4096, .replica = 77});
    double square = 0.0, light = 0.0, bound = 0.0, exceeding = 0.0;
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const int e = elements[i];
      const double own = double{truth.direct(row, 0)} + double{truth.indirect(row, 0)};
      const double off = double{of_element(e, 0)} - own;
      const double allowed = double{within[e]} * reference[e];
      square += off * off;
      bound += allowed * allowed;
      light += own;
      exceeding += std::abs(off) > allowed ? 1.0 : 0.0;
    }
    const auto count = static_cast<double>(elements.size());
    rms = std::sqrt(square / count) / (light / count);
    rms_bound = std::sqrt(bound / count) / (light / count);
    exceeded = exceeding / count;
    std::printf("%zu elements: RMS error %.2f %%, RMS bound %.2f %%, exceeded at %.1f %%\n",
                elements.size(), 100.0 * rms, 100.0 * rms_bound, 100.0 * exceeded);
  }
  double rms = 0.0, rms_bound = 0.0, exceeded = 0.0;
};

TEST(SharedGathers, AgreeWithAConvergedGather) {
  const BallErrors errors(room_with_grey_ball());
  // A single ray is off by about the light itself, and four records of 32 rays or more by
  // 1 / sqrt(128) = 9 % if their rays were independent; stratified ones leave half of that.
  EXPECT_LT(errors.rms, 0.05);
  // Bounds hold at 19 of 20 places.
  EXPECT_LT(errors.exceeded, 0.05);
}

/// The room with a grey ball, and four bright spots on a wall, by small lamps near the wall.
Scene room_with_bright_spots() {
  Scene scene = room_with_grey_ball();
  const int lamp = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 300.0f));
  constexpr double near = 0.4, half = 0.1, z = 1.5;
  for (int i = 0; i < 4; ++i) {
    const double x = 0.5 + i, y = 4.0 - near;
    test::add_polygon(scene, "small lamp", lamp,
                      {{x - half, y, z - half},
                       {x - half, y, z + half},
                       {x + half, y, z + half},
                       {x + half, y, z - half}});
  }
  return scene;
}

// A difference from the records that a bright spot feigns is within the bound that is said for it.
TEST(SharedGathers, BoundsHoldBesideBrightSpots) {
  const BallErrors errors(room_with_bright_spots());
  EXPECT_LT(errors.rms, errors.rms_bound);
  // Bounds hold at 19 of 20 places.
  EXPECT_LT(errors.exceeded, 0.05);
}

// Rays of the two pilot gathers at vertices that share gathers, and those of the final gather.
struct PilotRays {
  explicit PilotRays(const Scene& scene) {
    constexpr int rays = 256;
    const PatchMesh mesh = build_patches(scene, mesh_options);
    const std::vector<InterpolatedVertex> read = find_shared_gathers(scene, mesh).read;
    const RefinedElements elements(mesh);
    const VertexEffort effort(elements, {.rays = rays}, {}, false, read);
    const int typical = effort.pilot_rays(rays);
    for (const InterpolatedVertex& at : read) {
      all += 2 * effort.rays(at.vertex);
      most = std::max(most, effort.rays(at.vertex));
    }
    most_of_typical = static_cast<double>(most) / typical;
    for (const int of_vertex : share_rays(mesh, read, {}, std::array{rays})) final += of_vertex;
  }
  std::int64_t all = 0, final = 0;
  int most = 0;
  double most_of_typical = 0.0;  // most at a vertex, over those of typical vertices
};

TEST(SharedGathers, PilotRaysFollowTheNumberOfCrumbs) {
  const PilotRays few(room_with_grey_ball());
  Scene scene = room_with_grey_ball();
  for (int i = 0; i < 40; ++i) {
    add_ball(scene, {0.3 + 0.4 * (i % 8), 0.3 + 0.6 * (i / 8), 0.8}, 0.05, 24,
             scene.surfaces.back().material);
  }
  const PilotRays many(scene);
  for (const PilotRays& of : {few, many}) {
    std::printf("%lld pilot rays, %lld of the final gather; %.3f of typical vertices' at most\n",
                static_cast<long long>(of.all), static_cast<long long>(of.final),
                of.most_of_typical);
  }
  // Few crumbs cast as many pilot rays as stay below half of the final gather's.
  EXPECT_LE(few.all, few.final / 2);
  EXPECT_TRUE(few.most_of_typical == 1.0 || 2 * few.all > few.final / 2);
  EXPECT_GT(few.most_of_typical, 1.0 / 8.0);
  // Many crumbs keep the eighth of vertices of small elements.
  EXPECT_DOUBLE_EQ(many.most_of_typical, 1.0 / 8.0);
}

TEST(SharedGathers, OnMetalKnowHowRoughTheyAre) {
  const BallErrors errors(room_with_metal_ball());
  // Groups reach over patches, whose normals turn by 20 degrees about their mean, and the light of
  // a group is one value. Two records tell its spread to a factor of two, so that more places
  // exceed their bounds than where bounds are averages of many vertices.
  EXPECT_LT(errors.rms, errors.rms_bound);
  EXPECT_LT(errors.exceeded, 0.15);
}

}  // namespace
}  // namespace lightwell::shared_gathers_test
