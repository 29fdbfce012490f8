#include "scene/io/radiance/radiance_lamps.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "scene/degree.h"
#include "scene/io/convex_cut.h"
#include "scene/io/radiance/text/radiance_bands.h"

namespace lightwell {
namespace {

using std::numbers::pi;

Eigen::Vector3d longest_edge(const Loop& corners) {
  Eigen::Vector3d longest = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d edge = corners[(i + 1) % corners.size()] - corners[i];
    if (edge.norm() > longest.norm() * (1.0 + 1e-9)) longest = edge;
  }
  return longest;
}

// Half the angle of a spotlight's beam, radians.
double half_beam(const RadiancePrimitive& spotlight) {
  const double angle = spotlight.reals[3];
  if (!(angle > 0.0)) spotlight.fail(fmt::format("has a beam of {} degrees", angle));
  return 0.5 * std::min(angle, 360.0) * degree;
}

std::vector<double> steps(double last, double step) {
  std::vector<double> result;
  for (int i = 0; i * step < last - 1e-6; ++i) result.push_back(i * step);
  return result;
}

}  // namespace

std::optional<RadianceLamps::Face> RadianceLamps::face_of(const RadiancePrimitive& p) {
  Face face;
  if (p.type == "polygon") {
    Loop corners;
    for (std::size_t i = 0; i + 2 < p.reals.size(); i += 3) corners.push_back(p.point(i));
    const Eigen::Vector3d normal = area_vector(corners);
    face.area = normal.norm();
    if (!(face.area > 0.0)) return std::nullopt;
    face.aim = normal.normalized();
    face.along = longest_edge(corners).normalized();
    // A rectangle of the polygon's area and of the proportions of its bounds.
    const Eigen::Vector3d beside = face.aim.cross(face.along);
    Eigen::AlignedBox2d bounds;
    for (const auto& c : corners) bounds.extend(Eigen::Vector2d(c.dot(face.along), c.dot(beside)));
    const double shrink = std::sqrt(face.area / bounds.volume());
    face.opening = {.along_c0 = bounds.sizes()[0] * shrink,
                    .along_c90 = bounds.sizes()[1] * shrink};
    face.middle = bounds.center()[0] * face.along + bounds.center()[1] * beside +
                  corners.front().dot(face.aim) * face.aim;
    return face;
  }
  if (p.type == "ring") {
    p.require_reals(8);
    const double inner = std::min(p.reals[6], p.reals[7]), outer = std::max(p.reals[6], p.reals[7]);
    const Eigen::Vector3d normal = p.point(3);
    if (!(inner >= 0.0 && outer > inner) || !(normal.stableNorm() > 0.0)) return std::nullopt;
    face.middle = p.point(0);
    face.aim = normal.stableNormalized();
    face.along = face.aim.unitOrthogonal();
    face.area = pi * (outer * outer - inner * inner);
    face.opening = {.along_c0 = 2.0 * outer, .along_c90 = 2.0 * outer, .is_round = true};
    return face;
  }
  if (p.type == "cylinder") {
    p.require_reals(7);
    const Eigen::Vector3d axis = p.point(3) - p.point(0);
    const double radius = std::abs(p.reals[6]), length = axis.stableNorm();
    if (!(radius > 0.0 && length > 0.0)) return std::nullopt;
    face.shape = Face::Shape::cylinder;
    face.middle = 0.5 * (p.point(0) + p.point(3));
    face.aim = axis / length;
    face.along = face.aim.unitOrthogonal();
    face.area = 2.0 * radius * length;
    face.opening = {.along_c0 = 2.0 * radius, .along_c90 = 2.0 * radius, .is_round = true};
    return face;
  }
  if (p.type != "sphere" && p.type != "bubble") return std::nullopt;
  p.require_reals(4);
  const double radius = std::abs(p.reals[3]);
  if (!(radius > 0.0)) return std::nullopt;
  face.shape = Face::Shape::sphere;
  face.middle = p.point(0);
  face.aim = -Eigen::Vector3d::UnitZ();
  face.along = Eigen::Vector3d::UnitX();
  face.area = pi * radius * radius;
  face.opening = {.along_c0 = 2.0 * radius, .along_c90 = 2.0 * radius, .is_round = true};
  return face;
}

