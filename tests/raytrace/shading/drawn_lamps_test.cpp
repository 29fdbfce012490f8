#include "raytrace/shading/drawn_lamps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "raytrace/shading/shown_radiance.h"
#include "tests/viewer/lamp_box.h"

namespace lightwell::drawn_lamps_test {
namespace {

Scene with_pendant(const Eigen::Vector3d& position) {
  Scene scene;
  scene.lamps = {pendant(position)};
  return scene;
}

int count_shining(const DrawnLamps& lamps) {
  return static_cast<int>(std::ranges::count(lamps.faces(), true, &DrawnLamps::Face::shines));
}

/// Walls of radiance 1 / pi all around make a body of half their radiance. The opening has the mean
/// radiance of its cone's flux, 2 pi (1 - cos 1) I / (pi A), all of which leaves ahead.
TEST(DrawnLamps, BodiesReflectWhatFallsOnThem) {
  const SolvedScene room = even_room();
  const ElementCaster caster(room.mesh);
  const DrawnLamps lamps(with_pendant({1, 1, 1}), caster);
  ASSERT_EQ(lamps.faces().size(), 7u);
  const BandArray L = lamps.radiance(room.mesh, shown_radiance(room, {}), {});
  for (std::size_t f = 0; f < lamps.faces().size(); ++f) {
    const double wanted = lamps.faces()[f].shines ? 2.0 * (1.0 - std::cos(1.0)) * 10.0 / 0.25
                                                  : 0.5 / std::numbers::pi;
    // A body's light is the sum of 64 floats, an opening's the product of a few.
    constexpr double epsilon = std::numeric_limits<float>::epsilon();
    const double rounding = (lamps.faces()[f].shines ? 4 : 64) * epsilon;
    EXPECT_NEAR(L(static_cast<Eigen::Index>(f), 1), wanted, rounding * wanted) << f;
  }
  const BandArray off = BandArray::Zero(1, 3);
  const BandArray dark = lamps.radiance(room.mesh, shown_radiance(room, {}), off);
  EXPECT_EQ((L - dark).rowwise().maxCoeff().maxCoeff(), L.maxCoeff());
}

TEST(DrawnLamps, BodiesEndAtTheCeilingTheyAreLetInto) {
  const SolvedScene room = even_room();
  const ElementCaster caster(room.mesh);
  const DrawnLamps flush(with_pendant({1, 2, 1}), caster);
  EXPECT_EQ(flush.faces().size(), 1u) << "an opening alone";
  EXPECT_EQ(count_shining(flush), 1);
  const DrawnLamps low(with_pendant({1, 1.9, 1}), caster);
  ASSERT_EQ(low.faces().size(), 7u);
  double top = 0.0;
  for (const DrawnLamps::Face& face : low.faces()) {
    for (const Eigen::Vector3d& p : face.outline) top = std::max(top, p.y());
  }
  // A body ends 2 mm in front of the ceiling, to sixteen roundings of floats up to 2 m.
  constexpr double rounding = 16 * 0x1p-24 * 2.0;
  EXPECT_NEAR(top, 2.0 - 0.002, rounding);
}

}  // namespace
}  // namespace lightwell::drawn_lamps_test
