#include "radiosity/visibility/shadow_rays.h"

#include <array>

namespace lightwell {

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
    if (!blocked[k]) {
      tally.seen += weight;
      if (exitance) tally.pictured_seen += weight * exitance->cast<double>();
    } else if (panes_) {
      add_through_panes(rays_[k], waiting_[k], tally);
    }
  }
  rays_.clear();
  waiting_.clear();
}

void ShadowBatch::add_through_panes(const Ray& ray, const Waiting& of_ray,
                                    ShadowTally& tally) const {
  Spectrum share = panes_->passed(caster_, ray);
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
