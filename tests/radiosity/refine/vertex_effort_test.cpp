#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <vector>

#include "mesh/build_patches.h"
#include "radiosity/refine/refine_solution.h"
#include "radiosity/refine/vertex_gathers.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::vertex_effort_test {
namespace {

using Eigen::Vector3d;

// A floor of 4 x 4 m below a roof over one half of it, under a uniform sky, and a curved sheet of
// 40 x 40 facets of 1 cm on the floor.
Scene half_open_place() {
  Scene scene;
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_polygon(scene, "floor", grey, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  test::add_polygon(scene, "roof", grey, {{0, 0, 2}, {0, 4, 2}, {2, 4, 2}, {2, 0, 2}});
  PolygonMesh sheet;
  constexpr int n = 40;
  constexpr double step = 0.01;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double x = step * i, y = step * j;
      sheet.vertices.push_back({1.8 + x, 1.8 + y, 0.3 + 0.1 * x * x});
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      sheet.facets.push_back({{a, a + 1, a + n + 2, a + n + 1}});
    }
  }
  scene.surfaces.push_back({.name = "sheet", .material = grey, .shape = std::move(sheet)});
  scene.sky = test::even_sky(scene.bands, 1.0f, 0.2f);
  return scene;
}

struct Place {
  Scene scene = half_open_place();
  PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
  ElementCaster caster{mesh};
  DirectLight direct_light{scene, mesh};
  BandArray radiosity = BandArray::Ones(mesh.vertex_count(), scene.bands.count());
  RefinedElements elements{mesh};

  // Options where refinement may make `times` as many elements as there are.
  RefineOptions options(std::int64_t times) const {
    RefineOptions options{.max_elements = times * mesh.element_count()};
    options.efforts = {{.tolerance = options.tolerance,
                        .sky_noise = 0.01,
                        .rays = 256,
                        .irradiance = 0.5 * std::numbers::pi}};
    return options;
  }
  static GatherOptions gather() { return {.rays = 256, .shadows = {.sky_rays = 1024}}; }

  VertexGathers gathers(std::int64_t times) {
    return {{scene, caster, direct_light}, radiosity, {}, elements, gather(), options(times)};
  }
};

int count_of_differences(const VertexGathers& a, const VertexGathers& b, int vertices) {
  int count = 0;
  for (int v = 0; v < vertices; ++v) {
    count += (a.direct().row(v) != b.direct().row(v)).any() ? 1 : 0;
  }
  return count;
}

TEST(VertexEffort, SkyNoiseIsLargerAtSmallElementsWhereFewMayBeSplit) {
  Place place;
  const VertexGathers fine = place.gathers(16), noisy = place.gathers(1);
  const std::vector<int> patch = vertex_patches(place.mesh);
  int typical = 0, small = 0;
  for (int v = 0; v < place.mesh.vertex_count(); ++v) {
    const bool is_alike = (fine.direct().row(v) == noisy.direct().row(v)).all();
    if (place.scene.surfaces[place.mesh.surface[patch[v]]].name == "sheet") {
      small += is_alike ? 0 : 1;
    } else {
      EXPECT_TRUE(is_alike) << v;
      ++typical;
    }
  }
  EXPECT_GT(typical, 0);
  EXPECT_GT(small, 0);
}

