#include "scene/io/stf/stf_plan.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "scene/io/convex_cut.h"

namespace lightwell {
namespace {

constexpr double highest_room = 1000.0;  // m; larger numbers are millimetres
constexpr double widest_room = 1e5;      // m
constexpr double least_wall = 1e-6;      // m; shorter walls are corners given twice

struct Wall {
  Eigen::Vector2d start = Eigen::Vector2d::Zero();
  double reflectance = 0.0;
};

double reflectance(StfSection& room, const std::string& key, double usual, Remarks& remarks) {
  const auto value = room.number(key);
  if (!value) {
    remarks.mention(
        "Reflectances that rooms lack became 0.7 of ceilings, 0.5 of walls and 0.2 of floors",
        fmt::format("[{}]", room.name()));
    return usual;
  }
  if (!(*value >= 0.0 && *value <= 1.0)) {
    room.fail(key,
              fmt::format("is {:g}; write a share between 0 and 1, such as 0.7 for 70 %", *value));
  }
  return *value;
}

// The walls in the order of the file. The count is compared with the points before any memory is
// taken for them.
std::vector<Wall> read_walls(StfSection& room, Remarks& remarks) {
  if (!room.has("NrPoints"))
    room.fail("lacks the key 'NrPoints'; add it, with the number of Point1 ...");
  const std::size_t said = room.count("NrPoints");
  std::size_t found = 0;
  while (found < said && room.has(fmt::format("Point{}", found + 1))) ++found;
  if (found < said) {
    room.fail("NrPoints", fmt::format("is {}, but there is no Point{}; write {}, or add the points",
                                      said, found + 1, found));
  }
  std::vector<Wall> walls;
  for (std::size_t i = 1; i <= found; ++i) {
    const std::vector<double> point = room.numbers(fmt::format("Point{}", i), 2);
    if (point.size() > 2 && point[2] != 0.0) {
      remarks.add("Heights of corners were left out: floors are level",
                  fmt::format("[{}]", room.name()));
    }
    walls.push_back({.start = {point[0], point[1]},
                     .reflectance = reflectance(room, fmt::format("R_Wall{}", i), 0.5, remarks)});
  }
  return walls;
}

// Removes walls without length, such as that of a first point that is repeated at the end.
void drop_short_walls(StfSection& room, std::vector<Wall>& walls, Remarks& remarks) {
  const std::size_t before = walls.size();
  std::vector<Wall> kept;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Eigen::Vector2d& end = walls[(i + 1) % walls.size()].start;
    if ((end - walls[i].start).norm() > least_wall) kept.push_back(walls[i]);
  }
  walls = std::move(kept);
  if (walls.size() < before) {
    remarks.mention("Points that repeat the next one were read once",
                    fmt::format("[{}]", room.name()));
  }
}

// Turns the order of the walls around. A wall then begins where it ended.
void turn_around(std::vector<Wall>& walls) {
  std::vector<Wall> turned;
  for (std::size_t i = walls.size(); i-- > 0;) {
    turned.push_back({walls[(i + 1) % walls.size()].start, walls[i].reflectance});
  }
  walls = std::move(turned);
}

std::vector<Loop> triangles(const StfPlan& plan) {
  const Loop outline = plan.outline(0.0);
  std::vector<Loop> result;
  for (const auto& [a, b, c] : split_into_triangles(outline)) {
    const auto at = [&](int i) { return outline[static_cast<std::size_t>(i)]; };
    result.push_back({at(a), at(b), at(c)});
  }
  return result;
}

// Area that two triangles share, m^2: `a` clipped at the edges of `b`.
double shared_area(Loop a, const Loop& b) {
  for (std::size_t i = 0; i < b.size(); ++i) {
    const Eigen::Vector3d inward = Eigen::Vector3d::UnitZ().cross(b[(i + 1) % b.size()] - b[i]);
    std::vector<double> distance;
    for (const Eigen::Vector3d& p : a) distance.push_back(inward.dot(p - b[i]));
    a = clip_convex(a, distance, 1.0);
    if (a.size() < 3) return 0.0;
  }
  return area_vector(a).norm();
}

struct Footprint {
  Eigen::AlignedBox2d box{};
  std::vector<Loop> triangles{};
};

// True if two plans share more than the strip along a wall that rounded coordinates make.
bool overlap(const Footprint& a, const Footprint& b, double least_area) {
  double shared = 0.0;
  for (const Loop& one : a.triangles) {
    for (const Loop& other : b.triangles) {
      shared += shared_area(one, other);
      if (shared > least_area) return true;
    }
  }
  return false;
}

}  // namespace

