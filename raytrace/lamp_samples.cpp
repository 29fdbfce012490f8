#include "raytrace/lamp_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiosity/emitter_point.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Of the cone a sphere fills seen from a distance above its radius, 1 - cos, without cancellation.
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

std::optional<LampSample> LampSamples::draw(const Eigen::Vector3d& from, int facet, double which,
                                            double u, double v) const {
  if (emitters_.empty()) return std::nullopt;
  const auto drawn = std::upper_bound(cdf_.begin(), cdf_.end() - 1, which) - cdf_.begin();
  const Emitter& emitter = emitters_[static_cast<std::size_t>(drawn)];
  if (!(share_[static_cast<std::size_t>(drawn)] > 0.0) || emitter.facet == facet) {
    return std::nullopt;
  }
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
  sample.density = density_of(emitter, from, sample.direction, sample.distance);
  if (!(sample.density > 0.0) || !std::isfinite(sample.density)) return std::nullopt;
  return sample;
}

double LampSamples::density(const Eigen::Vector3d& from, const Eigen::Vector3d& place,
                            int facet) const {
  const auto f = static_cast<std::size_t>(facet);
  if (f >= of_facet_.size() || of_facet_[f] < 0) return 0.0;
  const Eigen::Vector3d to = place - from;
  const double distance = to.norm();
  return distance > 0.0 ? density_of(emitters_[static_cast<std::size_t>(of_facet_[f])], from,
                                     to / distance, distance)
                        : 0.0;
}

double LampSamples::density_of(const Emitter& emitter, const Eigen::Vector3d& from,
                               const Eigen::Vector3d& direction, double distance) const {
  const double share = share_[static_cast<std::size_t>(&emitter - emitters_.data())];
  if (emitter.is_sphere) {
    const double to_center = (emitter.sphere.center - from).norm();
    if (!(to_center > emitter.sphere.radius)) return 0.0;
    return share / (2.0 * std::numbers::pi * cone_height(emitter.sphere, to_center));
  }
  const double cosine = std::abs(direction.dot(emitter.normal));
  return cosine > 0.0 ? share * distance * distance / (emitter.area * cosine) : 0.0;
}

}  // namespace lightwell
