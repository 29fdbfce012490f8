#include "scene/io/pov/pov_solids.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/io/placed_mesh.h"
#include "scene/io/pov/pov_profile.h"
#include "scene/io/round_facets.h"
#include "scene/io/torus_loops.h"

namespace lightwell {
namespace {

PovSolid read_box(PovCursor& cursor) {
  const Eigen::Vector3d a = cursor.need_point("corner"), b = cursor.need_point("second corner");
  const Eigen::Vector3d low = a.cwiseMin(b), high = a.cwiseMax(b);
  if (!((high - low).minCoeff() > 0.0)) return {};
  PovFacets facets{.loops = cube_loops()};
  for (Loop& loop : facets.loops) {
    for (Eigen::Vector3d& p : loop) p = (p.array() < 0.0).select(low.array(), high.array());
  }
  return {.pieces = {{.shape = std::move(facets)}}};
}

PovSolid read_sphere(PovCursor& cursor) {
  const Eigen::Vector3d center = cursor.need_point("centre");
  const double radius = std::abs(cursor.need_number("radius"));
  if (!(radius > 0.0)) return {};
  return {.pieces = {{.shape = Sphere{.center = center, .radius = radius}}}};
}

Frustum disc_about(const Eigen::Vector3d& middle, const Eigen::Vector3d& normal, double radius,
                   double hole) {
  return frustum_about(middle, normal, 0.0, radius, hole, false);
}

/// A truncated cone from `base` to `top`, with discs at its ends unless it is open.
PovSolid cone_between(const Eigen::Vector3d& base, double base_radius, const Eigen::Vector3d& top,
                      double top_radius, bool is_open) {
  const Eigen::Vector3d axis = top - base;
  const double height = axis.stableNorm();
  if (!(height > 0.0 && base_radius + top_radius > 0.0)) return {};
  PovSolid solid{.is_closed = !is_open};
  solid.pieces.push_back(
      {.shape = frustum_about(base, axis, height, base_radius, top_radius, false)});
  if (is_open) return solid;
  if (base_radius > 0.0) {
    solid.pieces.push_back({.shape = disc_about(base, -axis, base_radius, 0.0), .suffix = " base"});
  }
  if (top_radius > 0.0) {
    solid.pieces.push_back({.shape = disc_about(top, axis, top_radius, 0.0), .suffix = " top"});
  }
  return solid;
}

PovSolid read_cylinder(PovCursor& cursor) {
  const Eigen::Vector3d base = cursor.need_point("base"), top = cursor.need_point("cap");
  const double radius = std::abs(cursor.need_number("radius"));
  return cone_between(base, radius, top, radius, cursor.take("open"));
}

PovSolid read_cone(PovCursor& cursor) {
  const Eigen::Vector3d base = cursor.need_point("base");
  const double base_radius = std::abs(cursor.need_number("radius at its base"));
  const Eigen::Vector3d top = cursor.need_point("cap");
  const double top_radius = std::abs(cursor.need_number("radius at its cap"));
  return cone_between(base, base_radius, top, top_radius, cursor.take("open"));
}

PovSolid read_disc(PovCursor& cursor) {
  const Eigen::Vector3d middle = cursor.need_point("centre"), normal = cursor.need_point("normal");
  const double radius = std::abs(cursor.need_number("radius"));
  const double hole = std::abs(cursor.number().value_or(0.0));
  if (!(normal.stableNorm() > 0.0)) cursor.node().fail("has a normal without length");
  if (!(radius - hole > flatness * radius)) return {};
  return {.pieces = {{.shape = disc_about(middle, normal, radius, hole)}}, .is_closed = false};
}

PovSolid read_torus(PovCursor& cursor, Remarks& remarks) {
  const double major = cursor.need_number("major radius");
  const double minor = std::abs(cursor.need_number("minor radius"));
  if (!(major > 0.0 && minor > 0.0)) return {};
  remarks.add("Round shapes were read as facets of the same area with the normals of round ones",
              cursor.node().label());
  TorusLoops torus = torus_loops(major - minor, major + minor);
  // About y in place of z.
  const auto upright = [](std::vector<Loop>& loops) {
    for (Loop& loop : loops) {
      for (Eigen::Vector3d& p : loop) p = Eigen::Vector3d(p.y(), p.z(), p.x());
    }
  };
  upright(torus.loops);
  upright(torus.normals);
  return {.pieces = {{.shape = PovFacets{.loops = std::move(torus.loops),
                                         .normals = std::move(torus.normals)}}}};
}

}  // namespace

// The profile's points are (distance from the axis, height).
PovSolid read_pov_lathe(PovCursor& cursor) {
  PovCurve curve = cursor.node().keyword == "sor" ? PovCurve::squared_radius : PovCurve::linear;
  if (cursor.take("quadratic_spline")) curve = PovCurve::quadratic;
  if (cursor.take("cubic_spline")) curve = PovCurve::cubic;
  if (cursor.take("bezier_spline")) curve = PovCurve::bezier;
  cursor.take("linear_spline");
  const std::size_t count = cursor.need_count("number of points");
  std::vector<Eigen::Vector2d> given;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d p = cursor.need_point("profile");
    given.emplace_back(p.x(), p.y());
  }
  const bool is_open = cursor.take("open");
  std::vector<Eigen::Vector2d> profile = pov_profile(curve, given);
  for (Eigen::Vector2d& p : profile) p.x() = std::abs(p.x());
  if (curve == PovCurve::squared_radius && !is_open && !profile.empty()) {
    profile.insert(profile.begin(), {0.0, profile.front().y()});  // discs at both ends
    profile.emplace_back(0.0, profile.back().y());
  }
  PovSolid solid{.is_closed = false};
  if (profile.size() < 2) return solid;
  const auto is_on_axis = [](const Eigen::Vector2d& p) { return p.x() == 0.0; };
  solid.is_closed = profile.front() == profile.back() ||
                    (is_on_axis(profile.front()) && is_on_axis(profile.back()));
  // Twice the area between profile and axis, above 0 where the profile rises outside of the body.
  double turning = 0.0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Eigen::Vector2d& p = profile[i];
    const Eigen::Vector2d& q = profile[(i + 1) % profile.size()];
    turning += p.x() * q.y() - q.x() * p.y();
  }
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    Eigen::Vector2d p = profile[i], q = profile[i + 1];
    const bool is_level = p.y() == q.y();
    if (p.x() == q.x() && (is_level || p.x() == 0.0)) continue;
    const bool rises = is_level ? p.x() > q.x() : q.y() > p.y();
    const bool is_outside = rises == (turning > 0.0);
    if (is_level) {
      const auto [low, high] = std::minmax(p.x(), q.x());
      const Eigen::Vector3d up = is_outside ? Eigen::Vector3d(0, 1, 0) : Eigen::Vector3d(0, -1, 0);
      solid.pieces.push_back({.shape = disc_about({0.0, p.y(), 0.0}, up, high, low)});
    } else {
      if (q.y() < p.y()) std::swap(p, q);
      solid.pieces.push_back({.shape = frustum_about({0.0, p.y(), 0.0}, Eigen::Vector3d::UnitY(),
                                                     q.y() - p.y(), p.x(), q.x(), !is_outside)});
    }
  }
  return solid;
}

std::optional<PovSolid> read_pov_solid(PovCursor& cursor, Remarks& remarks) {
  const std::string_view keyword = cursor.node().keyword;
  if (keyword == "box") return read_box(cursor);
  if (keyword == "sphere") return read_sphere(cursor);
  if (keyword == "cylinder") return read_cylinder(cursor);
  if (keyword == "cone") return read_cone(cursor);
  if (keyword == "disc") return read_disc(cursor);
  if (keyword == "torus") return read_torus(cursor, remarks);
  if (keyword == "lathe" || keyword == "sor") return read_pov_lathe(cursor);
  if (keyword == "prism") return read_pov_prism(cursor);
  if (keyword == "polygon") return read_pov_polygon(cursor);
  if (keyword == "triangle" || keyword == "smooth_triangle") return read_pov_triangle(cursor);
  if (keyword == "mesh") return read_pov_mesh(cursor);
  if (keyword == "mesh2") return read_pov_mesh2(cursor);
  return std::nullopt;
}

}  // namespace lightwell
