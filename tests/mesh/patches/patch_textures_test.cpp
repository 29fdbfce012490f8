#include "mesh/patches/patch_textures.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/build_patches.h"
#include "mesh/cleaning/planar_regions.h"
#include "mesh/elements/element_caster.h"
#include "mesh/elements/refine_elements.h"
#include "mesh/patches/patch_sampler.h"
#include "mesh/patches/texture_cells.h"
#include "scene/facet_textures.h"
#include "scene/parallel.h"
#include "tests/pictures.h"

namespace lightwell::patch_textures_test {
namespace {

using Eigen::Vector3d;

// A plate of 4 m x 1 m in the plane z = 0, u along x.
Scene plate() {
  Scene scene;
  scene.materials.push_back({.name = "plate",
                             .reflectance = Spectrum::Constant(3, 0.5f),
                             .specular = Spectrum::Zero(3),
                             .emission = Spectrum::Zero(3)});
  PolygonMesh mesh{.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}},
                   .facets = {{.boundary = {0, 1, 2, 3}}}};
  scene.surfaces.push_back({.name = "plate", .material = 0, .shape = std::move(mesh)});
  return scene;
}

// Rounding of 16-bit texels, and of float sums.
constexpr double rounding = 2e-5;

TEST(PatchTextures, APatchReflectsTheMeanOfWhatLiesOnIt) {
  Scene scene = plate();
  put_picture(scene, 0, picture_of(4, 1, {0.1f, 0.9f, 0.3f, 0.5f}));
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.5});
  ASSERT_EQ(mesh.patch_count(), 32) << "16 on either side";
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const double x = element_center(mesh, mesh.first_element[p]).position.x();
    const double share = std::array{0.1, 0.9, 0.3, 0.5}[static_cast<std::size_t>(x)];
    EXPECT_NEAR(mesh.reflectance(p, 1), share, rounding) << x;
    EXPECT_NEAR(mesh.area[p], 0.25, 1e-12);
  }
}

TEST(PatchTextures, APatchOverManyTexelsReflectsTheirMean) {
  Scene scene = plate();
  std::vector<float> shares;
  double sum = 0.0;
  for (int i = 0; i < 64 * 16; ++i) {
    shares.push_back(static_cast<float>((i * 37) % 101) / 101.0f);
    sum += shares.back();
  }
  put_picture(scene, 0, picture_of(64, 16, shares));
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 10.0});
  ASSERT_EQ(mesh.patch_count(), 2);
  // An element has 8 x 8 texels and a point on each, as 16 x 16 points fall.
  EXPECT_NEAR(mesh.reflectance(0, 0), sum / (64 * 16), 0.01 * sum / (64 * 16));
  EXPECT_NEAR(mesh.reflectance(1, 0), mesh.reflectance(0, 0), rounding);
}

TEST(PatchTextures, ABlackBackStaysBlack) {
  Scene scene = plate();
  scene.materials[0].one_sided = true;
  scene.materials[0].emission.setOnes();
  scene.materials[0].emits_both_sides = true;
  put_picture(scene, 0, picture_of(2, 1, {0.2f, 0.8f}));
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 10.0});
  ASSERT_EQ(mesh.patch_count(), 2);
  EXPECT_NEAR(mesh.reflectance(0, 0), 0.5, rounding);
  EXPECT_EQ(mesh.reflectance(1, 0), 0.0f);
}

// A needle of 3 m x 0.1 m whose picture brightens evenly along the needle.
Scene needle(int apex) {
  Scene scene = plate();
  std::vector<float> shares;
  constexpr int texels = 256;
  for (int i = 0; i < texels; ++i) shares.push_back((static_cast<float>(i) + 0.5f) / texels);
  SurfaceTexture ramp = picture_of(texels, 1, shares);
  ramp.is_smooth = true;
  ramp.wrap = {TextureWrap::clamp, TextureWrap::clamp};
  put_picture(scene, 0, ramp);
  auto& mesh = std::get<PolygonMesh>(scene.surfaces[0].shape);
  mesh.vertices = {{0.5, 0, 0}, {3.5, 0.1, 0}, {0.5, 0.1, 0}};
  std::rotate(mesh.vertices.begin(), mesh.vertices.begin() + apex, mesh.vertices.end());
  mesh.facets[0].boundary = {0, 1, 2};
  return scene;
}

