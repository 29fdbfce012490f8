#include "viewer/window/walk_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace lightwell {
namespace {

constexpr int around = 16, below = 8;  ///< rays around the body; rays down, beside the middle one
constexpr int fan = 12;      ///< half of the steps across the fan ahead, which has 2 fan - 1 rays
constexpr int uprights = 6;  ///< steps in a quarter circle of upright rays, 2 uprights + 1 in all
constexpr int most_pushes = 6;
/// Level part of the unit normal from which a surface is a wall, not a slope.
constexpr double steep = 0.7;
constexpr double moment = 1.0 / 120.0;  ///< s, time step of gravity
constexpr double step_seconds = 0.06;   ///< s, time constant with which the eye follows a step
constexpr double ring_share = 0.7;      ///< radius of the ring of rays down, over the body's
constexpr double slack = 1e-3;          ///< overlap that counts as touching, over the radius
constexpr double board = 0.02;          ///< half of the thinnest detected board, over the radius

}  // namespace

WalkBody walk_body(const Bounds& bounds, const Eigen::Vector3d& up_axis, double eye_height) {
  constexpr double room_height = 2.5, room_diagonal = 7.0;  ///< m
  WalkBody body;
  const double height = std::abs((bounds.high - bounds.low).dot(up_axis));
  const double scale =
      eye_height > 0.0
          ? eye_height / body.eye_height
          : std::min(1.0, std::max(height / room_height, bounds.diagonal() / room_diagonal));
  for (double* length : {&body.eye_height, &body.radius, &body.step, &body.above_eye,
                         &body.jump_height, &body.gravity}) {
    *length *= scale;
  }
  return body;
}

WalkPhysics::WalkPhysics(const WalkBody& body, const Eigen::Vector3d& up_axis)
    : body_(body), up_(up_axis), a_(up_axis.unitOrthogonal()), b_(up_axis.cross(a_)) {}

namespace {

/// Returns the level part of a wall's normal, unit; nothing for floors, slopes and a miss.
std::optional<Eigen::Vector3d> wall_normal(const Obstacles& obstacles, const VisibleHit& seen,
                                           const Eigen::Vector3d& up) {
  if (!seen) return std::nullopt;
  const Eigen::Vector3d n = element_center(obstacles.caster.mesh(), seen.hit.element).normal;
  const Eigen::Vector3d level = n - n.dot(up) * up;
  if (level.norm() < steep) return std::nullopt;
  return level.normalized();
}

}  // namespace

// Distances below the eye of the level rays, m: five from the knee to the head, and for each
// obstacle that juts out ahead, a height just above its underside.
std::vector<double> WalkPhysics::heights(const Obstacles& obstacles, const Eigen::Vector3d& eye,
                                         const Eigen::Vector3d& ahead) const {
  const double knee = body_.eye_height - 1.05 * body_.step;
  std::vector<double> drops = {knee, 0.6 * body_.eye_height, 0.3 * body_.eye_height, 0.0,
                               -body_.above_eye};
  std::vector<Ray> rays;
  const Eigen::Vector3d aside = up_.cross(ahead);
  for (int i = -uprights; i <= uprights; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / uprights;
    const Eigen::Vector3d at = std::cos(angle) * ahead + std::sin(angle) * aside;
    rays.push_back({.origin = eye - knee * up_ + (1.0 - slack) * body_.radius * at,
                    .direction = up_,
                    .t_max = knee + body_.above_eye});
  }
  for (const VisibleHit& seen :
       visible_hits(obstacles.caster, obstacles.kinds, rays, obstacles.options)) {
    if (seen) drops.push_back((eye - seen.position).dot(up_) - board * body_.radius);
  }
  return drops;
}

// The deepest overlap with the walls around the body, each taken as a plane.
WalkPhysics::Contact WalkPhysics::deepest_around(const Obstacles& obstacles,
                                                 const Eigen::Vector3d& eye,
                                                 const std::vector<double>& drops) const {
  std::vector<Ray> rays;
  for (const double drop : drops) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / around;
      rays.push_back({.origin = eye - drop * up_,
                      .direction = std::cos(angle) * a_ + std::sin(angle) * b_,
                      .t_max = body_.radius});
    }
  }
  const std::vector<VisibleHit> seen =
      visible_hits(obstacles.caster, obstacles.kinds, rays, obstacles.options);
  Contact deepest{.depth = slack * body_.radius};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto wall = wall_normal(obstacles, seen[i], up_);
    if (!wall) continue;
    const double depth = body_.radius + seen[i].distance * rays[i].direction.dot(*wall);
    if (depth > deepest.depth) deepest = {depth, *wall};
  }
  return deepest;
}

