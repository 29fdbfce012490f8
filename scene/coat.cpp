#include "scene/coat.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "scene/optics.h"
#include "scene/sampling.h"
#include "scene/specular.h"

namespace lightwell {
namespace {

// Share that a rough coat mirrors at one angle: the mean weight of samples of its lobe.
double mirrored_by_lobe(const Material& material, double cosine, std::uint64_t number) {
  // F varies by about 0.2 within a lobe at grazing incidence: its mean is then known to 0.006 at
  // worst, and better with stratified points.
  constexpr int count = 1024;
  static const SobolPoints points(count);
  const SurfaceInteraction interaction{
      .material = material,
      .direction = {std::sqrt(1.0 - cosine * cosine), 0.0, -cosine},
      .normal = Eigen::Vector3d::UnitZ()};
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    const Eigen::Array4d u = points.point(i, number).cast<double>();
    const ScatteringSample sample =
        sample_lobe(interaction, {.component = u[2],
                                  .u = u[0],
                                  .v = u[1],
                                  .key = random_key(number, static_cast<std::uint64_t>(i))});
    sum += static_cast<double>(sample.weight[0]);
  }
  return sum / count;
}

// A grey coat of one band that mirrors all that Fresnel's equations give.
Material lone_coat(const Material& material) {
  Material coat;
  coat.reflectance = coat.emission = Spectrum::Zero(1);
  coat.specular = Spectrum::Ones(1);
  coat.specular_roughness = material.specular_roughness;
  coat.coat = Coat{.index_of_refraction = material.coat->index_of_refraction};
  return coat;
}

// Bases by index and roughness. A solve asks for each of them hundreds of times, and the table of a
// rough coat takes milliseconds.
class KnownBases {
 public:
  using Key = std::pair<float, float>;
  std::optional<CoatedBase> find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = known_.find(key);
    return found == known_.end() ? std::nullopt : std::optional(found->second);
  }
  void keep(const Key& key, const CoatedBase& base) {
    const std::lock_guard lock(mutex_);
    known_.emplace(key, base);
  }

 private:
  std::mutex mutex_{};
  std::map<Key, CoatedBase> known_{};
};

KnownBases& known_bases() {
  static KnownBases known;
  return known;
}

}  // namespace

CoatedBase::CoatedBase(const Material& material) {
  if (!material.coat) throw std::invalid_argument("a base needs a coat");
  const KnownBases::Key key(material.coat->index_of_refraction, material.specular_roughness);
  if (!std::isfinite(key.first) || !std::isfinite(key.second)) {
    throw std::invalid_argument("a coat needs a finite index and roughness");
  }
  if (material.pattern && material.pattern->coat_levels) {
    *this = material.pattern->coat_levels->at(material.specular_roughness)
                .covering(material.coat->cover);
    return;
  }
  cover_ = double{material.coat->cover};
  if (const auto known = known_bases().find(key)) {
    *this = known->covering(material.coat->cover);
    return;
  }
  index_ = double{material.coat->index_of_refraction};
  if (!(material.specular_roughness > 0.0f)) {
    mean_ = diffuse_fresnel(index_);
  } else {
    const Material coat = lone_coat(material);
    std::array<float, steps_> rough{};
    for (std::size_t i = 0; i < steps_; ++i) {
      const double cosine = (static_cast<double>(i) + 0.5) / steps_;
      const double A = mirrored_by_lobe(coat, cosine, i);
      rough[i] = static_cast<float>(A);
      mean_ += 2.0 * cosine * A / steps_;
    }
    rough_ = rough;
  }
  known_bases().keep(key, *this);
}

CoatedBase::CoatedBase(const CoatedBase& low, const CoatedBase& high, double part)
    : index_(low.index_), mean_((1.0 - part) * low.mean_ + part * high.mean_) {
  std::array<float, steps_> rough{};
  for (std::size_t i = 0; i < steps_; ++i) {
    const double cosine = (static_cast<double>(i) + 0.5) / steps_;
    rough[i] =
        static_cast<float>((1.0 - part) * low.mirrored(cosine) + part * high.mirrored(cosine));
  }
  rough_ = rough;
}

CoatedBase CoatedBase::covering(float cover) const {
  CoatedBase base = *this;
  base.cover_ = double{cover};
  return base;
}

double CoatedBase::mirrored(double cosine) const {
  if (!rough_) return fresnel_reflectance(cosine, index_);
  const double place = std::clamp(cosine * steps_ - 0.5, 0.0, steps_ - 1.0);
  const auto low = std::min(static_cast<std::size_t>(place), steps_ - 2);
  const double part = place - static_cast<double>(low);
  return (1.0 - part) * double{(*rough_)[low]} + part * double{(*rough_)[low + 1]};
}

double CoatedBase::factor(double cosine) const {
  return (1.0 - cover_ * mirrored(std::clamp(cosine, 0.0, 1.0))) / (1.0 - cover_ * mean_);
}

namespace {

// Steps of CoatLevels from alpha 0 to 1.
constexpr int level_steps = 16;

double step_of(float alpha) {
  return level_steps * std::sqrt(double{std::clamp(alpha, 0.0f, 1.0f)});
}

}  // namespace

CoatLevels::CoatLevels(const Material& material, float least, float most) {
  if (!material.coat) throw std::invalid_argument("levels of a coat need a coat");
  Material coat = lone_coat(material);
  const auto add = [&](float alpha) {
    coat.specular_roughness = alpha;
    levels_.emplace_back(coat);
  };
  if (least >= most) {
    add(least);
    return;
  }
  first_ = static_cast<int>(std::floor(step_of(least)));
  const int last = static_cast<int>(std::ceil(step_of(most)));
  for (int i = first_; i <= last; ++i) {
    add(static_cast<float>(i * i) / static_cast<float>(level_steps * level_steps));
  }
}

CoatedBase CoatLevels::at(float alpha) const {
  const double place = std::clamp(step_of(alpha) - first_, 0.0, double(levels_.size() - 1));
  const auto low = static_cast<std::size_t>(place);
  const double part = place - static_cast<double>(low);
  return part > 0.0 ? CoatedBase(levels_[low], levels_[low + 1], part) : levels_[low];
}

CoatedBases::CoatedBases(const std::vector<Material>& materials) : bases_(materials.size()) {
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (!materials[i].coat) continue;
    bases_[i].emplace(materials[i]);
    empty_ = false;
  }
}

Spectrum mean_mirrored(const Material& material) {
  if (material.metal) return mean_reflectance(*material.metal) * material.specular;
  if (!material.coat) return material.specular;
  Spectrum share = static_cast<float>(CoatedBase(material).mean_mirrored()) * material.specular;
  if (material.coat->bare.size() > 0) share += material.coat->bare;
  return share;
}

std::vector<Spectrum> mean_mirrored(const std::vector<Material>& materials) {
  std::vector<Spectrum> shares;
  shares.reserve(materials.size());
  for (const Material& material : materials) shares.push_back(mean_mirrored(material));
  return shares;
}

CoatOverBase::CoatOverBase(const Material& material, bool saturating)
    : outside_(static_cast<float>(CoatedBase(material).mean_mirrored())),
      inside_(1.0f - (1.0f - outside_) /
                         (material.coat->index_of_refraction * material.coat->index_of_refraction)),
      saturating_(saturating) {}

Spectrum CoatOverBase::reflectance(const Spectrum& base) const {
  const Spectrum returned = saturating_ ? base : Spectrum(Spectrum::Ones(base.size()));
  return (1.0f - outside_) * (1.0f - inside_) * base / (1.0f - inside_ * returned);
}

}  // namespace lightwell
