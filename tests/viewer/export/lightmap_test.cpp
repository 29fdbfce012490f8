#include "viewer/export/lightmap.h"

#include <gtest/gtest.h>

#include <numbers>

#include "radiosity/emitters/emitter.h"
#include "raytrace/readings/probe.h"
#include "scene/errors.h"
#include "scene/parallel.h"
#include "tests/raytrace/lit_scene.h"
#include "tests/temporary_folder.h"
#include "tests/viewer/lightmap_reader.h"
#include "tests/viewer/lit_sides.h"

namespace lightwell::lightmap_test {
namespace {

using Eigen::Vector3d;

SolvedScene solved_of(const TracedScene& lit) {
  return {lit.mesh, lit.solution};
}

/// A room with a block, a ball and smoothly varying light.
const TracedScene& furnished() {
  static const auto lit = [] {
    const Paint paint{.reflectance = 0.5f, .one_sided = true};
    auto scene = std::make_unique<TracedScene>(SceneBuilder()
                                                   .box(paint, {0, 0, 0}, {4, 3, 2.5}, true)
                                                   .box(paint, {1, 1, 0}, {1.6, 1.5, 0.7}, false)
                                                   .sphere(paint, {2.8, 1.4, 0.5}, 0.4)
                                                   .build(),
                                               0.5);
    scene->set_direct([](const Vector3d& p) {
      return static_cast<float>(5.0 + std::sin(1.3 * p.x()) + std::cos(1.7 * p.y()) * p.z());
    });
    return scene;
  }();
  return *lit;
}

/// A bilinear filter reproduces light that is bilinear over a wall, also at the border, where the
/// padding is extrapolated with the same slope. Beyond a corner the extrapolated product s t of
/// both slopes has the wrong sign: half a texel d/2 off in both directions the error is 2 (d/2)^2
/// of the product, and a filter in the corner's texel weighs it by at most a quarter.
TEST(Lightmap, BilinearLightIsReadAsItIs) {
  SolvedQuads quads;
  const auto light = [](float a) { return Eigen::Array3f(a, 2.0f * a, 1.0f); };
  const std::array<Eigen::Array3f, 4> corners = {light(1), light(2), light(5), light(3)};
  quads.add({{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}}, corners);
  quads.add({{{0, 0, 1}, {0, 1, 1}, {3, 1, 1}, {3, 0, 1}}}, corners);
  const SolvedScene solved = quads.solved();
  const BakedModel model = bake_model(solved, {});
  const LightmapLayout layout = lay_out_lightmap(model, solved.mesh, {.size = 64});
  const LightmapReader reader(layout, model, solved);
  for (int f = 0; f < model.face_count(); ++f) {
    const ChartRectangle& place = layout.place[reader.chart_of(f)];
    // The product of slopes over the whole wall is 1 - 2 + 5 - 3 = 1, doubled by light(a).
    const double at_corner = 0.25 * 2.0 * 2.0 * 0.25 / (place.width * place.height);
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector2d uv = spread(i);
      const auto weights = corner_weights(model, f, uv.x(), uv.y());
      const Eigen::ArrayXf read = reader.irradiance(f, weights);
      for (int k = 0; k < 3; ++k) {
        double E = 0.0;
        for (int c = 0; c < 4; ++c) E += weights[c] * model.irradiance(model.faces[f][c], k);
        EXPECT_NEAR(read[k], E, at_corner + 1e-5) << uv.transpose();
      }
    }
  }
}

/// Relative RMS difference over the room between filtered lightmaps and the solution.
double reading_error(const TracedScene& lit, int size) {
  const SolvedScene solved = solved_of(lit);
  const BakedModel model = bake_model(solved, lit.scene);
  const LightmapLayout layout = lay_out_lightmap(model, solved.mesh, {.size = size});
  const LightmapReader reader(layout, model, solved);
  std::vector<Probe> probes;
  std::vector<float> read;
  for (int f = 0; f < model.face_count(); ++f) {
    const bool is_ball = layout.charts[reader.chart_of(f)].sphere >= 0;
    if (is_ball) continue;  // faces of the ball are flat, and probes lie on the sphere
    const Eigen::Vector2d uv = spread(f);
    const auto weights = corner_weights(model, f, uv.x(), uv.y());
    Vector3d at = Vector3d::Zero();
    for (int c = 0; c < model.corner_count(f); ++c) {
      at += weights[c] * model.position[model.faces[f][c]];
    }
    if (!(model.irradiance(model.faces[f][0], 0) > 0.0f)) continue;
    probes.push_back({at, element_center(solved.mesh, model.element[f]).normal});
    read.push_back(reader.irradiance(f, weights)[0]);
  }
  const BandArray E = interpolate_irradiance(lit.caster, lit.solution, probes);
  double sum = 0.0;
  for (std::size_t i = 0; i < read.size(); ++i) {
    const double off = read[i] / E(static_cast<Eigen::Index>(i), 0) - 1.0;
    sum += off * off;
  }
  EXPECT_GT(read.size(), 200u);
  return std::sqrt(sum / static_cast<double>(read.size()));
}

/// The filter has errors only at kinks between elements, of at most an eighth of a texel times the
/// jump of the slope. That jump is the second derivative of the light, at most 7.2 W/m^4, times an
/// element of 0.25 m. With texels of about 0.04 m and light of 1.5 to 8.5 W/m^2 the error is at
/// most 0.6 %. With half the texel size it is half as large at half as many points: the RMS falls
/// by 2^-1.5.
TEST(Lightmap, ReadsWhatProbesReadAndBetterWithMoreTexels) {
  const double coarse = reading_error(furnished(), 256), fine = reading_error(furnished(), 512);
  EXPECT_LT(coarse, 0.006);
  EXPECT_LT(fine, 0.6 * coarse);
}

/// Sum over the texels of one chart of E times the texel's area.
double power(const LightmapLayout& layout, const LightmapAtlas& atlas, std::size_t c,
             const SolvedScene& solved) {
  const LightmapChart& chart = layout.charts[c];
  const ChartRectangle& place = layout.place[c];
  const double texel = chart.size.x() * chart.size.y() / (place.width * place.height);
  double sum = 0.0;
  for (int y = place.y; y < place.y + place.height; ++y) {
    // On a sphere, texels of rows near the poles have less area.
    double area = texel;
    if (chart.sphere >= 0) {
      const double r = std::get<Sphere>(solved.mesh.round_grids[chart.sphere].shape).radius;
      const double theta = (y + 0.5 - place.y) / place.height * std::numbers::pi;
      area = std::sin(theta) * 2.0 * std::numbers::pi * std::numbers::pi * r * r /
             (place.width * place.height);
    }
    for (int x = place.x; x < place.x + place.width; ++x) {
      const Eigen::Index i = static_cast<Eigen::Index>(y) * layout.size + x;
      if (atlas.face[static_cast<std::size_t>(i)] >= 0) sum += area * atlas.irradiance(i, 0);
    }
  }
  return sum;
}

/// Power by the midpoint rule over texels, against the mean of corners over the elements. The mean
/// of corners is exact for parallelograms and triangles; on the ball its error is the square of an
/// element's angle over 24, (0.25 / 0.4)^2 / 24 = 1.6 % of the variation of light.
TEST(Lightmap, TexelsTimesAreaAreThePowerOnAllSurfaces) {
  const SolvedScene solved = solved_of(furnished());
  const BakedModel model = bake_model(solved, furnished().scene);
  const LightmapLayout layout = lay_out_lightmap(model, solved.mesh, {.size = 512});
  const LightmapReader reader(layout, model, solved);
  const BandArray mean = element_mean(solved.mesh, solved.solution.irradiance());
  double texels = 0.0, elements = 0.0;
  for (std::size_t c = 0; c < layout.charts.size(); ++c) {
    texels += power(layout, reader.atlases[0], c, solved);
  }
  for (const int e : model.element) elements += mean(e, 0) * solved.mesh.element_area[e];
  EXPECT_NEAR(texels / elements, 1.0, 0.002);
}

/// Each wall has constant light: every texel of its chart and of the padding has that light, so no
/// light bleeds from other charts or unused texels.
TEST(Lightmap, PaddingHasTheLightOfItsChart) {
  const SolvedScene solved = solved_box();
  const BakedModel model = bake_model(solved, box_scene());
  constexpr int padding = 6;
  const LightmapLayout layout =
      lay_out_lightmap(model, solved.mesh, {.size = 128, .padding = padding});
  ASSERT_EQ(layout.charts.size(), 5u);
  const LightmapReader reader(layout, model, solved);
  for (std::size_t c = 0; c < layout.charts.size(); ++c) {
    const ChartRectangle& place = layout.place[c];
    const auto E = model.irradiance.row(layout.charts[c].vertices.front());
    for (int y = place.y - padding; y < place.y + place.height + padding; ++y) {
      for (int x = place.x - padding; x < place.x + place.width + padding; ++x) {
        const auto i = static_cast<Eigen::Index>(y) * layout.size + x;
        // The mean of equal numbers may differ from them by rounding.
        EXPECT_LT((reader.atlases[0].irradiance.row(i) - E).abs().maxCoeff(), 1e-5f);
      }
    }
  }
  EXPECT_GT(reader.atlases[0].irradiance.minCoeff(), 0.0f);
}

/// A thin partition ends in the middle of a floor. Light rises around the end of the partition from
/// 0 on one side to 1 on the other.
TEST(Lightmap, NothingLeaksThroughAThinWall) {
  const Paint paint{.reflectance = 0.5f};
  TracedScene lit(SceneBuilder()
                      .polygon(paint, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}})
                      .polygon(paint, {{2, 0, 0}, {2, 2, 0}, {2, 2, 1}, {2, 0, 1}})
                      .build(),
                  0.5);
  std::vector<Vector3d> beside(lit.mesh.vertex_count(), Vector3d::Zero());
  for (int e = 0; e < lit.mesh.element_count(); ++e) {
    for (int c = 0; c < lit.mesh.corner_count(e); ++c) {
      beside[lit.mesh.corners[e][c]] += element_center(lit.mesh, e).position - Vector3d(2, 2, 0);
    }
  }
  for (int v = 0; v < lit.mesh.vertex_count(); ++v) {
    Vector3d p = lit.mesh.position(v) - Vector3d(2, 2, 0);
    if (std::abs(p.x()) < 1e-9) p.x() = 1e-9 * beside[v].x();
    const double turn = std::atan2(p.x(), p.y()) / (2.0 * std::numbers::pi);
    lit.solution.direct_irradiance.row(v) = static_cast<float>(0.5 + turn);
  }
  const SolvedScene solved = solved_of(lit);
  const BakedModel model = bake_model(solved, lit.scene);
  const LightmapLayout layout = lay_out_lightmap(model, solved.mesh, {.size = 256});
  const LightmapReader reader(layout, model, solved);
  int beside_wall = 0;
  for (int f = 0; f < model.face_count(); ++f) {
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector2d uv = spread(i);
      const auto weights = corner_weights(model, f, uv.x(), uv.y());
      Vector3d p = Vector3d::Zero();
      float E = 0.0f;
      for (int c = 0; c < model.corner_count(f); ++c) {
        p += weights[c] * model.position[model.faces[f][c]];
        E += static_cast<float>(weights[c]) * model.irradiance(model.faces[f][c], 0);
      }
      // Only points within a texel of the partition, without its end, where light changes quickly.
      if (std::abs(p.z()) > 0.0 || std::abs(p.x() - 2.0) > 1.0 / layout.texels_per_metre ||
          p.y() > 1.5) {
        continue;
      }
      ++beside_wall;
      // The slope of light is at most 1 / (2 pi 0.5 m) here; the error at a kink is half a texel
      // times the slope.
      EXPECT_NEAR(reader.irradiance(f, weights)[0], E, 0.2 / layout.texels_per_metre);
    }
  }
  EXPECT_GT(beside_wall, 20);
}

