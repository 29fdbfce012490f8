#include "raytrace/shading/lamp_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "radiosity/emitters/emitter_point.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// 1 - cos of the half angle of the cone that a sphere fills, seen from a distance above its radius,
// without cancellation.
double cone_height(const Sphere& sphere, double distance) {
  const double sine = sphere.radius / distance;
  return sine * sine / (1.0 + std::sqrt(std::max(0.0, 1.0 - sine * sine)));
}

}  // namespace

LampSamples::LampSamples(const DirectLight& direct_light) : emitters_(direct_light.emitters()) {
  double sum = 0.0;
  for (std::size_t e = 0; e < emitters_.size(); ++e) {
    share_.push_back(static_cast<double>(emitters_[e].exitance.sum()) * emitters_[e].area);
    cdf_.push_back(sum += share_.back());
    const auto facet = static_cast<std::size_t>(emitters_[e].facet);
    of_facet_.resize(std::max(of_facet_.size(), facet + 1), -1);
    of_facet_[facet] = static_cast<int>(e);
  }
  for (double& share : share_) share = sum > 0.0 ? share / sum : 0.0;
  for (double& share : cdf_) share = sum > 0.0 ? share / sum : 0.0;
}

double LampSamples::weight(std::size_t e, const Eigen::Vector3d& from) const {
  return share_[e] * approximate_kernel(emitters_[e], from);
}

double LampSamples::chance(std::size_t emitter, const Eigen::Vector3d& from) const {
  if (emitters_.size() == 1 || emitters_.size() > static_cast<std::size_t>(most_weighed)) {
    return share_[emitter];
  }
  double sum = 0.0, own = 0.0;
  for (std::size_t e = 0; e < emitters_.size(); ++e) {
    const double of_this = weight(e, from);
    sum += of_this;
    if (e == emitter) own = of_this;
  }
  return sum > 0.0 ? own / sum : 0.0;
}

std::size_t LampSamples::drawn(const Eigen::Vector3d& from, double which) const {
  if (emitters_.size() == 1 || emitters_.size() > static_cast<std::size_t>(most_weighed)) {
    return static_cast<std::size_t>(std::upper_bound(cdf_.begin(), cdf_.end() - 1, which) -
                                    cdf_.begin());
  }
  std::array<double, most_weighed> up_to;
  double sum = 0.0;
  for (std::size_t e = 0; e < emitters_.size(); ++e) up_to[e] = sum += weight(e, from);
  const auto last = up_to.begin() + static_cast<std::ptrdiff_t>(emitters_.size()) - 1;
  return static_cast<std::size_t>(std::upper_bound(up_to.begin(), last, which * sum) -
                                  up_to.begin());
}

std::optional<LampSample> LampSamples::draw(const Eigen::Vector3d& from, int facet, double which,
                                            double u, double v) const {
  if (emitters_.empty()) return std::nullopt;
  const std::size_t number = drawn(from, which);
  const Emitter& emitter = emitters_[number];
  const double share = chance(number, from);
  if (!(share > 0.0) || emitter.facet == facet) return std::nullopt;
  LampSample sample{.emitter = &emitter};
  if (emitter.is_sphere) {
    const Eigen::Vector3d to = emitter.sphere.center - from;
    const double distance = to.norm(), radius = emitter.sphere.radius;
    if (!(distance > radius)) return std::nullopt;
    const double cosine = 1.0 - u * cone_height(emitter.sphere, distance);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double phi = 2.0 * std::numbers::pi * v;
    Eigen::Vector3d a, b;
    const Eigen::Vector3d axis = to / distance;
    tangent_frame(axis, a, b);
    sample.direction = sine * (std::cos(phi) * a + std::sin(phi) * b) + cosine * axis;
    const double off = distance * sine;
    sample.distance = distance * cosine - std::sqrt(std::max(0.0, radius * radius - off * off));
  } else {
    const Eigen::Vector3d to = emitter_point(emitter, u, v) - from;
    sample.distance = to.norm();
    if (!(sample.distance > 0.0)) return std::nullopt;
    sample.direction = to / sample.distance;
    if (!emitter.emits_both_sides && !(sample.direction.dot(emitter.normal) < 0.0)) {
      return std::nullopt;
    }
  }
  sample.density = density_of(share, emitter, from, sample.direction, sample.distance);
  if (!(sample.density > 0.0) || !std::isfinite(sample.density)) return std::nullopt;
  return sample;
}

double LampSamples::density(const Eigen::Vector3d& from, const Eigen::Vector3d& point,
                            int facet) const {
  const auto f = static_cast<std::size_t>(facet);
  if (f >= of_facet_.size() || of_facet_[f] < 0) return 0.0;
  const Eigen::Vector3d to = point - from;
  const double distance = to.norm();
  if (!(distance > 0.0)) return 0.0;
  const auto e = static_cast<std::size_t>(of_facet_[f]);
  return density_of(chance(e, from), emitters_[e], from, to / distance, distance);
}

double LampSamples::density_of(double share, const Emitter& emitter, const Eigen::Vector3d& from,
                               const Eigen::Vector3d& direction, double distance) const {
  if (emitter.is_sphere) {
    const double to_center = (emitter.sphere.center - from).norm();
    if (!(to_center > emitter.sphere.radius)) return 0.0;
    return share / (2.0 * std::numbers::pi * cone_height(emitter.sphere, to_center));
  }
  const double cosine = std::abs(direction.dot(emitter.normal));
  return cosine > 0.0 ? share * distance * distance / (emitter.area * cosine) : 0.0;
}

}  // namespace lightwell