TEST(PatchTextures, ANeedleReflectsItsMeanWhateverCornerIsFirst) {
  for (const int apex : {0, 1, 2}) {
    const PatchMesh mesh =
        build_patches(needle(apex), {.max_patch_size = 10.0, .elements_per_patch_edge = 1});
    ASSERT_EQ(mesh.element_count(), 2) << "one on either side";
    // The mean of a linear function is its value at the centroid, x = 1.5 m of 4 m. Along n = 16
    // cells of a triangle, whose width falls evenly, the midpoint rule is off by 1 / (6 n^2) of the
    // function's range, which is 3 m of 4 m.
    constexpr double midpoints = 0.75 / (6.0 * 16 * 16);
    EXPECT_NEAR(mesh.reflectance(0, 0), 1.5 / 4.0, midpoints + rounding) << apex;
  }
}

TEST(PatchTextures, ANeedleHasFewCellsAcross) {
  for (const int apex : {0, 1, 2}) {
    const PatchMesh mesh =
        build_patches(needle(apex), {.max_patch_size = 10.0, .elements_per_patch_edge = 1});
    const CellGrid grid = cells_over(*mesh.textures, 0, corners_of(mesh, 0));
    EXPECT_EQ(grid.along, 4) << "the short edge crosses one texel";
    EXPECT_EQ(grid.across, most_texture_points) << "the long edges cross 192 texels";
  }
}

TEST(PatchTextures, BothSidesOfAnElementAreAlike) {
  Scene scene = plate();
  std::vector<float> shares;
  for (int i = 0; i < 64 * 16; ++i) shares.push_back(static_cast<float>((i * 37) % 101) / 101.0f);
  put_picture(scene, 0, picture_of(64, 16, shares));
  put_mask(scene, 0, picture_of(3, 2, {1.0f, 0.0f, 1.0f, 0.0f, 0.7f, 0.6f}));
  scene.surfaces[0].shape = std::get<PolygonMesh>(needle(0).surfaces[0].shape);
  lay_uv(scene.surfaces[0]);
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  ASSERT_TRUE((mesh.element_area != mesh.element_area[0]).any()) << "holes are cut";
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int twin = mesh.twin[static_cast<std::size_t>(e)];
    ASSERT_GE(twin, 0);
    EXPECT_EQ(mesh.element_area[e], mesh.element_area[twin]);
    EXPECT_TRUE(
        (mesh.reflectance.row(mesh.patch[e]) == mesh.reflectance.row(mesh.patch[twin])).all());
    EXPECT_EQ(mesh.area[mesh.patch[e]], mesh.area[mesh.patch[twin]]);
  }
}

TEST(PatchTextures, HolesTakeTheirAreaFromElementsAndPatches) {
  Scene scene = plate();
  put_mask(scene, 0, picture_of(4, 1, {1.0f, 0.0f, 1.0f, 1.0f}));
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
  double area = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (mesh.is_back[p]) continue;
    const double x = element_center(mesh, mesh.first_element[p]).position.x();
    const bool is_hole = x > 1.0 && x < 2.0;
    EXPECT_NEAR(mesh.area[p], is_hole ? 1e-3 : 1.0, 1e-12);
    area += mesh.area[p];
  }
  EXPECT_NEAR(area, 3.001, 1e-12);
  RefinedElements refined(mesh);
  EXPECT_EQ(refined.mesh().mesh.textures, mesh.textures);
}

TEST(PatchTextures, PointsOfAPatchLieBesideItsHoles) {
  Scene scene = plate();
  put_mask(scene, 0, picture_of(4, 1, {1.0f, 0.0f, 1.0f, 0.0f}));
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 10.0});
  const PatchSampler sampler(mesh, 0);
  int left = 0;
  constexpr int grid = 64;
  for (int i = 0; i < grid * grid; ++i) {
    const Vector3d at =
        sampler.position((i % grid + 0.5) / grid, (i / grid + 0.5) / grid);  // NOLINT
    EXPECT_FALSE(mesh.textures->is_hole(0, at)) << at.transpose();
    left += at.x() < 2.0 ? 1 : 0;
  }
  // Half of the points were drawn anew at random: 3 standard deviations of a binomial count.
  EXPECT_NEAR(left, grid * grid / 2, 3.0 * std::sqrt(grid * grid / 8.0));
}

