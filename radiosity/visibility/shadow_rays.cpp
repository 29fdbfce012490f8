#include "radiosity/visibility/shadow_rays.h"

namespace lightwell {

void ShadowBatch::add(int tally, const ShadowSample& sample) {
  if (!(sample.weight > 0.0)) return;
  rays_[count_] = sample.ray;
  weights_[count_] = sample.weight;
  exitances_[count_] = sample.exitance;
  tally_of_[count_] = tally;
  if (++count_ == size) flush();
}

void ShadowBatch::flush() {
  std::array<std::uint8_t, size> blocked;
  caster_.occluded({rays_.data(), count_}, {blocked.data(), count_});
  for (std::size_t k = 0; k < count_; ++k) {
    ShadowTally& tally = tallies_[static_cast<std::size_t>(tally_of_[k])];
    tally.all += weights_[k];
    tally.squares += weights_[k] * weights_[k];
    if (exitances_[k]) tally.pictured += weights_[k] * exitances_[k]->cast<double>();
    if (!blocked[k]) {
      tally.seen += weights_[k];
      if (exitances_[k]) tally.pictured_seen += weights_[k] * exitances_[k]->cast<double>();
    } else if (panes_) {
      add_through_panes(k, tally);
    }
  }
  count_ = 0;
}

void ShadowBatch::add_through_panes(std::size_t ray, ShadowTally& tally) const {
  Spectrum share = panes_->passed(caster_, rays_[ray]);
  if (!(share > 0.0f).any()) {
    tally.blocked = true;
    return;
  }
  const double weight = weights_[ray];
  tally.dimmed += weight;
  if (exitances_[ray]) share.head<3>() *= *exitances_[ray];
  if (tally.through.size() == 0) tally.through = Spectrum::Zero(share.size());
  tally.through += static_cast<float>(weight) * share;
}

}  // namespace lightwell
