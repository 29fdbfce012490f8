#include "raytrace/shading/lamp_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiosity/emitters/emitter_point.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// 1 - cos of the half angle of the cone that a sphere fills, seen from a distance above its radius,
// without cancellation.
double cone_height(const Sphere& sphere, double distance) {
  const double sine = sphere.radius / distance;
  return sine * sine / (1.0 + std::sqrt(std::max(0.0, 1.0 - sine * sine)));
}

}  // namespace

LobeView::LobeView(const Vector3d& position, const SurfaceInteraction& interaction,
                   const RoughLobe& lobe)
    : position_(position),
      interaction_(interaction),
      lobe_(lobe),
      smooth_(smooth_scattering(interaction)) {}

// The greatest density over the directions off a smooth surface, each turned into a cone about
// `direction` of this sine of the half angle. The even share draws lights that the turned direction
// misjudges, and costs as many of a hundred draws.
double LobeView::density_about(const Vector3d& direction, double sine) const {
  constexpr double even_share = 0.02, even = even_share / (4.0 * std::numbers::pi);
  const double cosine = std::sqrt(1.0 - sine * sine);
  double greatest = 0.0;
  for (int i = 0; i < smooth_.count; ++i) {
    const Vector3d& peak = smooth_.sample[static_cast<std::size_t>(i)].direction;
    const double between = peak.dot(direction);
    Vector3d nearest = peak;
    if (between < cosine) {
      const Vector3d across = peak - between * direction;
      const double length = across.norm();
      nearest = length > 0.0 ? Vector3d(cosine * direction + sine / length * across) : direction;
    }
    greatest = std::max(greatest, lobe_.density(interaction_, nearest));
  }
  return greatest + even;
}

double LobeView::weight(const LightNode& node) const {
  const double I = greatest_intensity(node, position_);
  if (!(I > 0.0)) return 0.0;
  const Vector3d to = node.middle - position_;
  const double distance = to.norm(), away = std::max(distance, node.radius);
  if (!(away > 0.0)) return 0.0;
  // A point within the ball sees lights in all directions.
  const bool is_within = !(distance > node.radius);
  const double density = is_within ? density_about(smooth_.sample[0].direction, 0.0)
                                   : density_about(to / distance, node.radius / distance);
  return I * density / (away * away);
}

double LobeView::weight(double irradiance, const Vector3d& direction) const {
  return irradiance > 0.0 ? irradiance * density_about(direction, 0.0) : 0.0;
}

LampSamples::LampSamples(const DirectLight& direct_light)
    : emitters_(direct_light.emitters()), sources_(direct_light.free_sources()) {
  for (std::size_t e = 0; e < emitters_.size(); ++e) {
    const auto facet = static_cast<std::size_t>(emitters_[e].facet);
    of_facet_.resize(std::max(of_facet_.size(), facet + 1), -1);
    of_facet_[facet] = static_cast<int>(e);
  }
  if (std::vector<LightBound> bounds = bounds_of(emitters_); !bounds.empty()) {
    tree_.emplace(std::move(bounds));
  }
  if (std::vector<LightBound> bounds = bounds_of(sources_, 0); !bounds.empty()) {
    tree_of_lamps_.emplace(std::move(bounds));
  }
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    if (sources_[s].is_distant() && !sources_[s].is_dome() && sources_[s].is_on()) {
      distant_.push_back(static_cast<int>(s));
    }
  }
}

