#include "viewer/window/walk_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace lightwell {
namespace {

constexpr int around = 16, below = 8;
constexpr int fan = 12;      ///< rays of each half of the fan ahead, and one in the middle
constexpr int uprights = 6;  ///< the same of the half circle of upright rays
constexpr int most_pushes = 6;
/// Tilt from which a surface is a wall and not a slope: the level share of its normal.
constexpr double steep = 0.7;
constexpr double moment = 1.0 / 120.0;  ///< s
constexpr double step_seconds = 0.06;   ///< tau with which a step is taken
constexpr double ring_share = 0.7;      ///< of the radius: where feet look for ground
constexpr double slack = 1e-3;          ///< of the radius, that counts as touching
constexpr double board = 0.02;          ///< of the radius: half of the thinnest board that is felt

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

/// What is met of a wall, as an outwards level direction; nothing of floors and slopes.
std::optional<Eigen::Vector3d> wall_normal(const Obstacles& obstacles, const VisibleHit& seen,
                                           const Eigen::Vector3d& up) {
  if (!seen) return std::nullopt;
  const Eigen::Vector3d n = element_center(obstacles.caster.mesh(), seen.hit.element).normal;
  const Eigen::Vector3d level = n - n.dot(up) * up;
  if (level.norm() < steep) return std::nullopt;
  return level.normalized();
}

}  // namespace

// How far below the eye level rays go out: five heights from the knee to the head, and a hair above
// the underside of what juts out between them.
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

// Of the walls around, as planes.
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

// Of what the fan of rays meets on the way, as points: the body is round there.
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
    // What is met in the very middle is left by the way it faces.
    deepest = {body_.radius - distance, distance > slack * body_.radius ? level / distance : *wall};
  }
  return deepest;
}

// Out of what is nearer than the radius, by the deepest first. False if that leads nowhere.
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
  // Half a radius at a time never crosses what the body keeps a radius away from.
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
  std::optional<double> ground;  // above the feet
  for (std::size_t i = 0; i + 1 < seen.size(); ++i) {
    if (!seen[i]) continue;
    ground = std::max(ground.value_or(-1e300), body_.step - seen[i].distance);
  }
  if (!ground) {
    rising_ = 0.0;
    on_ground_ = true;
    return eye;
  }
  // Feet stay on steps going down too, unless they have just left the ground in a jump.
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
