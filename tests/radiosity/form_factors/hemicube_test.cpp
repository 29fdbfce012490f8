#include "radiosity/form_factors/hemicube.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

#include "mesh/build_patches.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/form_factors/hemicube_view.h"
#include "scene/parallel.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::hemicube_test {
namespace {

using BackEnd = HemicubeOptions::BackEnd;
using Eigen::Vector3d;

struct Rows {
  PatchMesh mesh;
  std::vector<EstimatedRow> row;
};

Rows rows_of(const Scene& scene, const MeshOptions& mesh_options, const HemicubeOptions& options) {
  Rows result{.mesh = build_patches(scene, mesh_options)};
  const ElementCaster caster(result.mesh);
  result.row = hemicube_rows(caster, LightPaths(scene, caster, 8), options);
  return result;
}

double sum_of_shares(const EstimatedRow& row) {
  double sum = 0.0;
  for (const FormFactor& f : row.shares) sum += f.value;
  return sum;
}

class Hemicube : public testing::TestWithParam<BackEnd> {};

TEST_P(Hemicube, RowsOfAClosedRoomSumToOne) {
  const Rows rows = rows_of(test::furnace(0.5f, 1.0f, true), {.max_patch_size = 0.2},
                            {.resolution = 64, .back_end = GetParam()});
  for (int i = 0; i < rows.mesh.patch_count(); ++i) {
    const EstimatedRow& row = rows.row[i];
    EXPECT_EQ(row.escaped, 0.0);
    EXPECT_EQ(row.specular, 0.0);
    EXPECT_DOUBLE_EQ(row.inverse_variance, 1.0 / rows.mesh.area[i]);
    // Each entry is rounded to float: in total at most half a float digit of 1.
    EXPECT_NEAR(sum_of_shares(row), 1.0, 6e-8 + 1e-12);
    int before = -1;
    for (const FormFactor& f : row.shares) {
      EXPECT_GT(f.patch, before);
      EXPECT_NE(rows.mesh.facet_of(f.patch), rows.mesh.facet_of(i));
      EXPECT_GT(f.value, 0.0f);
      before = f.patch;
    }
  }
}

TEST_P(Hemicube, OpenRoomLosesWhatTheOpeningSubtends) {
  Scene scene = test::furnace(0.5f, 1.0f, false);
  const auto& open = std::get<PolygonMesh>(scene.surfaces.back().shape);  // z1
  const Loop opening = open.vertices;
  scene.surfaces.pop_back();
  const Rows rows = rows_of(scene, {.max_patch_size = 0.4}, {.back_end = GetParam()});
  for (int i = 0; i < rows.mesh.patch_count(); ++i) {
    const HemicubeEye eye = hemicube_eye(rows.mesh, i, true);
    const double exact = std::abs(point_to_polygon(eye.position, eye.frame.col(2), {&opening, 1}));
    EXPECT_NEAR(rows.row[i].escaped, exact, 2e-3);  // error of 256 cells
    EXPECT_NEAR(sum_of_shares(rows.row[i]) + rows.row[i].escaped, 1.0, 1e-7);
  }
}

// The plate is black from behind, but blocks light from beyond.
TEST_P(Hemicube, BlackBackBlocks) {
  Scene scene = test::furnace(0.5f, 1.0f, false);
  const Loop plate = {
      {0.3, 0.4, 0.5}, {0.7, 0.4, 0.5}, {0.7, 0.8, 0.5}, {0.3, 0.8, 0.5}};  // faces up
  test::add_polygon(scene, "plate", 0, plate);
  const Rows rows = rows_of(scene, {.max_patch_size = 0.3}, {.back_end = GetParam()});
  int below = 0;
  for (int i = 0; i < rows.mesh.patch_count(); ++i) {
    const HemicubeEye eye = hemicube_eye(rows.mesh, i, true);
    if (eye.position.z() > 0.49) continue;
    const double exact = std::abs(point_to_polygon(eye.position, eye.frame.col(2), {&plate, 1}));
    EXPECT_NEAR(rows.row[i].escaped, exact, 2e-3);
    for (const FormFactor& f : rows.row[i].shares) EXPECT_NE(rows.mesh.facet_of(f.patch), 6);
    ++below;
  }
  EXPECT_GT(below, 10);
}

TEST_P(Hemicube, PerfectMirrorPassesEverythingOn) {
  const Scene scene = test::room_with_mirror(1.0f);
  const Rows rows =
      rows_of(scene, {.max_patch_size = 0.25}, {.resolution = 64, .back_end = GetParam()});
  double back = 0.0;
  for (int i = 0; i < rows.mesh.patch_count(); ++i) {
    const EstimatedRow& row = rows.row[i];
    if (rows.mesh.facet_of(i) == 0) {
      EXPECT_EQ(row.inverse_variance, 0.0);  // a mirror has no row of its own
      continue;
    }
    EXPECT_NEAR(sum_of_shares(row) + row.specular, 1.0, 1e-7);
    // All light that meets the mirror arrives. A few hundred float entries.
    EXPECT_NEAR(row.specular_share.col(0).sum(), row.specular, 1e-6);
    if (rows.mesh.facet_of(i) != 1) continue;
    for (std::size_t e = 0; e < row.specular_patch.size(); ++e) {
      if (rows.mesh.facet_of(row.specular_patch[e]) == 1) {
        back += rows.mesh.area[i] * row.specular_share(e, 0);
      }
    }
  }
  // The image of x1 itself: opposed unit squares at distance 2, in closed form. Error of 16 rows of
  // 64 cells (4e-3 each, at random), and of 16 midpoints for the mean over the square.
  EXPECT_NEAR(back, 0.06859, 2e-3);
}

// From any point inside a sphere F_ij = A_j / A, the closed form without occluders. The flat
// elements of scan conversion differ by the share by which they differ from the sphere.
TEST_P(Hemicube, InsideOfASphereSeesEachPatchByItsArea) {
  Scene scene;
  Material paint = test::diffuse(scene.bands, 0.5f, 1.0f);
  paint.one_sided = false;
  const int m = test::add_material(scene, paint);
  scene.surfaces.push_back(
      {.name = "ball", .material = m, .shape = Sphere{.center = {1, 2, 3}, .radius = 2.0}});
  const Rows rows = rows_of(scene, {.max_patch_size = 0.8}, {.back_end = GetParam()});
  const double all = 4.0 * std::numbers::pi * 4.0;
  int inside = 0;
  for (int i = 0; i < rows.mesh.patch_count(); ++i) {
    if (rows.mesh.is_back[i] == 0) {
      EXPECT_NEAR(rows.row[i].escaped, 1.0, 1e-12);  // a sum of some thousand terms
      continue;
    }
    ++inside;
    EXPECT_EQ(rows.row[i].escaped, 0.0);
    for (const FormFactor& f : rows.row[i].shares) {
      EXPECT_EQ(rows.mesh.is_back[f.patch], 1);
      // The patch itself and its neighbours lie near the horizon, where flat elements differ most.
      const HemicubeEye from = hemicube_eye(rows.mesh, i, false);
      const HemicubeEye to = hemicube_eye(rows.mesh, f.patch, false);
      if ((from.position - to.position).norm() < 1.5) continue;
      const double exact = rows.mesh.area[f.patch] / all;
      EXPECT_NEAR(f.value, exact, GetParam() == BackEnd::rays ? 1e-3 : 0.1 * exact + 1e-3);
    }
  }
  EXPECT_GT(inside, 20);
}

INSTANTIATE_TEST_SUITE_P(BackEnds, Hemicube,
                         testing::Values(BackEnd::scan_conversion, BackEnd::rays),
                         [](const auto& tested) {
                           return tested.param == BackEnd::rays ? "Rays" : "ScanConversion";
                         });

void add_blocker(Scene& scene, int material, const nlohmann::json& blocker) {
  const auto vector_of = [](const nlohmann::json& p) { return Vector3d(p[0], p[1], p[2]); };
  if (blocker.contains("box")) {
    const auto& box = blocker["box"];
    test::add_box(scene, vector_of(box[0]), vector_of(box[1]),
                  {material, material, material, material, material, material}, false);
    return;
  }
  std::vector<Vector3d> points;
  for (const auto& p : blocker["polygon"]) points.push_back(vector_of(p));
  test::add_polygon(scene, "blocker", material, points);
}

double least_distance(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vector3d& p : a) {
    for (const Vector3d& q : b) least = std::min(least, (p - q).norm());
  }
  return least;
}

