// Hundreds of dirty variants of small models: whatever a file has, it is meshed.
#include "tests/mesh/dirty_variants.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/build_patches.h"
#include "mesh/cleaning/planar_regions.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::dirty_variants_test {
namespace {

using namespace lightwell::test;

// Length of all edges of all polygons, metres.
double edge_length(const Scene& scene) {
  double length = 0.0;
  for (const Surface& surface : scene.surfaces) {
    const auto& mesh = std::get<PolygonMesh>(surface.shape);
    const auto add = [&](const std::vector<int>& loop) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        length += (mesh.vertices[static_cast<std::size_t>(loop[i])] -
                   mesh.vertices[static_cast<std::size_t>(loop[(i + 1) % loop.size()])])
                      .norm();
      }
    };
    for (const Facet& facet : mesh.facets) {
      add(facet.boundary);
      for (const auto& hole : facet.holes) add(hole);
    }
  }
  return length;
}

double front_area(const PatchMesh& mesh) {
  double area = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) area += mesh.is_back[p] ? 0.0 : mesh.area[p];
  return area;
}

bool has_note(const PatchMesh& mesh, const std::string& words) {
  return std::ranges::any_of(
      mesh.notes, [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

// The elements have the area of the polygons: welding moves corners by 1e-5 of the diagonal at
// most, and points of other polygons into edges by as much.
void expect_meshed(const Scene& scene, double size) {
  PatchMesh mesh;
  ASSERT_NO_THROW(mesh = build_patches(scene, {.max_patch_size = size, .auto_patch_count = 150}));
  EXPECT_TRUE((mesh.element_area > 0.0).all() && mesh.element_area.isFinite().all());
  EXPECT_FALSE(has_note(mesh, "left out")) << mesh.notes.front();
  const double moved = 1e-5 * scene_bounds(scene).diagonal() * edge_length(scene);
  double area = 0.0;
  for (const Surface& surface : scene.surfaces) area += surface_area(surface);
  EXPECT_NEAR(front_area(mesh), area, moved + 1e-9 * area);
}

class DirtyVariants : public testing::TestWithParam<int> {};

TEST_P(DirtyVariants, AreMeshedAtAnySizeWithTheAreaOfTheirPolygons) {
  constexpr std::uint32_t variants = 50;
  const RawModel model = furnished(GetParam());
  for (std::uint32_t k = 0; k < variants; ++k) {
    const std::uint32_t seed = variants * static_cast<std::uint32_t>(GetParam()) + k;
    std::string defects;
    const Scene raw = read_model(dirty_variant(model, seed, &defects));
    SCOPED_TRACE(testing::Message() << "seed " << seed << ": " << defects);
    if (raw.surfaces.empty()) continue;  // all cut off
    const Scene clean = merge_planar_regions(raw);
    const double diagonal = scene_bounds(clean).diagonal();
    for (const double size : {0.0, 0.06 * diagonal}) expect_meshed(clean, size);
    expect_meshed(raw, 0.2 * diagonal);  // programs may mesh without cleaning
  }
}

INSTANTIATE_TEST_SUITE_P(Models, DirtyVariants, testing::Range(0, furnished_models));

// A heap of triangles that all cross has n^3 / 6 places where three meet; the longest lines are
// enough. Without cuts there would be 1600 patches of 0.5 m and 6400 elements.
TEST(DirtyVariants, HeapsKeepTheirLongestContactLines) {
  for (const bool is_flat : {false, true}) {
    Numbers random(1);
    PolygonMesh heap;
    for (int i = 0; i < 100; ++i) {
      const auto number = [&] { return random.between(-1.0, 1.0); };
      const Eigen::Vector3d at(0.1 * number(), 0.1 * number(), is_flat ? 0.0 : 0.1 * number());
      const Eigen::Vector3d tilt(number(), number(), number());
      const Eigen::AngleAxisd turn(3.0 * number(),
                                   is_flat ? Eigen::Vector3d::UnitZ() : tilt.stableNormalized());
      const int first = static_cast<int>(heap.vertices.size());
      for (const auto& [x, y] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {0.0, 1.0}}) {
        heap.vertices.push_back(at + turn * Eigen::Vector3d(x, y, 0.0));
      }
      heap.facets.push_back({.boundary = {first, first + 1, first + 2}});
    }
    Scene scene = empty_scene();
    scene.surfaces.push_back({.name = "heap", .material = 0, .shape = heap});
    const PatchMesh mesh = build_patches(merge_planar_regions(scene), {.max_patch_size = 0.5});
    expect_consistent(mesh);
    EXPECT_TRUE(has_note(mesh, "100 polygons are crossed by too many others"));
    // The smallest welding tolerance suffices: 1e-7 of the diagonal along the edges.
    const double moved = 1e-7 * scene_bounds(scene).diagonal() * edge_length(scene);
    EXPECT_NEAR(front_area(mesh), 100.0 * 2.0, moved);
    EXPECT_LT(mesh.patch_count(), 6400);
    EXPECT_LT(mesh.element_count(), 100'000);
  }
}

}  // namespace
}  // namespace lightwell::dirty_variants_test