TEST(VertexEffort, SkyNoiseFallsWhereLittleOtherErrorIsLeft) {
  Place place;
  const VertexGathers fine = place.gathers(16);
  VertexGathers noisy = place.gathers(1);
  const int vertices = place.mesh.vertex_count();
  const int before = count_of_differences(noisy, fine, vertices);
  constexpr double much = 0.2, little = 0.01;
  EXPECT_FALSE(noisy.sharpen_sky({much}));
  EXPECT_EQ(count_of_differences(noisy, fine, vertices), before);
  EXPECT_TRUE(noisy.sharpen_sky({little}));
  const int after = count_of_differences(noisy, fine, vertices);
  EXPECT_LT(after, before);
  constexpr double half_of_dome = 0.5 * std::numbers::pi;
  // Vertices that still differ had reached the goal with fewer rays: 0.7 of sky_noise times the
  // root of the fineness, which is 8 at most, as a share of the place's irradiance.
  constexpr double goal = 0.7 * 8.0 * 0.01;
  for (int v = 0; v < vertices; ++v) {
    const double E = double{noisy.direct()(v, 0)};
    if ((noisy.direct().row(v) == fine.direct().row(v)).all()) continue;
    EXPECT_LE(noisy.visibility(v).drawn_noise, goal * std::max(half_of_dome, E / 4.0)) << v;
  }
  EXPECT_FALSE(noisy.sharpen_sky({little}));
}

TEST(VertexEffort, RefinementThatIsStoppedHasTheLightOfItsBase) {
  Place place;
  const VertexGathers alone = place.gathers(16);
  bool is_stopped = false;
  GatherOptions gather = Place::gather();
  gather.run.progress = [&is_stopped](std::string_view, double) { return !is_stopped; };
  const LitScene lit{place.scene, place.caster, place.direct_light};
  SolutionRefinement refinement(lit, place.radiosity, {}, place.elements, gather,
                                place.options(16));
  is_stopped = true;
  EXPECT_THROW(refinement.refine(place.options(16)), Interrupted);
  const int count = place.mesh.vertex_count();
  const GatheredIrradiance found = refinement.light_at_base();
  ASSERT_EQ(found.direct.rows(), count);
  EXPECT_TRUE((found.direct == alone.direct().topRows(count)).all());
  EXPECT_GT(found.indirect.minCoeff(), 0.0f);
}

TEST(VertexEffort, NeighboursEvenOutTheNoiseOfTheSky) {
  Place place;
  const LitScene lit{place.scene, place.caster, place.direct_light};
  const VertexGathers noisy = place.gathers(1);
  std::vector<int> vertices(static_cast<std::size_t>(place.mesh.vertex_count()));
  std::iota(vertices.begin(), vertices.end(), 0);
  const Eigen::ArrayXf variance = noisy.noisy_sky_variance(vertices);
  SolutionRefinement refinement(lit, place.radiosity, {}, place.elements, Place::gather(),
                                place.options(1));
  const RefinedSolution evened = refinement.refine(place.options(1));
  // 32 and 64 times the rays leave less than a fifth of the noise.
  std::vector<GatherPoint> points;
  for (const int v : vertices) {
    const PatchPoint at = place.elements.inside(v, 0.02 / 16);
    points.push_back({at.position, at.normal, place.mesh.facet[at.element]});
  }
  const BandArray exact =
      gather_direct(lit, points, {.rays = 256, .shadows = {.sky_rays = 16384}}, nullptr);
  double before = 0.0, after = 0.0;
  for (std::size_t i = 0; i < evened.refined.vertex.size(); ++i) {
    const int v = evened.refined.vertex[i];
    if (v >= place.mesh.vertex_count() || !(variance[v] > 0.0f)) continue;
    before += std::pow(double{noisy.direct()(v, 0) - exact(v, 0)}, 2);
    after +=
        std::pow(double{evened.pilot.direct(static_cast<Eigen::Index>(i), 0) - exact(v, 0)}, 2);
  }
  // A vertex that takes the share a of the mean of n neighbours keeps (1 - a)^2 + a^2 / n of its
  // squared noise s^2, where a = 1 / (1 + 1 / n + d^2 / s^2). If differences beyond noise, d^2,
  // were as large as the noise itself, that would be 0.31 for the 8 neighbours of most vertices,
  // and 0.34 for the 5 of the tenth that lies at borders.
  EXPECT_GT(before, 0.0);
  EXPECT_LT(after, 0.32 * before);
  std::printf("noise of the sky: %.3g of the squared error is left\n", after / before);
}

}  // namespace
}  // namespace lightwell::vertex_effort_test
