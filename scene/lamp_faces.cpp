#include "scene/lamp_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace lightwell {
namespace {

constexpr double least_share = 0.05;  // of the light, of a side that shines

/// An ellipse or a rectangle of full sizes x, y about the axis, `away` behind the opening.
std::vector<Eigen::Vector3d> outline(const Lamp& lamp, double size_x, double size_y, bool is_round,
                                     double away) {
  const auto at = [&](double x, double y) {
    return Eigen::Vector3d(lamp.position + 0.5 * size_x * x * lamp.axes.col(0) +
                           0.5 * size_y * y * lamp.axes.col(1) + away * lamp.axes.col(2));
  };
  if (!is_round) return {at(1, 1), at(-1, 1), at(-1, -1), at(1, -1)};
  constexpr int sides = 48;
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < sides; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / sides;
    corners.push_back(at(std::cos(turn), std::sin(turn)));
  }
  return corners;
}

/// Share of a lamp's light that leaves to the side of gamma = 0.
double share_ahead(const Lamp& lamp) {
  double ahead = 0.0, behind = 0.0;
  constexpr int rows = 180, columns = 72;
  for (int i = 0; i < rows; ++i) {
    const double gamma = (i + 0.5) * std::numbers::pi / rows;
    double sum = 0.0;
    for (int k = 0; k < columns; ++k) {
      const double c = (k + 0.5) * 2.0 * std::numbers::pi / columns;
      const Eigen::Vector3d way(std::sin(gamma) * std::cos(c), std::sin(gamma) * std::sin(c),
                                -std::cos(gamma));
      sum += relative_intensity(lamp, lamp.axes * way);
    }
    (2 * i < rows ? ahead : behind) += sum * std::sin(gamma);
  }
  // A narrower beam than the steps can be missed whole; beams point ahead.
  return ahead + behind > 0.0 ? ahead / (ahead + behind) : 1.0;
}

double opening_area(const LampOpening& opening) {
  return opening.along_c0 * opening.along_c90 * (opening.is_round ? 0.25 * std::numbers::pi : 1.0);
}

void add_body(const Lamp& lamp, const BodyEnds& ends, std::vector<LampFace>& faces) {
  const LampBody& body = lamp.body;
  const auto end_at = [&](double away) {
    return outline(lamp, body.along_c0, body.along_c90, body.is_round, away);
  };
  std::vector<Eigen::Vector3d> low = end_at(ends.low), high = end_at(ends.high);
  const std::size_t count = low.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    faces.push_back({.outline = {low[i], low[next], high[next], high[i]}});
  }
  // Outlines run counter-clockwise seen from behind the lamp.
  std::ranges::reverse(low);
  faces.push_back({.outline = std::move(low)});
  faces.push_back({.outline = std::move(high)});
}

}  // namespace

std::vector<Eigen::Vector3d> opening_outline(const Lamp& lamp, double place) {
  const LampOpening& opening = lamp.opening;
  return outline(lamp, opening.along_c0, opening.along_c90, opening.is_round, place);
}

double luminous_area(const LampOpening& opening, double height, const Eigen::Vector3d& way) {
  const double across = opening.along_c0 * way.y(), along = opening.along_c90 * way.x();
  const double width =
      opening.is_round ? std::hypot(across, along) : std::abs(across) + std::abs(along);
  return opening_area(opening) * std::abs(way.z()) + height * width;
}

BodyEnds body_ends(const Lamp& lamp) {
  if (!lamp.body.is_known()) return {};
  const double height = lamp.body.height, ahead = share_ahead(lamp);
  if (ahead > 1.0 - least_share) return {.low = 0.0, .high = height};
  if (ahead < least_share) return {.low = -height, .high = 0.0};
  return {.low = -0.5 * height, .high = 0.5 * height};
}

std::vector<LampFace> lamp_faces(const Lamp& lamp, const BodyEnds& ends) {
  std::vector<LampFace> faces;
  if (!lamp.visible) return faces;
  if (ends.high > ends.low) add_body(lamp, ends, faces);
  const double area = opening_area(lamp.opening);
  if (!(area > 0.0)) return faces;
  const double ahead = share_ahead(lamp), flux = relative_flux(lamp);
  const double narrower = std::min(lamp.opening.along_c0, lamp.opening.along_c90);
  const double before = std::min(0.002, 0.01 * narrower);  // of the body, and of a ceiling
  const auto add = [&](double share, double place, bool is_ahead) {
    if (share < least_share) return;
    std::vector<Eigen::Vector3d> corners =
        opening_outline(lamp, is_ahead ? place - before : place + before);
    if (is_ahead) std::ranges::reverse(corners);
    faces.push_back({.outline = std::move(corners),
                     .shine = share * flux / (std::numbers::pi * area),
                     .place = place});
  };
  add(ahead, ends.low, true);
  add(1.0 - ahead, ends.high, false);
  return faces;
}

}  // namespace lightwell