// Polygon to polygon, with and without occluders: the mean over the patches of polygon1. Patches
// are a sixteenth of the polygon, and at most a third of the gap between both polygons. The errors
// of the midpoint rule and of shadow edges across a patch (proximity and visibility: Baum,
// Rushmeier & Winget 1989) then stay within the bound.
TEST(HemicubeRows, PolygonToPolygonIsTheCatalogues) {
  std::ifstream file(LIGHTWELL_TEST_DATA "/analytic/viewfactors.json");
  int cases = 0;
  for (const auto& entry : nlohmann::json::parse(file)) {
    const auto& geometry = entry["geometry"];
    const bool occluded = geometry["type"] == "occluded-polygon-polygon";
    if (geometry["type"] != "polygon-polygon" && !occluded) continue;
    ++cases;
    Scene scene;
    const int m = test::add_material(scene, test::diffuse(scene.bands, 0.5f, 1.0f));
    std::array<std::vector<Vector3d>, 2> points;
    for (int k = 0; k < 2; ++k) {
      const std::string name = "polygon" + std::to_string(k + 1);
      for (const auto& p : geometry[name]) points[k].emplace_back(p[0], p[1], p[2]);
      test::add_polygon(scene, name, m, points[k]);
    }
    double perimeter = (points[0].front() - points[0].back()).norm();
    for (std::size_t k = 1; k < points[0].size(); ++k) {
      perimeter += (points[0][k] - points[0][k - 1]).norm();
    }
    const double gap = least_distance(points[0], points[1]);
    double size = perimeter / 64.0;
    if (gap > 0.0) size = std::min(size, gap / 3.0);
    if (occluded) {
      for (const auto& blocker : geometry["blockers"]) add_blocker(scene, m, blocker);
    }
    const Rows rows = rows_of(scene, {.max_patch_size = size, .elements_per_patch_edge = 1}, {});
    double F = 0.0, area = 0.0;
    for (int i = 0; i < rows.mesh.patch_count(); ++i) {
      if (rows.mesh.facet_of(i) != 0) continue;
      area += rows.mesh.area[i];
      for (const FormFactor& f : rows.row[i].shares) {
        if (rows.mesh.facet_of(f.patch) == 1) F += rows.mesh.area[i] * f.value;
      }
    }
    EXPECT_NEAR(F / area, entry["value"].get<double>(), 2e-3) << entry["id"];
  }
  EXPECT_GE(cases, 20);
}

