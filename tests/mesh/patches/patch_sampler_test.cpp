#include "mesh/patches/patch_sampler.h"

#include <gtest/gtest.h>

namespace lightwell::patch_sampler_test {
namespace {

// A needle as high as one unit in the last place of its coordinates has no area left between
// corners that are rounded anew, and its points must be finite nevertheless.
TEST(PatchSampler, PointsOfNeedlesAreFinite) {
  constexpr double height = 0x1p-51;  // of numbers from 2 to 4
  PatchMesh mesh;
  mesh.patch = {0};
  mesh.facet = {0};
  mesh.corners = {{0, 1, 2, -1}};
  mesh.element_area = Eigen::ArrayXd::Constant(1, 0.5 * height);
  mesh.twin = {-1};
  mesh.first_element = {0, 1};
  mesh.area = mesh.element_area;
  mesh.surface = {0};
  mesh.material = {0};
  mesh.is_back = {0};
  build_topology(mesh, {{2.5, 3.0, 0.0}, {3.5, 3.0, 0.0}, {3.0, 3.0 + height, 0.0}});
  for (const PatchSampler& sampler : {PatchSampler(mesh, 0), PatchSampler(mesh, 0, 0)}) {
    for (const double u : {0.0, 0.3, 0.999}) {
      const PatchPoint at = sampler.point(u, 0.6);
      EXPECT_TRUE(at.position.allFinite()) << u;
      EXPECT_TRUE(at.normal.allFinite()) << u;
    }
  }
}

}  // namespace
}  // namespace lightwell::patch_sampler_test
