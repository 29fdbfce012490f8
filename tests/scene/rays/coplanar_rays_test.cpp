#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <memory>
#include <numbers>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "scene/rays/ray_caster.h"

namespace lightwell::coplanar_rays_test {
namespace {

using Eigen::Vector3d;

// Adds a square in the plane z = height that faces up or down.
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

// A rug in the plane of its floor.
TEST(CoplanarRays, TheSmallerOfTwoSurfacesThatFaceOneWayHidesTheLarger) {
  const RayCaster caster = room_with_sheet_on_floor(true);
  for (const double z : hairs) {
    const Met from_rug = cast(caster, {0.1, 0.2, z}, slanted, sheet_group);
    EXPECT_EQ(from_rug.primitive, ceiling_group) << "at z " << z;
    EXPECT_FALSE(from_rug.is_blocked) << "at z " << z;
    EXPECT_TRUE(cast(caster, {0.1, 0.2, z}, slanted, floor_group).is_blocked) << "at z " << z;
  }
  // All rays from above meet the rug, wherever rounding puts the two planes.
  for (int i = 0; i < 100; ++i) {
    const Vector3d on_rug(0.009 * i - 0.45, 0.44 - 0.0087 * i, 0.0);
    EXPECT_EQ(cast(caster, on_rug + 0.4 * slanted, -slanted, ceiling_group).primitive, sheet_group);
  }
}

// A model may hold a surface twice: the same copy must be met from everywhere.
TEST(CoplanarRays, TheFirstOfTwoSurfacesOfOneAreaThatFaceOneWayHidesTheOther) {
  CastGeometry geometry;
  add_square(geometry, 1.0, 0.0, true, floor_group);
  add_square(geometry, 1.0, 0.0, true, sheet_group);
  for (std::size_t i = 4; i < 8; ++i) geometry.vertices[i].x() += 0.5;
  add_square(geometry, 10.0, 1.0, false, ceiling_group);
  const RayCaster caster(geometry);
  for (const double z : hairs) {
    const Met from_first = cast(caster, {0.1, 0.2, z}, slanted, floor_group);
    EXPECT_EQ(from_first.primitive, ceiling_group) << "at z " << z;
    EXPECT_FALSE(from_first.is_blocked) << "at z " << z;
    EXPECT_TRUE(cast(caster, {0.1, 0.2, z}, slanted, sheet_group).is_blocked) << "at z " << z;
    EXPECT_FALSE(cast(caster, {1.2, 0.2, z}, slanted, sheet_group).is_blocked) << "at z " << z;
  }
  for (int i = 0; i < 100; ++i) {
    const Vector3d on_both(0.014 * i - 0.45, 0.9 - 0.018 * i, 0.0), from = on_both + 0.4 * slanted;
    EXPECT_EQ(cast(caster, from, -slanted, ceiling_group).primitive, floor_group);
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

// Programs write a sheet with two faces as two sheets of opposite fronts.
TEST(CoplanarRays, TwoSheetsOfOneOutlineTouchWithTheirBacks) {
  CastGeometry geometry;
  add_square(geometry, 0.5, 0.0, true, floor_group);
  add_square(geometry, 0.5, 0.0, false, sheet_group);
  add_square(geometry, 10.0, 1.0, false, ceiling_group);
  constexpr int ground_group = 3;
  add_square(geometry, 10.0, -1.0, true, ground_group);
  const RayCaster caster(geometry);
  for (const double z : hairs) {
    const Met up = cast(caster, {0.1, 0.2, z}, slanted, floor_group);
    EXPECT_EQ(up.primitive, ceiling_group) << "at z " << z;
    EXPECT_FALSE(up.is_blocked) << "at z " << z;
    const Met down = cast(caster, {0.1, 0.2, z}, -slanted, sheet_group);
    EXPECT_EQ(down.primitive, ground_group) << "at z " << z;
    EXPECT_FALSE(down.is_blocked) << "at z " << z;
  }
  for (int i = 0; i < 100; ++i) {
    const Vector3d on_both(0.009 * i - 0.45, 0.44 - 0.0087 * i, 0.0), away = 0.4 * slanted;
    EXPECT_EQ(cast(caster, on_both + away, -slanted, ceiling_group).primitive, floor_group);
    EXPECT_EQ(cast(caster, on_both - away, slanted, ground_group).primitive, sheet_group);
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

// Adds the six sides of a box, -x, +x, -y, +y, -z, +z, as six groups from `first_group` on.
// `inward`: a room, whose sides face inwards.
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

// Positions of two bodies and their rounding: the second may be turned by a quarter about an axis,
// as by a node of a glTF file whose quaternion is stored in float.
struct Placement {
  const char* name;
  Eigen::Affine3d of_both = Eigen::Affine3d::Identity();
  std::optional<Vector3d> turns_second{};  // the axis
  bool is_undecided = false;               // rounding decides which of two faces is first
  friend void PrintTo(const Placement& place, std::ostream* out) { *out << place.name; }
};

// A rotation that deviates from a quarter turn by 1.7e-7.
Eigen::Affine3d float_quarter_turn(const Vector3d& axis) {
  Eigen::Quaterniond turn;
  turn.w() = 0.7071067094802856;
  turn.vec() = 0.7071068286895752 * axis;
  return Eigen::Affine3d(turn);
}

class CoplanarBodies : public testing::TestWithParam<Placement> {
 protected:
  void build(CastGeometry geometry, std::size_t first_vertex_of_second) {
    const Placement& place = GetParam();
    for (std::size_t v = 0; v < geometry.vertices.size(); ++v) {
      Vector3d& p = geometry.vertices[v];
      if (place.turns_second && v >= first_vertex_of_second) {
        const Eigen::Matrix3d turn = float_quarter_turn(*place.turns_second).linear();
        const Eigen::Matrix3d exact = turn.array().round();  // its local coordinates are whole
        p = turn * (exact.transpose() * p);
      }
      p = place.of_both * p;
    }
    caster = std::make_unique<RayCaster>(geometry);
  }
  void build_rooms_side_by_side() {
    CastGeometry geometry;
    add_box(geometry, {0, 0, 0}, {1, 1, 1}, true, 0);
    add_box(geometry, {1, 0, 0}, {2, 1, 1}, true, 6);
    build(geometry, 8);
  }
  void build_block_in_room() {
    CastGeometry geometry;
    add_box(geometry, {0, 0, 0}, {2, 2, 2}, true, 0);
    add_box(geometry, {0, 0, 0}, {1, 1, 1}, false, 6);
    build(geometry, 8);
  }
  // Primitive that a ray hits which starts on no surface.
  int look(const Vector3d& from, const Vector3d& towards) const {
    const Ray ray = between(from, towards);
    Hit hit;
    caster->closest_hits({&ray, 1}, {&hit, 1});
    return hit.primitive;
  }
  Met leave(const Vector3d& from, const Vector3d& direction, int group) const {
    const Eigen::Affine3d& to_world = GetParam().of_both;
    return cast(*caster, to_world * from, to_world.linear() * direction, group);
  }
  bool is_blocked(const Vector3d& from, const Vector3d& to, int target) const {
    Ray ray = between(from, to);
    ray.t_max = 1.0;
    ray.target_group = target;
    std::uint8_t blocked = 0;
    caster->occluded({&ray, 1}, {&blocked, 1});
    return blocked != 0;
  }
  std::unique_ptr<RayCaster> caster;

 private:
  static Ray between(const Vector3d& from, const Vector3d& to) {
    const Eigen::Affine3d& to_world = GetParam().of_both;
    return {.origin = to_world * from, .direction = to_world.linear() * (to - from)};
  }
};

TEST_P(CoplanarBodies, RoomsWithAWallInCommonSeeEachTheirOwn) {
  build_rooms_side_by_side();
  for (int i = 1; i < 10; ++i) {
    const Vector3d on_wall(1.0, 0.1 * i, 0.37);
    EXPECT_EQ(look({0.3, 0.4, 0.5}, on_wall), high_x);
    EXPECT_EQ(look({1.7, 0.4, 0.5}, on_wall), 6 + low_x);
    // Neither wall lies on the front of the other.
    EXPECT_EQ(leave(on_wall, {-1.0, 0.05, 0.0}, high_x).primitive, low_x);
    EXPECT_EQ(leave(on_wall, {1.0, 0.05, 0.0}, 6 + low_x).primitive, 6 + high_x);
    EXPECT_FALSE(leave(on_wall, {-0.5, 0.0, 0.1}, high_x).is_blocked);
  }
}

TEST_P(CoplanarBodies, BoxAgainstAWallAndOnTheFloorHidesThem) {
  build_block_in_room();
  for (int i = 1; i < 10; ++i) {
    const Vector3d on_wall(0.0, 0.1 * i, 0.63), on_floor(0.1 * i, 0.41, 0.0);
    // Rays out of the box hit its own sides from behind. Where rounding alone decides which of two
    // faces is first, so does the processor for rays that start on neither, and no light is inside.
    const auto is_own = [](int met, int side) {
      return met == 6 + side || (GetParam().is_undecided && met == side);
    };
    EXPECT_PRED2(is_own, look({0.5, 0.4, 0.5}, on_wall), low_x);
    EXPECT_PRED2(is_own, look({0.5, 0.4, 0.5}, on_floor), low_z);
    // Rays from the wall hit the side that lies on the wall, and nothing beyond.
    EXPECT_EQ(leave(on_wall, {1.0, 0.1, 0.2}, low_x).primitive, 6 + low_x);
    EXPECT_EQ(leave(on_wall, {0.01, 1.0, 0.2}, low_x).primitive, 6 + low_x);
    EXPECT_EQ(leave(on_wall, {-0.01, 1.0, 0.2}, 6 + low_x).primitive, low_x);
    EXPECT_EQ(leave(on_floor, {0.2, 0.1, 1.0}, low_z).primitive, 6 + low_z);
    // Rays through the wall from outside hit the wall from behind.
    EXPECT_EQ(look({-1.0, 0.4, 0.5}, on_wall), low_x);
  }
}

TEST_P(CoplanarBodies, WhatLiesOnATargetHidesIt) {
  build_block_in_room();
  const Vector3d inside(0.5, 0.4, 0.5), outside(-1.0, 0.4, 0.5);
  for (int i = 1; i < 10; ++i) {
    const Vector3d on_wall(0.0, 0.1 * i, 0.63);
    EXPECT_TRUE(is_blocked(inside, on_wall, low_x));
    EXPECT_FALSE(is_blocked(inside, on_wall, 6 + low_x));
    EXPECT_FALSE(is_blocked(outside, on_wall, low_x));
    EXPECT_TRUE(is_blocked(outside, on_wall, 6 + low_x));
  }
}

TEST_P(CoplanarBodies, TheFacesThatMeetAreHidden) {
  build_block_in_room();
  for (const int side : {low_x, low_z}) {
    constexpr bool from_front = false, from_back = true;
    EXPECT_TRUE(caster->is_hidden(6 + side, from_front));
    EXPECT_FALSE(caster->is_hidden(6 + side, from_back));
  }
}

Eigen::Affine3d on_the_map(double angle) {
  return Eigen::Translation3d(5e5, 5e6, 100.0) * Eigen::AngleAxisd(angle, Vector3d::UnitZ());
}

// A transformation after which rounding alone decides the sign of the wall's normal.
Eigen::Affine3d undecided() {
  const Vector3d askew(0.8191, 0.4927, 0.2937);
  return Eigen::Affine3d(Eigen::Quaterniond::FromTwoVectors(
      Vector3d::UnitX(), askew.cross(Vector3d::UnitZ()).normalized()));
}

const Eigen::Affine3d eighth_turn(Eigen::AngleAxisd(std::numbers::pi / 4.0, Vector3d::UnitZ()));

INSTANTIATE_TEST_SUITE_P(
    Places, CoplanarBodies,
    testing::Values(
        Placement{.name = "Plain"},
        Placement{.name = "TurnedAboutX", .turns_second = Vector3d::UnitX()},
        Placement{.name = "TurnedAboutY", .turns_second = Vector3d::UnitY()},
        Placement{.name = "TurnedAboutZ", .turns_second = Vector3d::UnitZ()},
        Placement{.name = "OnTheMap", .of_both = on_the_map(0.3)},
        Placement{.name = "OnTheMapTurned",
                  .of_both = on_the_map(0.3),
                  .turns_second = Vector3d::UnitY()},
        Placement{.name = "Diagonal", .of_both = eighth_turn, .turns_second = Vector3d::UnitY()},
        Placement{.name = "DiagonalTheOtherWay",
                  .of_both = eighth_turn,
                  .turns_second = Vector3d::UnitZ()},
        Placement{.name = "Undecided",
                  .of_both = undecided(),
                  .turns_second = Vector3d::UnitY(),
                  .is_undecided = true},
        Placement{.name = "UndecidedTheOtherWay",
                  .of_both = undecided(),
                  .turns_second = -Vector3d::UnitZ(),
                  .is_undecided = true}),
    [](const auto& place) { return std::string(place.param.name); });

// A strip as long as the floor, and small sheets beside and beyond it, in shuffled order. Points on
// a sheet are distinguished from points between sheets.
// A ray that began below the plane of the bottom, by the bound of rounding, would pass under the
// edge between the wall and the floor.
TEST(CoplanarRays, NoRayFromTheBottomOfABoxPassesUnderTheWallsOfTheBox) {
  CastGeometry geometry;
  constexpr int room = 0, box = 6;
  add_box(geometry, {-8, -6, 0}, {8, 6, 3}, true, room);
  add_box(geometry, {0, 0, 0}, {0.1, 2, 3}, false, box);
  const RayCaster caster(geometry);
  for (const double from_wall : {1e-5, 3e-5, 1e-4}) {
    for (const double slope : {0.003, 0.01, 0.03, 0.1}) {
      const Ray ray{.origin = {0.1 - from_wall, 1.234, 0.0},
                    .direction = {1.0, 0.1, slope},
                    .origin_group = box + low_z};
      Hit hit;
      caster.closest_hits({&ray, 1}, {&hit, 1});
      EXPECT_EQ(hit.group, box + high_x) << from_wall << " m from the wall, slope " << slope;
    }
  }
}

TEST(CoplanarRays, ManySheetsOnAFloorEachHideWhatIsBelow) {
  CastGeometry geometry;
  add_square(geometry, 10.0, 0.0, true, 0);
  int group = 0;
  const auto add_sheet = [&](double x, double y, double half_x, double half_y) {
    const int first = static_cast<int>(geometry.vertices.size());
    geometry.vertices.insert(geometry.vertices.end(), {{x - half_x, y - half_y, 0.0},
                                                       {x - half_x, y + half_y, 0.0},
                                                       {x + half_x, y + half_y, 0.0},
                                                       {x + half_x, y - half_y, 0.0}});
    geometry.quads.push_back({first, first + 1, first + 2, first + 3});  // faces down
    geometry.group.push_back(++group);
  };
  std::vector<Eigen::Vector2d> on, between;
  for (int i = 0; i < 16; ++i) {
    const double x = -7.0 + (i * 7) % 16;
    add_sheet(x, 2.0, 0.2, 0.3);
    on.emplace_back(x + 0.1, 2.2);
    between.emplace_back(x + 0.5, 2.0);
    between.emplace_back(x + 0.1, 2.5);
  }
  add_sheet(-1.0, 5.0, 8.0, 0.5);
  for (int i = 0; i < 16; ++i) on.emplace_back(-8.9 + i, 5.4);
  between.emplace_back(7.5, 5.0);
  const RayCaster caster(geometry);
  const auto is_blocked = [&](const Eigen::Vector2d& at) {
    return cast(caster, {at.x(), at.y(), 0.0}, slanted, 0).is_blocked;
  };
  for (const Eigen::Vector2d& at : on) EXPECT_TRUE(is_blocked(at)) << at.transpose();
  for (const Eigen::Vector2d& at : between) EXPECT_FALSE(is_blocked(at)) << at.transpose();
}

}  // namespace
}  // namespace lightwell::coplanar_rays_test