/// A block stands on a lit floor. The unlit floor below is part of the floor's chart, whose texels
/// there continue the surrounding light, so that the filter finds no dark texel at the block's
/// foot.
TEST(Lightmap, NothingDarkShowsAtABlocksFoot) {
  const Paint paint{.reflectance = 0.5f, .one_sided = true};
  TracedScene lit(SceneBuilder()
                      .polygon(paint, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}})
                      .box(paint, {1, 1, 0}, {2, 2, 1}, false)
                      .build(),
                  0.5);
  for (int e = 0; e < lit.mesh.element_count(); ++e) {
    const PatchPoint at = element_center(lit.mesh, e);
    const bool is_under =
        at.position.z() == 0.0 && (at.position - Vector3d(1.5, 1.5, 0)).cwiseAbs().maxCoeff() < 0.5;
    for (int c = 0; c < lit.mesh.corner_count(e) && !is_under; ++c) {
      lit.solution.direct_irradiance.row(lit.mesh.corners[e][c]) = 2.0f;
    }
  }
  const SolvedScene solved = solved_of(lit);
  const BakedModel model = bake_model(solved, lit.scene);
  const LightmapLayout layout = lay_out_lightmap(model, solved.mesh, {.size = 128});
  const LightmapReader reader(layout, model, solved);
  int under = 0;
  for (int f = 0; f < model.face_count(); ++f) {
    const LightmapChart& chart = layout.charts[reader.chart_of(f)];
    const Vector3d normal = element_center(solved.mesh, model.element[f]).normal;
    if (!chart.is_dark || normal.z() < 0.5) continue;
    ++under;
    EXPECT_GE(chart.host, 0);
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector2d uv = spread(i);
      EXPECT_NEAR(reader.irradiance(f, corner_weights(model, f, uv.x(), uv.y()))[0], 2.0f, 1e-5f);
    }
  }
  EXPECT_GE(under, 4);
}

