#include "mesh/discontinuity/crease_selection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "mesh/build_patches.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::crease_selection_test {
namespace {

using namespace lightwell::test;
using Eigen::Vector3d;

void scale_scene(Scene& scene, double scale) {
  for (Surface& surface : scene.surfaces) {
    for (Vector3d& v : std::get<PolygonMesh>(surface.shape).vertices) v *= scale;
  }
}

class Boxes : public ::testing::TestWithParam<int> {};

TEST_P(Boxes, KeepTheirAreasAndConformWhateverLinesCrossThem) {
  for (int k = 0; k < 25; ++k) {
    const auto seed = static_cast<std::uint32_t>(25 * GetParam() + k);
    SCOPED_TRACE(seed);
    const Scene scene = boxes_under_a_lamp(seed);
    const MeshOptions coarse{.max_patch_size = 0.3, .discontinuity = true};
    const PatchMesh mesh = build_patches(scene, coarse);
    expect_consistent(mesh);
    EXPECT_EQ(hanging_vertices(mesh), 0);
    const auto facets = scene_facets(scene);
    for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
      const auto& polygons = std::get<PolygonMesh>(scene.surfaces[facets[f].surface].shape);
      const double area = facet_area(polygons, polygons.facets[facets[f].facet]);
      EXPECT_NEAR(side_area(mesh, f, false), area, 1e-9 * area);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, Boxes, ::testing::Range(0, 16));

TEST(CreaseSelection, TheMeshIsTheSameInEveryUnit) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    Scene scene = boxes_under_a_lamp(seed);
    const MeshOptions options{.max_patch_size = 0.2, .discontinuity = true};
    const PatchMesh mesh = build_patches(scene, options);
    for (const double scale : {1e-3, 1e3}) {
      Scene scaled = scene;
      scale_scene(scaled, scale);
      MeshOptions scaled_options = options;
      scaled_options.max_patch_size *= scale;
      const PatchMesh other = build_patches(scaled, scaled_options);
      ASSERT_EQ(other.corners, mesh.corners) << "seed " << seed << ", times " << scale;
      for (int v = 0; v < mesh.vertex_count(); ++v) {
        ASSERT_LT((other.position(v) / scale - mesh.position(v)).norm(), 1e-9);
      }
    }
  }
}