// The error of one polygon's share over many turns falls at least in proportion to the cell size.
TEST(HemicubeRows, AliasingFallsWithTheResolution) {
  Scene scene;
  const int m = test::add_material(scene, test::diffuse(scene.bands, 0.5f, 1.0f));
  test::add_polygon(scene, "floor", m, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const Loop lamp = {{0.1, 0.2, 0.8}, {0.3, 0.9, 1.0}, {0.9, 0.5, 1.1}};
  test::add_polygon(scene, "lamp", m, lamp);
  std::vector<double> rms;
  for (const int n : {32, 64, 128, 256}) {
    const Rows rows =
        rows_of(scene, {.max_patch_size = 0.15, .elements_per_patch_edge = 1}, {.resolution = n});
    double squares = 0.0;
    int count = 0;
    for (int i = 0; i < rows.mesh.patch_count(); ++i) {
      if (rows.mesh.facet_of(i) != 0) continue;
      const HemicubeEye eye = hemicube_eye(rows.mesh, i, true);
      const double exact = std::abs(point_to_polygon(eye.position, eye.frame.col(2), {&lamp, 1}));
      squares += std::pow(1.0 - rows.row[i].escaped - exact, 2);
      ++count;
    }
    rms.push_back(std::sqrt(squares / count));
  }
  for (std::size_t k = 1; k < rms.size(); ++k) EXPECT_LT(rms[k], rms[k - 1]);
  EXPECT_LT(rms.back(), rms.front() / 8.0);
  EXPECT_GT(rms.back(), 0.0);
}

TEST(HemicubeRows, SameBitsForAnyNumberOfThreads) {
  const Scene scene = test::furnace(0.5f, 1.0f, true);
  const MeshOptions mesh{.max_patch_size = 0.3};
  const Rows many = rows_of(scene, mesh, {.resolution = 32});
  const ThreadLimit one(1);
  const Rows single = rows_of(scene, mesh, {.resolution = 32});
  ASSERT_EQ(many.row.size(), single.row.size());
  for (std::size_t i = 0; i < many.row.size(); ++i) {
    ASSERT_EQ(many.row[i].shares.size(), single.row[i].shares.size());
    for (std::size_t k = 0; k < many.row[i].shares.size(); ++k) {
      ASSERT_EQ(many.row[i].shares[k].patch, single.row[i].shares[k].patch);
      ASSERT_EQ(many.row[i].shares[k].value, single.row[i].shares[k].value);
    }
  }
}

// Hemicubes of two patches of one wall have the same normal, but different turns.
TEST(HemicubeRows, EachPatchTurnsItsHemicube) {
  const PatchMesh mesh = build_patches(test::furnace(0.5f, 1.0f, false), {.max_patch_size = 0.5});
  const HemicubeEye first = hemicube_eye(mesh, 0, true), second = hemicube_eye(mesh, 1, true);
  ASSERT_EQ(mesh.facet_of(0), mesh.facet_of(1));
  EXPECT_EQ(first.frame.col(2), second.frame.col(2));
  EXPECT_GT((first.frame.col(0) - second.frame.col(0)).norm(), 1e-3);
  EXPECT_EQ(first.frame, hemicube_eye(mesh, 0, true).frame);
  EXPECT_NEAR((first.frame.transpose() * first.frame - Eigen::Matrix3d::Identity()).norm(), 0.0,
              1e-14);
}

TEST(HemicubeRows, ReportsProgressAndStopsWhenAsked) {
  const Scene scene = test::furnace(0.5f, 1.0f, false);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  const ElementCaster caster(mesh);
  const LightPaths paths(scene, caster, 8);
  double last = -1.0;
  hemicube_rows(caster, paths, {.resolution = 32}, [&](std::string_view phase, double share) {
    EXPECT_EQ(phase, "form factors");
    EXPECT_GT(share, last);
    last = share;
    return true;
  });
  EXPECT_EQ(last, 1.0);
  EXPECT_THROW(hemicube_rows(caster, paths, {.resolution = 32}, [](auto, double) { return false; }),
               Interrupted);
  EXPECT_THROW(hemicube_rows(caster, paths, {.resolution = 33}), std::invalid_argument);
}

}  // namespace
}  // namespace lightwell::hemicube_test