TEST(PatchTextures, RaysGoThroughHolesAndMeetTheRest) {
  Scene scene = plate();
  put_mask(scene, 0, picture_of(4, 1, {1.0f, 0.0f, 1.0f, 0.0f}));
  PolygonMesh floor{.vertices = {{0, 0, -1}, {4, 0, -1}, {4, 1, -1}, {0, 1, -1}},
                    .facets = {{.boundary = {0, 1, 2, 3}}}};
  scene.surfaces.push_back({.name = "floor", .material = 0, .shape = std::move(floor)});
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 0.3});
  const ElementCaster caster(mesh);
  std::vector<Ray> rays;
  for (int i = 0; i < 64; ++i) {
    for (const double z : {2.0, -0.5}) {
      const double up = z > 0.0 ? -1.0 : 1.0;
      rays.push_back({.origin = {(i + 0.5) / 16, 0.37, z}, .direction = {0, 0, up}, .t_max = 10.0});
    }
  }
  std::vector<ElementHit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  caster.closest_hits(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i].t_max = i % 2 == 0 ? 2.5 : 10.0;
  caster.occluded(rays, blocked);  // rays from above end above the floor
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool is_hole = static_cast<int>(rays[i].origin.x()) % 2 == 1;
    const int beyond = i % 2 == 0 ? 1 : -1;
    EXPECT_EQ(hits[i].facet, is_hole ? beyond : 0) << rays[i].origin.transpose();
    EXPECT_EQ(blocked[i] != 0, !is_hole) << rays[i].origin.transpose();
  }
}

TEST(PatchTextures, RaysThatStartOnTheirOwnSurfaceLeaveThroughNothing) {
  Scene scene = plate();
  put_mask(scene, 0, picture_of(2, 1, {1.0f, 0.0f}));
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
  const ElementCaster caster(mesh);
  const Ray ray{.origin = {1, 0.5, 0}, .direction = {0.1, 0.2, 1}, .origin_group = 0};
  ElementHit hit;
  caster.closest_hits({&ray, 1}, {&hit, 1});
  EXPECT_EQ(hit.facet, -1);
}

// Two triangles of one square: on the left the picture continues, on the right it starts anew.
TEST(PatchTextures, PolygonsAreJoinedOnlyWhereThePictureGoesOn) {
  Scene scene = plate();
  put_picture(scene, 0, picture_of(2, 1, {0.2f, 0.8f}));
  auto& mesh = std::get<PolygonMesh>(scene.surfaces[0].shape);
  mesh.facets = {{.boundary = {0, 1, 2}, .uv_map = 0}, {.boundary = {0, 2, 3}, .uv_map = 0}};
  EXPECT_EQ(scene_facets(merge_planar_regions(scene)).size(), 1u);
  EXPECT_EQ(std::get<PolygonMesh>(merge_planar_regions(scene).surfaces[0].shape).facets[0].uv_map,
            0);
  mesh.uv_maps.push_back({});
  mesh.facets[1].uv_map = 1;
  EXPECT_EQ(scene_facets(merge_planar_regions(scene)).size(), 2u);
  scene.surfaces[0].material = 0;  // without a picture nothing keeps the triangles apart
  EXPECT_EQ(scene_facets(merge_planar_regions(scene)).size(), 1u);
}

TEST(PatchTextures, VerticesBetweenPatchesReflectTheMeanOfBoth) {
  Scene scene = plate();
  put_picture(scene, 0, picture_of(4, 1, {0.1f, 0.9f, 0.3f, 0.5f}));
  const PatchMesh mesh = build_patches(scene, {.max_patch_size = 1.0});
  const BandArray rho = vertex_reflectance(mesh);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double x = mesh.position(v).x();
    const double wanted = x == 0.5 ? 0.1 : x == 1.0 ? 0.5 : x == 2.0 ? 0.6 : rho(v, 0);
    EXPECT_NEAR(rho(v, 0), wanted, rounding) << x;
  }
}

TEST(PatchTextures, BitsDoNotDependOnTheNumberOfThreads) {
  Scene scene = plate();
  put_picture(scene, 0, picture_of(4, 1, {0.1f, 0.9f, 0.3f, 0.5f}));
  put_mask(scene, 0, picture_of(3, 2, {1.0f, 0.0f, 1.0f, 0.0f, 0.7f, 0.6f}));
  const auto built = [&](int threads) {
    const ThreadLimit limit(threads);
    return build_patches(scene, {.max_patch_size = 0.17});
  };
  const PatchMesh one = built(1);
  for (const int threads : {2, 3}) {
    const PatchMesh other = built(threads);
    EXPECT_TRUE((one.reflectance == other.reflectance).all());
    EXPECT_TRUE((one.area == other.area).all());
  }
}

}  // namespace
}  // namespace lightwell::patch_textures_test
