#include <gtest/gtest.h>

#include "scene/ray_caster.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// A square in the plane z = height, turned up or down.
void add_square(CastGeometry& geometry, double half_size, double height, bool faces_up, int group) {
  const int first = static_cast<int>(geometry.vertices.size());
  const double h = half_size;
  geometry.vertices.insert(geometry.vertices.end(),
                           {{-h, -h, height}, {h, -h, height}, {h, h, height}, {-h, h, height}});
  if (faces_up) {
    geometry.quads.push_back({first, first + 1, first + 2, first + 3});
  } else {
    geometry.quads.push_back({first, first + 3, first + 2, first + 1});
  }
  geometry.group.push_back(group);
}

constexpr int floor_group = 0, sheet_group = 1, ceiling_group = 2;

RayCaster room_with_sheet_on_floor(bool sheet_faces_up) {
  CastGeometry geometry;
  add_square(geometry, 1.0, 0.0, true, floor_group);
  add_square(geometry, 0.5, 0.0, sheet_faces_up, sheet_group);
  add_square(geometry, 10.0, 1.0, false, ceiling_group);
  return RayCaster(geometry);
}

struct Met {
  int primitive;
  bool is_blocked;
};

Met cast(const RayCaster& caster, const Vector3d& origin, const Vector3d& direction, int group) {
  Ray ray{.origin = origin, .direction = direction, .t_max = 0.5, .origin_group = group};
  std::uint8_t blocked = 0;
  caster.occluded({&ray, 1}, {&blocked, 1});
  ray.t_max = 10.0;
  Hit hit;
  caster.closest_hits({&ray, 1}, {&hit, 1});
  return {hit.primitive, blocked != 0};
}

const Vector3d slanted{0.1, 0.2, 1.0};
const double hairs[] = {0.0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-8, -1e-8};

TEST(CoplanarRays, SurfacesThatFaceOneWayDoNotShadeEachOther) {
  const RayCaster caster = room_with_sheet_on_floor(true);
  for (const double z : hairs) {
    for (const int group : {floor_group, sheet_group}) {
      const Met met = cast(caster, {0.1, 0.2, z}, slanted, group);
      EXPECT_EQ(met.primitive, ceiling_group) << "from group " << group << " at z " << z;
      EXPECT_FALSE(met.is_blocked) << "from group " << group << " at z " << z;
    }
  }
}

TEST(CoplanarRays, SurfacesFaceToFaceDo) {
  const RayCaster caster = room_with_sheet_on_floor(false);
  for (const double z : hairs) {
    if (z > 0.0) continue;  // above both, a ray that goes up has passed them
    const Met met = cast(caster, {0.1, 0.2, z}, slanted, floor_group);
    EXPECT_EQ(met.primitive, sheet_group) << "at z " << z;
    EXPECT_TRUE(met.is_blocked) << "at z " << z;
  }
}

TEST(CoplanarRays, BesideWhatLiesOnItThePlaneIsFree) {
  for (const bool faces_up : {true, false}) {
    const RayCaster caster = room_with_sheet_on_floor(faces_up);
    for (const double z : hairs) {
      const Met met = cast(caster, {0.7, -0.8, z}, slanted, floor_group);
      EXPECT_EQ(met.primitive, ceiling_group) << "at z " << z;
      EXPECT_FALSE(met.is_blocked) << "at z " << z;
    }
  }
}

}  // namespace
}  // namespace lightwell