// A lamp with an edge along y at x = 0 above a half plane x < 0, both far wider than the floor: the
// bounds of the penumbra are straight lines x = const.
Scene half_plane_scene() {
  Scene scene = empty_scene();
  const int lamp = add_lamp(scene);
  add_polygon(scene, "floor", {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  add_polygon(scene, "lamp", {{-0.3, -3, 2}, {-0.3, 3, 2}, {0.37, 3, 2}, {0.37, -3, 2}}, {}, lamp);
  add_polygon(scene, "screen", {{-9, -9, 1}, {0, -9, 1}, {0, 9, 1}, {-9, 9, 1}});
  return scene;
}

TEST(CreaseSelection, NoElementStraddlesABoundOfThePenumbraAndItsSidesShareVertices) {
  const PatchMesh mesh =
      build_patches(half_plane_scene(), {.max_patch_size = 0.25, .discontinuity = true});
  for (const double x : {-0.37, 0.3}) {  // the shadows of the lamp's edges: -x_lamp
    std::set<int> left, right;
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (mesh.facet[e] != 0 || mesh.is_back[mesh.patch[e]] != 0) continue;
      const bool is_left = element_center(mesh, e).position.x() < x;
      for (int i = 0; i < mesh.corner_count(e); ++i) {
        const double at = mesh.position(mesh.corners[e][i]).x();
        ASSERT_TRUE(is_left ? at < x + 1e-9 : at > x - 1e-9);
        if (std::abs(at - x) < 1e-9) (is_left ? left : right).insert(mesh.corners[e][i]);
      }
    }
    EXPECT_GE(left.size(), 17u);  // 2 m in pieces of at most 0.125 m
    EXPECT_EQ(left, right);
  }
}

// Form factor from a point to a rectangle parallel to its plane at height c, with one corner above
// the point and the opposite one a and b away; odd in a and b.
double corner_factor(double a, double b, double c) {
  const double u = std::hypot(a, c), v = std::hypot(b, c);
  return (a / u * std::atan(b / u) + b / v * std::atan(a / v)) / (2.0 * std::numbers::pi);
}

// Form factor from a point of the floor to the part of the lamp that is seen past the half plane's
// edge: from x_lamp = -x on.
double lamp_factor(double x, double y) {
  const double low = std::max(-0.3, -x) - x, high = 0.37 - x;
  if (!(low < high)) return 0.0;
  const auto strip = [&](double a) {
    return corner_factor(a, 3 - y, 2) + corner_factor(a, 3 + y, 2);
  };
  return strip(high) - strip(low);
}

struct ProfileError {
  int elements = 0;
  double most = 0.0;
};

// Largest difference between the true form factors and bilinear interpolation from true values at
// the floor's vertices.
ProfileError profile_error(const MeshOptions& options) {
  const PatchMesh mesh = build_patches(half_plane_scene(), options);
  ProfileError error;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (mesh.facet[e] != 0 || mesh.is_back[mesh.patch[e]] != 0) continue;
    ++error.elements;
    std::array<Vector3d, 4> p;
    std::array<double, 4> E{};
    for (int i = 0; i < 4; ++i) {  // a triangle repeats its last corner
      p[i] = mesh.position(mesh.corners[e][i < mesh.corner_count(e) ? i : 2]);
      E[i] = lamp_factor(p[i].x(), p[i].y());
    }
    constexpr int samples = 8;
    for (int i = 0; i <= samples; ++i) {
      for (int j = 0; j <= samples; ++j) {
        const double s = i / double{samples}, t = j / double{samples};
        const auto blend = [&](const auto& of) {
          return (1 - t) * ((1 - s) * of[0] + s * of[1]) + t * ((1 - s) * of[3] + s * of[2]);
        };
        const double x = blend(std::array{p[0].x(), p[1].x(), p[2].x(), p[3].x()});
        const double y = blend(std::array{p[0].y(), p[1].y(), p[2].y(), p[3].y()});
        error.most = std::max(error.most, std::abs(blend(E) - lamp_factor(x, y)));
      }
    }
  }
  return error;
}

TEST(CreaseSelection, PenumbraIsFiveTimesMoreAccurateThanOnAsManyEvenElements) {
  for (const double size : {0.3, 0.2, 0.1}) {
    const ProfileError cut = profile_error({.max_patch_size = size, .discontinuity = true});
    ProfileError even;
    for (double finer = size; even.elements < cut.elements; finer *= 0.97) {
      even = profile_error({.max_patch_size = finer});
    }
    EXPECT_LT(5.0 * cut.most, even.most) << "size " << size;
  }
}

TEST(CreaseSelection, ABudgetLeavesOutTheLeastImportantAndSaysSo) {
  const Scene scene = boxes_under_a_lamp(1);
  const auto elements = [&](double growth, std::vector<std::string>* notes) {
    MeshOptions options{.max_patch_size = 0.1, .discontinuity = true};
    options.discontinuity_growth = growth;
    const PatchMesh mesh = build_patches(scene, options);
    if (notes) *notes = mesh.notes;
    return mesh.element_count();
  };
  const int without = build_patches(scene, {.max_patch_size = 0.1}).element_count();
  std::vector<std::string> notes;
  EXPECT_EQ(elements(0.0, &notes), without);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("least important"), std::string::npos);
  const int some = elements(0.05, &notes);
  EXPECT_EQ(notes.size(), 1u);
  const int all = elements(10.0, &notes);
  EXPECT_TRUE(notes.empty());
  EXPECT_GT(some, without);
  EXPECT_GT(all, some);
}

}  // namespace
}  // namespace lightwell::crease_selection_test
