#include "raytrace/readings/lux_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "radiosity/closed_forms/polygon_form_factor.h"
#include "scene/errors.h"
#include "tests/raytrace/lit_scene.h"
#include "tests/temporary_folder.h"

namespace lightwell::lux_grid_test {
namespace {

const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();

PolygonMesh& shape_of(Scene& scene, std::size_t surface) {
  return std::get<PolygonMesh>(scene.surfaces[surface].shape);
}

/// A floor of 4 m x 5 m with the longest edge along y.
Scene floor_of_an_office() {
  return SceneBuilder().polygon({}, {{0, 0, 0}, {4, 0, 0}, {4, 5, 0}, {0, 5, 0}}).build();
}

/// Spacings of EN 12464-1; its table 1 rounds them to 0.2 m over 1 m, 0.6 m over 5 m, 1 m over 10
/// m, 5 m over 100 m.
TEST(LuxGrid, HasTheSpacingOfTheStandard) {
  EXPECT_NEAR(greatest_grid_spacing(1.0), 0.2, 1e-12);
  EXPECT_NEAR(greatest_grid_spacing(5.0), 0.6, 0.02);
  EXPECT_NEAR(greatest_grid_spacing(10.0), 1.0, 1e-12);
  EXPECT_NEAR(greatest_grid_spacing(100.0), 5.0, 1e-12);
  EXPECT_EQ(greatest_grid_spacing(1e6), 10.0);
}

/// A margin of 0.5 m leaves 3 m x 4 m, with 6 x 8 cells at p(4 m) = 0.53 m.
TEST(LuxGrid, CoversTheSurfaceLessItsMargin) {
  const LuxGrid grid = lux_grid(floor_of_an_office(), 0, up, {.height = 0.75, .margin = 0.5});
  EXPECT_EQ(grid.columns, 8);
  EXPECT_EQ(grid.rows, 6);
  EXPECT_EQ(grid.points.size(), 48u);
  EXPECT_NEAR(std::abs(grid.u.y()), 1.0, 1e-12);
  EXPECT_NEAR(grid.step_u, 0.5, 1e-12);
  for (const Probe& probe : grid.points) {
    EXPECT_NEAR(probe.position.z(), 0.75, 1e-12);
    EXPECT_GT(probe.position.x(), 0.5 + 0.2);
    EXPECT_LT(probe.position.y(), 4.5 - 0.2);
    EXPECT_EQ(probe.normal, up);
  }
}

/// An L of two facets, whose common edge is not part of the outline. The missing quarter of the
/// square of 16 cells has no points; a margin also removes the strip around the inner corner.
TEST(LuxGrid, KeepsToTheOutline) {
  Scene scene = SceneBuilder().polygon({}, {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}}).build();
  PolygonMesh& mesh = shape_of(scene, 0);
  mesh.vertices.insert(mesh.vertices.end(), {{2, 2, 0}, {2, 4, 0}, {0, 4, 0}});
  mesh.facets[0].boundary = {0, 1, 2, 4, 3};
  mesh.facets.push_back({.boundary = {3, 4, 5, 6}});
  EXPECT_EQ(lux_grid(scene, 0, up, {.spacing = 1.0}).points.size(), 12u);
  const LuxGrid within = lux_grid(scene, 0, up, {.margin = 0.25, .spacing = 0.5});
  for (const Probe& probe : within.points) {
    const Eigen::Vector3d& p = probe.position;
    EXPECT_TRUE(p.x() < 1.75 || p.y() < 1.75) << p.transpose();
  }
  EXPECT_EQ(within.columns, 7);
}

/// Top and bottom of a block have the same area; the grid lies on the top.
TEST(LuxGrid, OfABlockItIsOnTop) {
  const Scene scene = SceneBuilder().box({}, {0, 0, 0}, {2, 1, 0.7}, false).build();
  const LuxGrid grid = lux_grid(scene, 0, up);
  EXPECT_EQ(grid.points.front().normal, up);
  EXPECT_NEAR(grid.points.front().position.z(), 0.7, 1e-12);
}

TEST(LuxGrid, SaysWhatItCannotDo) {
  const Scene scene = SceneBuilder()
                          .polygon({}, {{0, 0, 0}, {4, 0, 0}, {4, 5, 0}, {0, 5, 0}})
                          .sphere({}, {0, 0, 3}, 1.0)
                          .build();
  const auto refused = [&](int surface, const LuxGridOptions& options) {
    return message_of<InputError>([&] { lux_grid(scene, surface, up, options); });
  };
  EXPECT_TRUE(says(refused(0, {.margin = 2.0}), "nothing is left of surface 'surface 0'"));
  EXPECT_TRUE(says(refused(0, {.spacing = 1e-4}), "too fine"));
  EXPECT_TRUE(says(refused(1, {}), "is round"));
}

/// A chest of 0.8 m reaches through the plane at 0.75 m.
TEST(LuxGrid, LeavesOutWhatIsInsideOfBodies) {
  const TracedScene lit(SceneBuilder()
                            .box({}, {0, 0, 0}, {4, 4, 3}, true)
                            .box({}, {1, 1, 0}, {2, 2, 0.8}, false)
                            .build());
  const Scene& scene = lit.scene;
  const LuxGrid grid = lux_grid(scene, 0, up, {.height = 0.75, .spacing = 0.5});
  const LuxGrid open = without_buried_points(lit.caster, grid);
  EXPECT_EQ(grid.points.size(), 64u);
  EXPECT_EQ(open.points.size(), 60u);
  EXPECT_EQ(open.cell.size(), 60u);
  for (const Probe& probe : open.points) {
    EXPECT_FALSE((probe.position.head<2>().array() > 1.0).all() &&
                 (probe.position.head<2>().array() < 2.0).all());
  }
  const LuxGrid above = lux_grid(scene, 0, up, {.height = 1.0, .spacing = 0.5});
  EXPECT_EQ(without_buried_points(lit.caster, above).points.size(), 64u);
}

/// A chest without a bottom stands on the floor that is measured.
TEST(LuxGrid, LeavesOutWhatABodyStandsOn) {
  const TracedScene lit(SceneBuilder()
                            .box({}, {0, 0, 0}, {4, 4, 3}, true)
                            .polygon({}, {{1, 1, 0.8}, {2, 1, 0.8}, {2, 2, 0.8}, {1, 2, 0.8}})
                            .polygon({}, {{1, 1, 0}, {2, 1, 0}, {2, 1, 0.8}, {1, 1, 0.8}})
                            .polygon({}, {{2, 1, 0}, {2, 2, 0}, {2, 2, 0.8}, {2, 1, 0.8}})
                            .polygon({}, {{2, 2, 0}, {1, 2, 0}, {1, 2, 0.8}, {2, 2, 0.8}})
                            .polygon({}, {{1, 2, 0}, {1, 1, 0}, {1, 1, 0.8}, {1, 2, 0.8}})
                            .build());
  const LuxGrid grid = lux_grid(lit.scene, 0, up, {.spacing = 0.5});
  ASSERT_EQ(grid.points.size(), 64u);
  EXPECT_EQ(without_buried_points(lit.caster, grid).points.size(), 60u);
}

/// Walls of any order of corners: v is up, u is level, and u, v and the normal are right-handed.
TEST(LuxGrid, OfAWallStandsUpright) {
  for (const bool is_high : {false, true}) {
    const double x = is_high ? 1.0 : 4.0, z = is_high ? 4.0 : 1.0;
    const Scene scene = SceneBuilder()
                            .polygon({}, {{0, 0, 0}, {x, 0, 0}, {x, 0, z}, {0, 0, z}})
                            .polygon({}, {{0, 5, z}, {x, 5, z}, {x, 5, 0}, {0, 5, 0}})
                            .build();
    for (int surface = 0; surface < 2; ++surface) {
      const LuxGrid grid = lux_grid(scene, surface, up, {.spacing = 0.5});
      // Differences and quotients of a few doubles of 5.
      constexpr double rounding = 1e-14;
      EXPECT_NEAR(grid.v.dot(up), 1.0, rounding);
      EXPECT_NEAR(grid.u.dot(up), 0.0, rounding);
      EXPECT_NEAR(grid.u.cross(grid.v).dot(grid.points[0].normal), 1.0, rounding);
      EXPECT_EQ(grid.columns, is_high ? 2 : 8);
    }
  }
}

/// Points every metre, of which two lie on the sides of a chest, one to its left and one to its
/// right, and one inside.
TEST(LuxGrid, LeavesOutWhatIsOnTheFacesOfBodies) {
  const TracedScene lit(SceneBuilder()
                            .box({}, {0, 0, 0}, {5, 5, 3}, true)
                            .box({}, {1.5, 1.2, 0}, {3.5, 1.8, 0.8}, false)
                            .build());
  const LuxGrid grid = lux_grid(lit.scene, 0, up, {.height = 0.75, .spacing = 1.0});
  ASSERT_EQ(grid.points.size(), 25u);
  const LuxGrid open = without_buried_points(lit.caster, grid);
  EXPECT_EQ(open.points.size(), 22u);
  for (const Probe& probe : open.points) {
    EXPECT_FALSE(probe.position.y() == 1.5 && probe.position.x() > 1.0 && probe.position.x() < 4.0)
        << probe.position.transpose();
  }
}

/// A part of 2 m x 1 m of the floor has the spacing p(2 m) = 0.32 m: 7 cells by 4. The box's height
/// does not matter.
TEST(LuxGrid, CoversThePartThatIsAskedFor) {
  const Eigen::AlignedBox3d part(Eigen::Vector3d(1, 2, 0), Eigen::Vector3d(2, 4, 0.7));
  const LuxGrid grid = lux_grid(floor_of_an_office(), 0, up, {.height = 0.75, .part = part});
  EXPECT_EQ(grid.columns, 7);
  EXPECT_EQ(grid.rows, 4);
  EXPECT_NEAR(grid.area, 2.0, 1e-12);
  for (const Probe& probe : grid.points) {
    EXPECT_TRUE(part.contains(Eigen::Vector3d(probe.position.x(), probe.position.y(), 0.1)));
    EXPECT_NEAR(probe.position.z(), 0.75, 1e-12);
  }
  const Eigen::AlignedBox3d beside(Eigen::Vector3d(5, 0, 0), Eigen::Vector3d(6, 1, 0));
  EXPECT_THROW(lux_grid(floor_of_an_office(), 0, up, {.part = beside}), InputError);
}

/// The cells, of 20 of 1 m, with their middles over the part of 2 m x 2 m are left out.
TEST(LuxGrid, LeavesOutThePointsOverAnotherGrid) {
  const Scene scene = floor_of_an_office();
  const Eigen::AlignedBox3d part(Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(3, 3, 0));
  const LuxGrid task = lux_grid(scene, 0, up, {.height = 0.75, .spacing = 0.5, .part = part});
  const LuxGrid around = without_points_over(task, lux_grid(scene, 0, up, {.spacing = 1.0}));
  EXPECT_EQ(around.points.size(), 16u);
  EXPECT_EQ(around.cell.size(), 16u);
  for (const Probe& probe : around.points) EXPECT_FALSE(part.contains(probe.position));
}

/// An L of 12 cells of 1 m x 1 m on the floor, given 0.3 m above it, with a hole of one of them.
/// Cells of 0.5 m have four points each.
TEST(LuxGrid, KeepsToAnOutlineWithAHole) {
  const std::vector<std::vector<Eigen::Vector3d>> outline = {
      {{0, 0, 0.3}, {4, 0, 0.3}, {4, 2, 0.3}, {2, 2, 0.3}, {2, 4, 0.3}, {0, 4, 0.3}},
      {{1, 1, 0.3}, {2, 1, 0.3}, {2, 2, 0.3}, {1, 2, 0.3}}};
  const Scene scene = floor_of_an_office();
  const LuxGrid grid = lux_grid(scene, 0, up, {.height = 0.75, .spacing = 0.5, .outline = outline});
  EXPECT_EQ(grid.points.size(), 4u * 11u);
  // Rounding of some 100 sums and products up to 16: 100 * 16 * 2^-53 = 2e-13 m^2.
  EXPECT_NEAR(grid.area, 11.0, 1e-12);
  for (const Probe& probe : grid.points) {
    const Eigen::Vector3d& p = probe.position;
    EXPECT_TRUE(p.x() < 2.0 || p.y() < 2.0) << p.transpose();
    EXPECT_FALSE(p.x() > 1.0 && p.x() < 2.0 && p.y() > 1.0 && p.y() < 2.0) << p.transpose();
    EXPECT_NEAR(p.z(), 0.75, 4 * 0x1p-53);  // products and sums below 1
  }
  // Around it, 9 of the floor's 20 cells of 1 m.
  const LuxGrid around = without_points_over(grid, lux_grid(scene, 0, up, {.spacing = 1.0}));
  EXPECT_EQ(around.points.size(), 9u);
  // A margin also keeps off the hole.
  const LuxGrid within =
      lux_grid(scene, 0, up, {.margin = 0.25, .spacing = 0.1, .outline = outline});
  for (const Probe& probe : within.points) {
    const Eigen::Vector2d middle(1.5, 1.5);
    const Eigen::Vector2d from =
        ((probe.position.head<2>() - middle).cwiseAbs().array() - 0.5).max(0.0);
    EXPECT_GT(from.norm(), 0.25 * (1.0 - 1e-8)) << probe.position.transpose();
  }
}

/// A cupboard stands 1 cm before a wall, and hides its own width and height from the eyes before
/// it.
TEST(LuxGrid, LeavesOutWhatFurnitureHides) {
  const TracedScene lit(SceneBuilder()
                            .polygon({}, {{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}})
                            .box({}, {1, 0.01, 0}, {2, 0.5, 2}, false)
                            .polygon({}, {{0, 3, 0}, {4, 3, 0}, {4, 4, 0}, {0, 4, 0}})
                            .build());
  const LuxGrid eyes = lux_grid(lit.scene, 2, up, {.height = 1.2});
  const LuxGrid wall =
      lux_grid(lit.scene, 0, up, {.spacing = 0.5, .towards = Eigen::Vector3d(2, 3, 1)});
  ASSERT_EQ(wall.points.size(), 48u);
  const LuxGrid seen = points_seen_from(lit.caster, eyes, wall);
  // 2 of 8 columns, 4 of 6 rows; from 2.5 m away at a height of 1.2 m, the gap shows nothing.
  EXPECT_EQ(seen.points.size(), 40u);
  for (const Probe& probe : seen.points) {
    const Eigen::Vector3d& p = probe.position;
    EXPECT_FALSE(p.x() > 1 && p.x() < 2 && p.z() < 2) << p.transpose();
  }
}

/// A ceiling whose polygon faces upwards is measured from the room below.
TEST(LuxGrid, FacesThePointThatItIsToldTo) {
  const LuxGrid grid =
      lux_grid(floor_of_an_office(), 0, up, {.towards = Eigen::Vector3d(2, 2, -1)});
  EXPECT_EQ(grid.points.front().normal, -up);
  EXPECT_NEAR(grid.u.cross(grid.v).dot(-up), 1.0, 1e-12);
}

/// A panel of constant exitance M over a black floor: E = M F in closed form at every point. Direct
/// light without occluders needs no shadow rays and has no noise.
TEST(LuxGrid, MeasuresAPanelOverAFloorAsTheFormulaHasIt) {
  const Paint panel{.exitance = 10.0f, .one_sided = true};
  const TracedScene lit(SceneBuilder()
                            .polygon({}, {{0, 0, 0}, {4, 0, 0}, {4, 5, 0}, {0, 5, 0}})
                            .polygon(panel, {{1, 1, 2.5}, {1, 2, 2.5}, {2, 2, 2.5}, {2, 1, 2.5}})
                            .build());
  const LuxGrid grid = lux_grid(lit.scene, 0, up, {.height = 0.75, .margin = 0.5});
  constexpr double maintenance = 0.8;
  const LuxField field = measure_grid(lit.scene, lit.caster, lit.direct_light, lit.solution, grid,
                                      maintenance, {.rays = 64});
  const Loop loop = {{1, 1, 2.5}, {1, 2, 2.5}, {2, 2, 2.5}, {2, 1, 2.5}};
  const double full = luminous(lit.scene.bands, constant_spectrum(lit.scene.bands, 10.0f));
  double sum = 0.0, least = 1e30, greatest = 0.0;
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const double E = maintenance * full * point_to_polygon(grid.points[i].position, up, Loop(loop));
    EXPECT_NEAR(field.lux[static_cast<Eigen::Index>(i)], E, 1e-5 * E);
    sum += E;
    least = std::min(least, E);
    greatest = std::max(greatest, E);
  }
  const double mean = sum / static_cast<double>(grid.points.size());
  EXPECT_NEAR(field.mean, mean, 1e-5 * mean);
  EXPECT_NEAR(field.least, least, 1e-5 * least);
  EXPECT_NEAR(field.greatest, greatest, 1e-5 * greatest);
  EXPECT_NEAR(field.uniformity, least / mean, 1e-4);
  EXPECT_LT(field.point_within, 1e-4) << "nothing here is left to chance";
}