/// On a ball, texels are interpolated by longitude and latitude; no texel at the seam or the poles
/// is without light.
TEST(Lightmap, ABallIsRolledOffByLongitudeAndLatitude) {
  const SolvedScene solved = solved_of(furnished());
  const BakedModel model = bake_model(solved, furnished().scene);
  const LightmapLayout layout = lay_out_lightmap(model, solved.mesh, {.size = 512});
  const LightmapReader reader(layout, model, solved);
  const auto ball =
      std::ranges::find_if(layout.charts, [](const auto& c) { return c.sphere >= 0; });
  ASSERT_NE(ball, layout.charts.end());
  const ChartRectangle& place =
      layout.place[static_cast<std::size_t>(ball - layout.charts.begin())];
  const auto& sphere = std::get<Sphere>(solved.mesh.round_grids[ball->sphere].shape);
  std::vector<Probe> probes;
  std::vector<float> read;
  for (int y = 0; y < place.height; ++y) {
    const double theta = (y + 0.5) / place.height * std::numbers::pi;
    for (int x = 0; x < place.width; ++x) {
      const double phi = (x + 0.5) / place.width * 2.0 * std::numbers::pi;
      const Vector3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                       std::cos(theta));
      probes.push_back({sphere.center + sphere.radius * n, n});
      read.push_back(reader.atlases[0].irradiance(
          static_cast<Eigen::Index>(place.y + y) * layout.size + place.x + x, 0));
    }
  }
  const BandArray E = interpolate_irradiance(furnished().caster, furnished().solution, probes);
  for (std::size_t i = 0; i < read.size(); ++i) {
    // Hits of single-precision rays are off by 1e-6 m, where light differs by less than the bound.
    EXPECT_NEAR(read[i], E(static_cast<Eigen::Index>(i), 0), 1e-3);
  }
}

