#include "radiosity/visibility/shadow_rays.h"

#include <array>
#include <cmath>

#include "radiosity/visibility/absorbing_bodies.h"

namespace lightwell {

Spectrum ShadowMedium::passed(const ElementCaster& caster, const Ray& ray, bool is_blocked) const {
  const Eigen::Index bands = absorption ? absorption->size() : 0;
  Spectrum share = is_blocked && !panes ? Spectrum(Spectrum::Zero(bands))
                   : is_blocked         ? panes->passed(caster, ray)
                                        : Spectrum(Spectrum::Ones(bands));
  // A ray without an end leaves the scene, and no body is as large.
  if (absorption && std::isfinite(ray.t_max)) {
    share *= left_after(*absorption, ray.t_max * ray.direction.norm());
  }
  return share;
}

void ShadowBatch::add(int tally, const ShadowSample& sample) {
  if (!(sample.weight > 0.0)) return;
  rays_.push_back(sample.ray);
  waiting_.push_back({.weight = sample.weight, .exitance = sample.exitance, .tally = tally});
  if (rays_.size() == most) flush();
}

void ShadowBatch::flush() {
  std::array<std::uint8_t, most> blocked;
  caster_.occluded(rays_, {blocked.data(), rays_.size()});
  for (std::size_t k = 0; k < rays_.size(); ++k) {
    const auto& [weight, exitance, number] = waiting_[k];
    ShadowTally& tally = tallies_[static_cast<std::size_t>(number)];
    tally.all += weight;
    tally.squares += weight * weight;
    if (exitance) tally.pictured += weight * exitance->cast<double>();
    const bool is_blocked = blocked[k] != 0;
    if (!is_blocked && !medium_.absorbs()) {
      tally.seen += weight;
      if (exitance) tally.pictured_seen += weight * exitance->cast<double>();
    } else if (medium_.absorbs() || medium_.panes) {
      add_dimmed(rays_[k], waiting_[k], is_blocked, tally);
    }
  }
  rays_.clear();
  waiting_.clear();
}

void ShadowBatch::add_dimmed(const Ray& ray, const Waiting& of_ray, bool is_blocked,
                             ShadowTally& tally) const {
  Spectrum share = medium_.passed(caster_, ray, is_blocked);
  if (!(share > 0.0f).any()) {
    tally.blocked = true;
    return;
  }
  tally.dimmed += of_ray.weight;
  if (of_ray.exitance) share.head<3>() *= *of_ray.exitance;
  if (tally.through.size() == 0) tally.through = Spectrum::Zero(share.size());
  tally.through += static_cast<float>(of_ray.weight) * share;
}

}  // namespace lightwell
