#include <gtest/gtest.h>

#include <atomic>
#include <limits>

#include "scene/parallel.h"
#include "scene/rays/ray_caster.h"

namespace lightwell::floating_point_mode_test {
namespace {

/// A square of n x n quads in the plane y = 0.
CastGeometry floor_of_quads(int n) {
  CastGeometry floor;
  for (int z = 0; z <= n; ++z) {
    for (int x = 0; x <= n; ++x) floor.vertices.emplace_back(x, 0.0, z);
  }
  for (int z = 0; z < n; ++z) {
    for (int x = 0; x < n; ++x) {
      const int v = z * (n + 1) + x;
      floor.quads.push_back({v, v + n + 1, v + n + 2, v + 1});
      floor.group.push_back(0);
    }
  }
  return floor;
}

/// Building a RayCaster is the first parallel work of this process. The floating-point mode of that
/// work must not become the mode of later loops.
TEST(FloatingPointMode, DenormalsSurviveInParallelLoopsAfterRayTreesAreBuilt) {
  const RayCaster caster(floor_of_quads(100));
  std::atomic<int> flushed{0};
  parallel_for(256, 1, [&](int, int) {
    volatile float smallest = std::numeric_limits<float>::min();
    if (!(smallest * 0.5f > 0.0f)) ++flushed;
  });
  EXPECT_EQ(flushed, 0);
}

/// A ray that starts exactly in a plane (t = 0, whose successor is denormal) must pass the plane
/// and hit the surface beyond, in parallel loops as well.
TEST(FloatingPointMode, RaysLeaveTheirOwnPlaneInParallelLoops) {
  CastGeometry room = floor_of_quads(100);
  const int v = static_cast<int>(room.vertices.size());
  for (const auto& [x, z] : {std::pair{0.0, 0.0}, {100.0, 0.0}, {100.0, 100.0}, {0.0, 100.0}}) {
    room.vertices.emplace_back(x, 50.0, z);
  }
  room.quads.push_back({v, v + 1, v + 2, v + 3});
  room.group.push_back(1);
  const RayCaster caster(room);
  std::atomic<int> missed{0};
  parallel_for(99, 1, [&](int i, int) {
    Ray ray{.origin = {0.5 + i, 0.0, 50.25}, .direction = {0.0, 1.0, 0.0}, .origin_group = 0};
    Hit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.primitive != static_cast<int>(room.quads.size()) - 1) ++missed;
  });
  EXPECT_EQ(missed, 0);
}

}  // namespace
}  // namespace lightwell::floating_point_mode_test