std::optional<DrawnSource> LampSamples::draw_source(const LobeView& from, double which) const {
  const auto weight = [&from](const LightNode& node) { return from.weight(node); };
  const double of_lamps = tree_of_lamps_ ? weight(tree_of_lamps_->node(0)) : 0.0;
  std::vector<double> up_to;
  double sum = of_lamps;
  for (const int s : distant_) {
    // The sun has the same irradiance across all of its directions.
    const SourceSample middle = sample_source(sources_[s], from.position(), 0.5, 0.5);
    up_to.push_back(sum +=
                    from.weight(middle.irradiance * sources_[s].light.mean(), middle.direction));
  }
  if (!(sum > 0.0)) return std::nullopt;
  const double at = which * sum;
  if (at < of_lamps || up_to.empty()) {
    const auto draw = tree_of_lamps_->draw_by(0, at / of_lamps, weight);
    if (draw.light < 0) return std::nullopt;
    return DrawnSource{&sources_[draw.light], draw.chance * of_lamps / sum};
  }
  const auto i = static_cast<std::size_t>(std::upper_bound(up_to.begin(), up_to.end() - 1, at) -
                                          up_to.begin());
  const double chance = (up_to[i] - (i > 0 ? up_to[i - 1] : of_lamps)) / sum;
  if (!(chance > 0.0)) return std::nullopt;
  return DrawnSource{&sources_[distant_[i]], chance};
}

std::optional<LampSample> LampSamples::draw(const LobeView& view, int facet, double which, double u,
                                            double v) const {
  if (!tree_) return std::nullopt;
  const auto drawn =
      tree_->draw_by(0, which, [&view](const LightNode& node) { return view.weight(node); });
  if (drawn.light < 0) return std::nullopt;
  const Emitter& emitter = emitters_[drawn.light];
  if (emitter.facet == facet) return std::nullopt;
  const Vector3d& from = view.position();
  LampSample sample{.emitter = &emitter};
  if (emitter.is_sphere) {
    const Vector3d to = emitter.sphere.center - from;
    const double distance = to.norm(), radius = emitter.sphere.radius;
    if (!(distance > radius)) return std::nullopt;
    const double cosine = 1.0 - u * cone_height(emitter.sphere, distance);
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double phi = 2.0 * std::numbers::pi * v;
    Vector3d a, b;
    const Vector3d axis = to / distance;
    tangent_frame(axis, a, b);
    sample.direction = sine * (std::cos(phi) * a + std::sin(phi) * b) + cosine * axis;
    const double off = distance * sine;
    sample.distance = distance * cosine - std::sqrt(std::max(0.0, radius * radius - off * off));
  } else {
    const Vector3d to = emitter_point(emitter, u, v) - from;
    sample.distance = to.norm();
    if (!(sample.distance > 0.0)) return std::nullopt;
    sample.direction = to / sample.distance;
    if (!emitter.emits_both_sides && !(sample.direction.dot(emitter.normal) < 0.0)) {
      return std::nullopt;
    }
  }
  sample.density = density_of(drawn.chance, emitter, from, sample.direction, sample.distance);
  if (!(sample.density > 0.0) || !std::isfinite(sample.density)) return std::nullopt;
  return sample;
}

double LampSamples::density(const LobeView& view, const Vector3d& point, int facet) const {
  const auto f = static_cast<std::size_t>(facet);
  if (!tree_ || f >= of_facet_.size() || of_facet_[f] < 0) return 0.0;
  const Vector3d to = point - view.position();
  const double distance = to.norm();
  if (!(distance > 0.0)) return 0.0;
  const double chance =
      tree_->chance_by(of_facet_[f], [&view](const LightNode& node) { return view.weight(node); });
  return density_of(chance, emitters_[of_facet_[f]], view.position(), to / distance, distance);
}

double LampSamples::density_of(double share, const Emitter& emitter, const Vector3d& from,
                               const Vector3d& direction, double distance) const {
  if (emitter.is_sphere) {
    const double to_center = (emitter.sphere.center - from).norm();
    if (!(to_center > emitter.sphere.radius)) return 0.0;
    return share / (2.0 * std::numbers::pi * cone_height(emitter.sphere, to_center));
  }
  const double cosine = std::abs(direction.dot(emitter.normal));
  return cosine > 0.0 ? share * distance * distance / (emitter.area * cosine) : 0.0;
}

}  // namespace lightwell
