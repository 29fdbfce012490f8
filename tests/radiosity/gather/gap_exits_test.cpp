#include "radiosity/gather/gap_exits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/build_patches.h"
#include "tests/radiosity/test_scenes.h"

namespace lightwell::gap_exits_test {
namespace {

using Eigen::Vector3d;

constexpr double width = 0.002;
constexpr int floor_facet = 4;

// A board of 1 m x 1 m, 2 mm above the floor of a room.
struct Board {
  Board() {
    const int wall = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
    test::add_box(scene, {0, 0, 0}, {4, 3, 2.5}, {wall, wall, wall, wall, wall, wall}, true);
    test::add_box(scene, {1, 1, width}, {2, 2, 0.02}, {wall, wall, wall, wall, wall, wall}, false);
  }
  static bool is_out(const Ray& ray, const ElementHit& hit) {
    const Vector3d at = ray.origin + hit.t * ray.direction;
    return at.z() > 1.01 * width;
  }
  GapExits exits(const ElementCaster& caster, std::uint64_t key) const {
    const SurfacePoint at{
        .position = {1.3, 1.4, 0.0}, .normal = Vector3d::UnitZ(), .facet = floor_facet};
    return GapExits(caster, at, width, 2.0, key, is_out);
  }

  Scene scene;
};

TEST(GapExits, HaveDirectionsOfTheStatedDensity) {
  const Board board;
  const PatchMesh mesh = build_patches(board.scene, {.max_patch_size = 1.0});
  const ElementCaster caster(mesh);
  // Also below the board, and for a board that is tilted by some degrees.
  for (const Vector3d& normal : {Vector3d(0, 0, 1), Vector3d(0, 0, -1), Vector3d(0.1, 0.05, -1)}) {
    const GapExits exits = board.exits(caster, 7);
    const Vector3d n = normal.normalized();
    constexpr int count = 100000;
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < count; ++i) {
      const auto number = [&](std::uint64_t k) {
        return random_uniform(random_key(static_cast<std::uint64_t>(i), k));
      };
      const Vector3d d = exits.draw(n, number(1), number(2), number(3));
      ASSERT_NEAR(d.norm(), 1.0, 1e-12);
      const double q = exits.density(n, d);
      ASSERT_GT(q, 0.0);
      const double weight = d.dot(n) * std::numbers::inv_pi / q;
      sum += weight;
      squares += weight * weight;
    }
    // Half of cosine-distributed directions have a tangent above 1. Four standard errors.
    const double mean = sum / count, error = std::sqrt((squares / count - mean * mean) / count);
    EXPECT_NEAR(mean, 0.5, 4.0 * error);
    // Four errors are then 8 % of the mean; a density that lacks a 2, a pi or a sine is off by
    // more.
    EXPECT_LT(error, 0.01);
    EXPECT_EQ(exits.density(n, n), 0.0) << "steep directions are left to other rays";
  }
}

TEST(GapExits, AreWhereRaysGetOut) {
  const Board board;
  const PatchMesh mesh = build_patches(board.scene, {.max_patch_size = 1.0});
  const ElementCaster caster(mesh);
  const GapExits exits = board.exits(caster, 7);
  EXPECT_FALSE(exits.is_closed());
  constexpr int count = 1024;
  int out = 0;
  for (int i = 0; i < count; ++i) {
    const auto number = [&](std::uint64_t k) {
      return random_uniform(random_key(static_cast<std::uint64_t>(i), k));
    };
    const Ray ray{.origin = {1.3, 1.4, 0.0},
                  .direction = exits.draw(Vector3d::UnitZ(), number(1), number(2), number(3)),
                  .origin_group = floor_facet};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    out += Board::is_out(ray, hit) ? 1 : 0;
  }
  // Half of the directions are drawn in cells in which a pilot ray got out, at least half of each
  // of which is outside in the mean. Of cosine-distributed ones 1 in 20 000 gets 0.3 m far.
  EXPECT_GT(out, count / 4);
}

}  // namespace
}  // namespace lightwell::gap_exits_test