/// Reflected light is gathered by rays, with an estimated error. The mean square error over 1000
/// points is known to 5 %, and agrees with the error against a gather of many more rays.
TEST(LuxGrid, TellsHowSureItIs) {
  TracedScene lit(SceneBuilder()
                      .box({.reflectance = 0.5f, .one_sided = true}, {0, 0, 0}, {4, 5, 3}, true)
                      .build());
  lit.set_indirect([](const Eigen::Vector3d& p) { return static_cast<float>(p.x() + p.z()); });
  const LuxGrid grid = lux_grid(lit.scene, 0, up, {.height = 0.75, .margin = 0.5, .spacing = 0.1});
  ASSERT_GT(grid.points.size(), 1000u);
  const auto measured = [&](int rays) {
    return measure_grid(lit.scene, lit.caster, lit.direct_light, lit.solution, grid, 1.0,
                        {.rays = rays});
  };
  const LuxField few = measured(32), many = measured(2048);
  const double found = std::sqrt(((few.lux - many.lux) / many.lux).square().mean());
  EXPECT_GT(few.point_within, 0.7 * 2.0 * found);
  EXPECT_LT(few.point_within, 1.4 * 2.0 * found);
  EXPECT_NEAR(few.mean, many.mean, 2.0 * few.mean_within * few.mean);
}

}  // namespace
}  // namespace lightwell::lux_grid_test