/// Without occluders direct light at a texel's centre is that of the closed form, although the
/// floor is one element.
TEST(Lightmap, DirectLightIsTracedAnewAtTexelCentres) {
  const Paint white{.reflectance = 0.5f, .one_sided = true};
  const Paint lamp{.exitance = 100.0f, .one_sided = true};
  TracedScene lit(SceneBuilder()
                      .polygon(white, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}})
                      .polygon(lamp, {{0.9, 0.9, 1}, {0.9, 1.1, 1}, {1.1, 1.1, 1}, {1.1, 0.9, 1}})
                      .build(),
                  2.0);
  lit.set_direct([](const Vector3d&) { return 1.0f; });
  lit.set_indirect([](const Vector3d&) { return 0.25f; });
  const SolvedScene solved = solved_of(lit);
  const BakedModel model = bake_model(solved, lit.scene);
  const LightmapOptions options{.size = 64, .pass = Pass::direct};
  const LightmapLayout layout = lay_out_lightmap(model, solved.mesh, options);
  const LightmapReader reader(layout, model, solved, lit.scene, options);
  int floor_texels = 0;
  for (std::size_t i = 0; i < reader.atlases[0].face.size(); ++i) {
    const int f = reader.atlases[0].face[i];
    if (f < 0 || model.position[model.faces[f][0]].z() > 0.5) continue;
    const LightmapChart& chart = layout.charts[reader.chart_of(f)];
    const ChartRectangle& place = layout.place[reader.chart_of(f)];
    // The floor is a square of 2 m and so is its chart, turned or not; the lamp is in its middle.
    const double x = (static_cast<double>(i % 64) + 0.5 - place.x) / place.width * chart.size.x();
    const double y = (static_cast<double>(i / 64) + 0.5 - place.y) / place.height * chart.size.y();
    const double F = lit.direct_light.unoccluded_form_factor(lit.direct_light.emitters()[0],
                                                             {{x, y, 0}, {0, 0, 1}});
    const double E = 100.0 * F + 0.25;
    // Points keep a thousandth of an element from its edges; F changes by 0.4 % over this distance.
    EXPECT_NEAR(reader.atlases[0].irradiance(static_cast<Eigen::Index>(i), 0), E, 0.005 * E);
    ++floor_texels;
  }
  EXPECT_GT(floor_texels, 1000);
}