Loop StfPlan::outline(double above) const {
  Loop loop;
  for (const Eigen::Vector2d& p : corners) loop.emplace_back(p.x(), p.y(), level + above);
  return loop;
}

StfPlan read_stf_plan(StfSection& room, const std::string& name, Remarks& remarks) {
  StfPlan plan{.name = name, .height = room.positive("Height")};
  if (plan.height > highest_room) {
    room.fail("Height", fmt::format("is {:g} m, which no room has; lengths of STF are in metres",
                                    plan.height));
  }
  std::vector<Wall> walls = read_walls(room, remarks);
  drop_short_walls(room, walls, remarks);
  plan.ceiling = reflectance(room, "R_Ceiling", 0.7, remarks);
  plan.floor = reflectance(room, "R_Floor", 0.2, remarks);
  if (walls.size() < 3) room.fail("has fewer than three corners; a room needs at least three");
  const auto set_corners = [&] {
    plan.corners.clear();
    for (const Wall& wall : walls) plan.corners.push_back(wall.start);
  };
  set_corners();
  if (!(size_of(plan.outline(0.0)) <= widest_room)) {
    room.fail(fmt::format("is more than {:g} m wide; lengths of STF are in metres", widest_room));
  }
  if (const std::string what = fault({plan.outline(0.0)}); !what.empty()) {
    room.fail(
        fmt::format("cannot be built: its outline {}; give the corners in order around", what));
  }
  if (area_vector(plan.outline(0.0)).z() < 0.0) {
    turn_around(walls);
    set_corners();
  }
  for (const Wall& wall : walls) plan.walls.push_back(wall.reflectance);
  return plan;
}

void set_levels(const StfSection& project, std::vector<StfPlan>& plans, Remarks& remarks) {
  constexpr std::int64_t most_pairs = 100'000'000;  // of triangles and boxes: some seconds
  std::int64_t pairs = 0;
  std::vector<Footprint> footprints;
  for (StfPlan& plan : plans) {
    Footprint footprint;
    for (const Eigen::Vector2d& p : plan.corners) footprint.box.extend(p);
    for (std::size_t i = 0; i < footprints.size(); ++i) {
      Footprint& below = footprints[i];
      ++pairs;
      if (footprint.box.intersection(below.box).isEmpty()) continue;
      if (footprint.triangles.empty()) footprint.triangles = triangles(plan);
      if (below.triangles.empty()) below.triangles = triangles(plans[i]);
      pairs += static_cast<std::int64_t>(footprint.triangles.size() * below.triangles.size());
      if (pairs > most_pairs) {
        project.fail_limit(
            "has rooms of too many corners that lie over each other; divide the file");
      }
      const double smaller = std::min(footprint.box.volume(), below.box.volume());
      constexpr double wall_strip = 1e-3;  // of the smaller room
      if (overlap(footprint, below, wall_strip * smaller)) {
        plan.level = std::max(plan.level, plans[i].level + plans[i].height);
      }
    }
    if (plan.level > 0.0) {
      remarks.mention("Rooms that lie over an earlier one in plan were set onto it", plan.name);
    }
    footprints.push_back(std::move(footprint));
  }
}

}  // namespace lightwell