double RadianceLamps::Face::seen_from(const Eigen::Vector3d& direction) const {
  if (shape == Shape::sphere) return 1.0;
  if (shape == Shape::cylinder) return direction.cross(aim).norm();
  return direction.dot(aim);
}

// Values are m^2 times the factor of the light: W/sr for each unit of the light's colour.
SharedWeb RadianceLamps::web_of(const RadianceLight& light, const Face& face,
                                const Eigen::Matrix3d& axes) {
  const RadiancePrimitive& material = light.material;
  const bool is_spot = material.type == "spotlight";
  double last = face.shape == Face::Shape::plane ? 90.0 : 180.0;
  if (is_spot) last = std::min(last, half_beam(material) / degree);
  const Eigen::Vector3d normal = axes.transpose() * face.aim;
  // Rounded, so that lamps of one kind share a table however they are turned.
  const auto rounded = [](double x) { return std::llround(1e6 * x); };
  std::string key =
      fmt::format("{} {} {:.9g}", static_cast<int>(face.shape), rounded(last), face.area);
  for (const double x : normal) key += fmt::format(" {}", rounded(x));
  for (const DirectionPattern* pattern : light.patterns) {
    const Eigen::Matrix3d turn = pattern->turn().transpose() * axes;
    for (const double x : turn.reshaped()) key += fmt::format(" {}", rounded(x));
    key += pattern->key();
  }
  const auto known = std::ranges::find(known_, key, &Known::light);
  if (known != known_.end()) return known->web;

  constexpr double step = 1.0, plane_step = 5.0;  // degrees; files of luminaires have 2.5 and 15
  std::vector<double> gammas = steps(last, step);
  gammas.push_back(last);
  const std::vector<double> planes = light.patterns.empty() && face.aim.isApprox(-axes.col(2), 1e-9)
                                         ? std::vector<double>{0.0}
                                         : steps(360.0, plane_step);
  Eigen::ArrayXXd values(planes.size(), gammas.size());
  for (std::size_t c = 0; c < planes.size(); ++c) {
    for (std::size_t g = 0; g < gammas.size(); ++g) {
      const double gamma = gammas[g] * degree, plane = planes[c] * degree;
      const Eigen::Vector3d out =
          axes * Eigen::Vector3d(std::sin(gamma) * std::cos(plane),
                                 std::sin(gamma) * std::sin(plane), -std::cos(gamma));
      const double seen = face.seen_from(out);
      constexpr double grazing = 1e-6;  // a pattern may divide by the cosine
      double value = 0.0;
      if (seen > -grazing) {
        Spectrum factor = Spectrum::Ones(3);
        for (const DirectionPattern* pattern : light.patterns) {
          factor *= pattern->factor(-out, std::max(seen, grazing));
        }
        value = radiance_luminance(factor) * face.area * std::max(seen, grazing);
      }
      values(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(g)) = value;
    }
  }
  auto web = std::make_shared<const PhotometricWeb>(planes, std::move(gammas), values);
  known_.push_back({std::move(key), web});
  return web;
}

bool RadianceLamps::add(const RadiancePrimitive& surface, const RadianceLight& light) {
  const bool is_spot = light.material.type == "spotlight";
  if (!is_spot && light.patterns.empty()) return false;
  const auto face = face_of(surface);
  if (!face) return false;
  Eigen::Vector3d aim = face->aim;
  if (is_spot) {
    aim = light.material.point(4);
    if (!(aim.stableNorm() > 0.0)) light.material.fail("has a beam without direction");
    aim.stableNormalize();
  }
  Lamp lamp{.name = names_.unique(surface.name),
            .position = face->middle,
            .axes = lamp_axes(aim, face->along),
            .intensity = light.color,
            .opening = face->opening};
  lamp.shape = web_of(light, *face, lamp.axes);
  if (!(light.color > 0.0f).any()) return true;  // a lamp that is switched off
  if (light.material.type == "illum") illums_.push_back(scene_.lamps.size());
  scene_.lamps.push_back(std::move(lamp));
  return true;
}

void RadianceLamps::remove_illums() {
  for (auto i = illums_.rbegin(); i != illums_.rend(); ++i) {
    scene_.lamps.erase(scene_.lamps.begin() + static_cast<std::ptrdiff_t>(*i));
  }
  illums_.clear();
}

}  // namespace lightwell