/// In a closed room of constant radiosity a final gather has the same value everywhere.
TEST(Lightmap, AGatherInAFurnaceIsTheSameEverywhere) {
  const Paint paint{.reflectance = 0.5f, .exitance = 1.0f, .one_sided = true};
  TracedScene lit(SceneBuilder().box(paint, {0, 0, 0}, {2, 2, 2}, true).build(), 1.0);
  lit.set_indirect([](const Vector3d&) { return 2.0f; });
  const SolvedScene solved = solved_of(lit);
  const BakedModel model = bake_model(solved, lit.scene);
  const LightmapOptions options{.size = 64, .pass = Pass::gather, .gather_rays = 16};
  const LightmapLayout layout = lay_out_lightmap(model, solved.mesh, options);
  const LightmapReader reader(layout, model, solved, lit.scene, options);
  EXPECT_NEAR(reader.atlases[0].irradiance.minCoeff(), 2.0f, 1e-4f);
  EXPECT_NEAR(reader.atlases[0].irradiance.maxCoeff(), 2.0f, 1e-4f);
}

TEST(Lightmap, IsTheSameForAnyNumberOfThreads) {
  const SolvedScene solved = solved_of(furnished());
  const BakedModel model = bake_model(solved, furnished().scene);
  std::vector<BandArray> painted;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    const LightmapLayout layout = lay_out_lightmap(model, solved.mesh, {.size = 128});
    painted.push_back(paint_atlas(layout, 0, model, solved, {}).radiosity);
  }
  EXPECT_TRUE((painted[0] == painted[1]).all());
}

TEST(Lightmap, SaysWhichSizeWouldDo) {
  const SolvedScene solved = solved_of(furnished());
  const BakedModel model = bake_model(solved, furnished().scene);
  const auto refusal = [&](const LightmapOptions& options) {
    return message_of<InputError>([&] { lay_out_lightmap(model, solved.mesh, options); });
  };
  // 13 charts of at least 2 + 2 * 4 texels: nine of ten by ten fit into 32 x 32.
  EXPECT_TRUE(says(refusal({.size = 32}), "take size 64 or more"));
  EXPECT_NO_THROW(lay_out_lightmap(model, solved.mesh, {.size = 64}));
  EXPECT_TRUE(says(refusal({.size = 256, .texels_per_metre = 100}), "4 m long"));
  EXPECT_TRUE(says(refusal({.size = 256, .texels_per_metre = 100}), "at most 62 texels per metre"));
  EXPECT_TRUE(says(refusal({.size = 8}), "take 16 to 8192"));
  EXPECT_TRUE(says(refusal({.texels_per_metre = -1}), "is no density"));
  EXPECT_TRUE(says(refusal({.texels_per_metre = std::nan("")}), "is no density"));
  EXPECT_TRUE(says(refusal({.padding = 0}), "take 1 to 64"));
}

TEST(Lightmap, ADensityAskedForMayTakeSeveralAtlases) {
  const SolvedScene solved = solved_of(furnished());
  const BakedModel model = bake_model(solved, furnished().scene);
  const LightmapLayout layout =
      lay_out_lightmap(model, solved.mesh, {.size = 256, .texels_per_metre = 50});
  EXPECT_GT(layout.atlas_count, 1);
  EXPECT_EQ(layout.texels_per_metre, 50.0);
  const LightmapReader reader(layout, model, solved);
  EXPECT_EQ(static_cast<int>(reader.atlases.size()), layout.atlas_count);
  for (std::size_t c = 0; c < layout.charts.size(); ++c) {
    if (layout.charts[c].is_dark) continue;
    EXPECT_EQ(layout.place[c].width, std::ceil(50.0 * layout.charts[c].size.x() - 1e-6));
  }
}

}  // namespace
}  // namespace lightwell::lightmap_test