// The deepest overlap with the points that the fan of rays hits ahead. The body is a cylinder here.
WalkPhysics::Contact WalkPhysics::deepest_ahead(const Obstacles& obstacles,
                                                const Eigen::Vector3d& eye,
                                                const std::vector<double>& drops,
                                                const Eigen::Vector3d& ahead) const {
  const Eigen::Vector3d aside = up_.cross(ahead);
  std::vector<Ray> rays;
  for (const double drop : drops) {
    for (int i = 1 - fan; i < fan; ++i) {
      const double share = static_cast<double>(i) / fan;
      rays.push_back({.origin = eye - drop * up_ + share * body_.radius * aside,
                      .direction = ahead,
                      .t_max = std::sqrt(1.0 - share * share) * body_.radius});
    }
  }
  const std::vector<VisibleHit> seen =
      visible_hits(obstacles.caster, obstacles.kinds, rays, obstacles.options);
  Contact deepest{.depth = slack * body_.radius};
  for (const VisibleHit& met : seen) {
    const auto wall = wall_normal(obstacles, met, up_);
    if (!wall) continue;
    const Eigen::Vector3d from = eye - met.position, level = from - from.dot(up_) * up_;
    const double distance = level.norm();
    if (!(body_.radius - distance > deepest.depth)) continue;
    // For a point on the body's axis, the wall's normal gives the direction.
    deepest = {body_.radius - distance, distance > slack * body_.radius ? level / distance : *wall};
  }
  return deepest;
}

// Pushes the eye out of obstacles nearer than the radius, the deepest first. False if most_pushes
// do not suffice.
bool WalkPhysics::push_out(const Obstacles& obstacles, Eigen::Vector3d& eye,
                           const Eigen::Vector3d& way) const {
  const bool goes = way.norm() > 0.0;
  const Eigen::Vector3d ahead = goes ? Eigen::Vector3d(way.normalized()) : a_;
  for (int push = 0; push < most_pushes; ++push) {
    const std::vector<double> drops = heights(obstacles, eye, ahead);
    Contact contact = deepest_around(obstacles, eye, drops);
    if (goes) {
      const Contact met = deepest_ahead(obstacles, eye, drops, ahead);
      if (met.depth > contact.depth) contact = met;
    }
    if (contact.out.isZero(0.0)) return true;
    eye += contact.depth * contact.out;
  }
  return false;
}

Eigen::Vector3d WalkPhysics::move(const Obstacles& obstacles, const Eigen::Vector3d& eye,
                                  const Eigen::Vector3d& way) const {
  // Steps of half a radius cannot cross an obstacle from which the body stays a radius away.
  const int pieces = std::max(1, static_cast<int>(std::ceil(way.norm() / (0.5 * body_.radius))));
  Eigen::Vector3d at = eye;
  for (int i = 0; i < pieces; ++i) {
    Eigen::Vector3d next = at + way / pieces;
    if (!push_out(obstacles, next, way)) break;
    at = next;
  }
  return at;
}

Eigen::Vector3d WalkPhysics::settle(const Obstacles& obstacles, const Eigen::Vector3d& eye,
                                    double seconds) {
  Eigen::Vector3d at = eye;
  for (double left = seconds; left > 0.0; left -= moment) {
    at = settle_a_moment(obstacles, at, std::min(left, moment));
  }
  return at;
}

Eigen::Vector3d WalkPhysics::settle_a_moment(const Obstacles& obstacles, const Eigen::Vector3d& eye,
                                             double seconds) {
  const Eigen::Vector3d knee = eye - (body_.eye_height - body_.step) * up_;
  std::vector<Ray> rays = {{.origin = knee, .direction = -up_}};
  for (int i = 0; i < below; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / below;
    rays.push_back(
        {.origin = knee + ring_share * body_.radius * (std::cos(angle) * a_ + std::sin(angle) * b_),
         .direction = -up_});
  }
  rays.push_back({.origin = eye, .direction = up_});
  const std::vector<VisibleHit> seen =
      visible_hits(obstacles.caster, obstacles.kinds, rays, obstacles.options);
  std::optional<double> ground;  // m above the feet
  for (std::size_t i = 0; i + 1 < seen.size(); ++i) {
    if (!seen[i]) continue;
    ground = std::max(ground.value_or(-1e300), body_.step - seen[i].distance);
  }
  if (!ground) {
    rising_ = 0.0;
    on_ground_ = true;
    return eye;
  }
  // The feet follow steps down too, except in a jump.
  if (rising_ <= 0.0 && *ground >= (on_ground_ ? -body_.step : 0.0)) {
    on_ground_ = true;
    rising_ = 0.0;
    return eye + *ground * (1.0 - std::exp(-seconds / step_seconds)) * up_;
  }
  on_ground_ = false;
  const double before = rising_;
  rising_ -= body_.gravity * seconds;
  double rise = 0.5 * (before + rising_) * seconds;
  const double headroom = seen.back() ? seen.back().distance - body_.above_eye : 1e300;
  if (rise > headroom) {
    rise = std::max(headroom, 0.0);
    rising_ = 0.0;
  }
  return eye + std::max(rise, *ground) * up_;
}

void WalkPhysics::jump() {
  if (!on_ground_) return;
  on_ground_ = false;
  rising_ = std::sqrt(2.0 * body_.gravity * body_.jump_height);
}

}  // namespace lightwell
