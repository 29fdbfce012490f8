#include <gtest/gtest.h>

#include <algorithm>
#include <array>

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

// The six sides of a box, each a group of its own from `first_group` on: -x, +x, -y, +y, -z, +z.
// `inward`: a room, seen from within.
void add_box(CastGeometry& geometry, const Vector3d& low, const Vector3d& high, bool inward,
             int first_group) {
  const int first = static_cast<int>(geometry.vertices.size());
  for (int i = 0; i < 8; ++i) {
    geometry.vertices.push_back(
        {(i & 1) ? high.x() : low.x(), (i & 2) ? high.y() : low.y(), (i & 4) ? high.z() : low.z()});
  }
  constexpr std::array<std::array<int, 4>, 6> outward{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (int side = 0; side < 6; ++side) {
    std::array<int, 4> quad = outward[side];
    if (inward) std::reverse(quad.begin(), quad.end());
    for (int& corner : quad) corner += first;
    geometry.quads.push_back(quad);
    geometry.group.push_back(first_group + side);
  }
}

constexpr int low_x = 0, high_x = 1, low_z = 4;

// A ray that starts nowhere in particular.
Hit look(const RayCaster& caster, const Vector3d& from, const Vector3d& towards) {
  const Ray ray{.origin = from, .direction = towards - from};
  Hit hit;
  caster.closest_hits({&ray, 1}, {&hit, 1});
  return hit;
}

TEST(CoplanarRays, RoomsWithAWallInCommonSeeEachTheirOwn) {
  CastGeometry geometry;
  add_box(geometry, {0, 0, 0}, {1, 1, 1}, true, 0);
  add_box(geometry, {1, 0, 0}, {2, 1, 1}, true, 6);
  const RayCaster caster(geometry);
  for (int i = 1; i < 10; ++i) {
    const Vector3d on_wall(1.0, 0.1 * i, 0.37);
    EXPECT_EQ(look(caster, {0.3, 0.4, 0.5}, on_wall).primitive, high_x);
    EXPECT_EQ(look(caster, {1.7, 0.4, 0.5}, on_wall).primitive, 6 + low_x);
    // And neither wall lies on the other's front.
    EXPECT_EQ(cast(caster, on_wall, {-1.0, 0.05, 0.0}, high_x).primitive, low_x);
    EXPECT_EQ(cast(caster, on_wall, {1.0, 0.05, 0.0}, 6 + low_x).primitive, 6 + high_x);
    EXPECT_FALSE(cast(caster, on_wall, {-0.5, 0.0, 0.1}, high_x).is_blocked);
  }
}

TEST(CoplanarRays, BoxAgainstAWallAndOnTheFloorHidesThem) {
  CastGeometry geometry;
  add_box(geometry, {0, 0, 0}, {2, 2, 2}, true, 0);
  add_box(geometry, {0, 0, 0}, {1, 1, 1}, false, 6);
  const RayCaster caster(geometry);
  for (int i = 1; i < 10; ++i) {
    const Vector3d on_wall(0.0, 0.1 * i, 0.63), on_floor(0.1 * i, 0.41, 0.0);
    // Out of the box: its own sides, from behind.
    EXPECT_EQ(look(caster, {0.5, 0.4, 0.5}, on_wall).primitive, 6 + low_x);
    EXPECT_EQ(look(caster, {0.5, 0.4, 0.5}, on_floor).primitive, 6 + low_z);
    // The wall under it sees the side that lies on it, and nothing beyond.
    EXPECT_EQ(cast(caster, on_wall, {1.0, 0.1, 0.2}, low_x).primitive, 6 + low_x);
    EXPECT_EQ(cast(caster, on_wall, {0.01, 1.0, 0.2}, low_x).primitive, 6 + low_x);
    EXPECT_EQ(cast(caster, on_wall, {-0.01, 1.0, 0.2}, 6 + low_x).primitive, low_x);
    // Through the wall from outside: the wall, from behind.
    EXPECT_EQ(look(caster, {-1.0, 0.4, 0.5}, on_wall).primitive, low_x);
  }
}

TEST(CoplanarRays, WhatLiesOnATargetHidesIt) {
  CastGeometry geometry;
  add_box(geometry, {0, 0, 0}, {2, 2, 2}, true, 0);
  add_box(geometry, {0, 0, 0}, {1, 1, 1}, false, 6);
  const RayCaster caster(geometry);
  const auto is_blocked = [&](const Vector3d& from, const Vector3d& to, int target) {
    const Ray ray{.origin = from, .direction = to - from, .t_max = 1.0, .target_group = target};
    std::uint8_t blocked = 0;
    caster.occluded({&ray, 1}, {&blocked, 1});
    return blocked != 0;
  };
  const Vector3d inside(0.5, 0.4, 0.5), outside(-1.0, 0.4, 0.5);
  for (int i = 1; i < 10; ++i) {
    const Vector3d on_wall(0.0, 0.1 * i, 0.63);
    EXPECT_TRUE(is_blocked(inside, on_wall, low_x));
    EXPECT_FALSE(is_blocked(inside, on_wall, 6 + low_x));
    EXPECT_FALSE(is_blocked(outside, on_wall, low_x));
    EXPECT_TRUE(is_blocked(outside, on_wall, 6 + low_x));
  }
}

}  // namespace
}  // namespace lightwell
