#include "radiosity/many_lights/light_sampler.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>
#include <utility>

#include "radiosity/emitters/emitter_point.h"
#include "radiosity/many_lights/node_weight.h"
#include "radiosity/many_lights/potential_lights.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// The most parts of a cut: six times those of 10 000 panels at the default share. Clusters of a cut
// that ends here are larger than asked for, and their members' difference says what that costs.
constexpr int most_cut_parts = 2048;

bool has_emitters(Lights lights) {
  return lights == Lights::all || lights == Lights::all_but_dome;
}

// Adds the samples of a part: a single light, or two members of a cluster. The two halves of the
// chances that they are drawn from show what drawing leaves to chance.
void add_part(const CutPart& part, int cluster, const LightChoice& choice,
              std::vector<LightSample>& samples) {
  const int node = part.seen.node;
  if (!part.tree->is_cluster(node)) {
    samples.push_back({.light = part.tree->light(node)});
    return;
  }
  const double u = random_uniform(
      random_key(choice.key, RandomPurpose::light_clusters, static_cast<std::uint64_t>(cluster)));
  for (const double from : {0.0, 0.5}) {
    const LightTree::Draw draw = part.tree->draw(node, choice.at, from + 0.5 * u);
    if (draw.light < 0) continue;
    samples.push_back({.light = draw.light, .chance = 2.0 * draw.chance, .cluster = cluster});
  }
}

}  // namespace

LightSampler::LightSampler(std::shared_ptr<const LightList> lights) : lights_(std::move(lights)) {
  const auto channels = static_cast<std::size_t>(lights_->channel_count);
  std::vector<std::vector<LightBound>> emitters(channels), lamps(channels);
  for (const LightBound& bound : bounds_of(lights_->emitters)) {
    emitters[static_cast<std::size_t>(lights_->channel(bound.light))].push_back(bound);
  }
  for (const LightBound& bound : bounds_of(lights_->sources, lights_->emitter_count())) {
    lamps[static_cast<std::size_t>(lights_->channel(bound.light))].push_back(bound);
  }
  std::vector<char> is_clustered(static_cast<std::size_t>(lights_->count()), 0);
  const auto cluster = [&](std::vector<LightBound>& bounds, std::vector<int>& numbers) {
    if (bounds.size() < static_cast<std::size_t>(fewest_clustered)) return;
    for (const LightBound& bound : bounds) {
      is_clustered[static_cast<std::size_t>(bound.light)] = 1;
      numbers.push_back(bound.light);
    }
  };
  const auto tree_of = [](std::vector<LightBound>& bounds) -> std::shared_ptr<const LightTree> {
    if (bounds.size() < static_cast<std::size_t>(fewest_clustered)) return nullptr;
    return std::make_shared<const LightTree>(std::move(bounds));
  };
  trees_.resize(channels);
  for (std::size_t c = 0; c < channels; ++c) {
    cluster(emitters[c], trees_[c].emitters);
    cluster(lamps[c], trees_[c].lamps);
    trees_[c].of_emitters = tree_of(emitters[c]);
    trees_[c].of_lamps = tree_of(lamps[c]);
  }
  few_.resize(channels);
  for (int i = 0; i < lights_->count(); ++i) {
    if (is_clustered[static_cast<std::size_t>(i)] != 0) continue;
    if (lights_->is_on(i)) {
      few_[static_cast<std::size_t>(lights_->channel(i))].push_back(i);
    } else if (lights_->is_emitter(i)) {
      off_.push_back(i);
    }
  }
}

bool LightSampler::has_emitter_clusters() const {
  return std::ranges::any_of(trees_,
                             [](const Trees& trees) { return trees.of_emitters != nullptr; });
}

bool LightSampler::has_clusters(Lights lights) const {
  for (int c = 0; c < lights_->channel_count; ++c) {
    if (!trees_of(c, lights).empty()) return true;
  }
  return false;
}

// The first light of LightList that gives a sum.
int LightSampler::first_light(Lights lights) const {
  int first = has_emitters(lights) ? 0 : lights_->emitter_count();
  if (lights == Lights::distant) {
    first += static_cast<int>(
        std::ranges::count_if(lights_->sources, [](const auto& s) { return !s.is_distant(); }));
  }
  return first;
}

void LightSampler::add_few(int channel, Lights lights, std::vector<LightSample>& samples) const {
  const int first = first_light(lights);
  for (const int i : few_[static_cast<std::size_t>(channel)]) {
    if (i >= first) samples.push_back({.light = i});
  }
}

// About what a light would give at a point without occluders, mean of the bands, W/m^2.
double LightSampler::approximate_light(int light, const SurfacePoint& at) const {
  const auto& [point, normal, facet] = at;
  if (!lights_->is_emitter(light)) {
    const FreeSource& source = lights_->source(light);
    const SourceSample middle = sample_source(source, point, 0.5, 0.5);
    return std::max(0.0, middle.direction.dot(normal)) * middle.irradiance *
           static_cast<double>(source.light.mean());
  }
  const Emitter& emitter = lights_->emitters[light];
  const Eigen::Vector3d to = emitter.center - point;
  const double above = to.dot(normal) + emitter.radius;
  if (facet == emitter.facet || !(above > 0.0)) return 0.0;
  const double cosine = std::min(1.0, above / std::hypot(to.norm(), emitter.radius));
  return cosine * approximate_kernel(emitter, point) * emitter.area * std::numbers::inv_pi *
         static_cast<double>(emitter.exitance.mean());
}

std::vector<const LightTree*> LightSampler::trees_of(int channel, Lights lights) const {
  const Trees& of = trees_[static_cast<std::size_t>(channel)];
  std::vector<const LightTree*> trees;
  if (of.of_emitters && has_emitters(lights)) trees.push_back(of.of_emitters.get());
  if (of.of_lamps && lights != Lights::distant) trees.push_back(of.of_lamps.get());
  return trees;
}

std::vector<const LightTree*> LightSampler::trees(Lights lights) const {
  std::vector<const LightTree*> all;
  for (int c = 0; c < lights_->channel_count; ++c) {
    const std::vector<const LightTree*> some = trees_of(c, lights);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

std::vector<LightSample> LightSampler::singles(Lights lights) const {
  std::vector<LightSample> samples;
  for (int c = 0; c < lights_->channel_count; ++c) add_few(c, lights, samples);
  return samples;
}

std::vector<PotentialLight> LightSampler::clustered_lights(int channel,
                                                           const LightChoice& choice) const {
  const Trees& trees = trees_[static_cast<std::size_t>(channel)];
  std::vector<PotentialLight> all;
  const auto add = [&](const std::vector<int>& lights) {
    for (const int i : lights) all.push_back({i, approximate_light(i, choice.at)});
  };
  if (has_emitters(choice.lights)) add(trees.emitters);
  if (choice.lights != Lights::distant) add(trees.lamps);
  return all;
}

LightCut LightSampler::pilot_cut(const LightChoice& choice) const {
  // A cut of clusters that are 20 times as large asks a sixth of the lights, and a pilot that is
  // off by a tenth makes clusters off by a tenth. Clusters of a fifth are some ten.
  constexpr double coarser = 20.0, coarsest = 0.2;
  const double share =
      std::max(choice.cluster_share, std::min(coarsest, coarser * choice.cluster_share));
  LightCut cut;
  for (int c = 0; c < lights_->channel_count; ++c) {
    add_few(c, choice.lights, cut.samples);
    const std::vector<CutPart> parts =
        light_cut(roots(trees_of(c, choice.lights), choice.at), choice.at,
                  {.share = share, .most = most_cut_parts});
    for (const CutPart& part : parts) {
      add_part(part, static_cast<int>(cut.parts.size()), choice, cut.samples);
      cut.parts.push_back(part);
    }
    cut.end.push_back(cut.parts.size());
  }
  return cut;
}

namespace {

// The parts of a channel in a pilot's cut.
std::vector<CutPart> parts_of(const LightPilot& pilot, std::size_t channel) {
  const auto first = pilot.cut.parts.begin();
  const std::size_t begin = channel == 0 ? 0 : pilot.cut.end[channel - 1];
  return {first + static_cast<std::ptrdiff_t>(begin),
          first + static_cast<std::ptrdiff_t>(pilot.cut.end[channel])};
}

}  // namespace

std::vector<LightSample> LightSampler::samples(const LightChoice& choice,
                                               const LightPilot* pilot) const {
  std::vector<LightSample> samples;
  int cluster = 0;
  for (int c = 0; c < lights_->channel_count; ++c) {
    add_few(c, choice.lights, samples);
    if (trees_of(c, choice.lights).empty()) continue;
    if (choice.many_lights == ManyLights::all) {
      for (const auto& [light, about] : clustered_lights(c, choice)) {
        samples.push_back({.light = light});
      }
      continue;
    }
    if (choice.many_lights == ManyLights::lightcuts) {
      const auto channel = static_cast<std::size_t>(c);
      for (const CutPart& part : light_cut(parts_of(*pilot, channel), choice.at,
                                           {.share = choice.cluster_share,
                                           .light = pilot->light[channel],
                                           .most = most_cut_parts})) {
        add_part(part, cluster++, choice, samples);
      }
      continue;
    }
    const double least = choice.cluster_share * pilot->light[static_cast<std::size_t>(c)];
    const double u = random_uniform(
        random_key(choice.key, RandomPurpose::light_clusters, static_cast<std::uint64_t>(cluster)));
    const std::vector<LightSample> some =
        choice.many_lights == ManyLights::sorted
            ? sorted_samples(clustered_lights(c, choice), least)
            : important_samples(clustered_lights(c, choice), least, u, cluster++);
    samples.insert(samples.end(), some.begin(), some.end());
  }
  return samples;
}

std::vector<LightSample> LightSampler::emitters(const LightChoice& choice) const {
  std::vector<LightSample> samples;
  for (const int light : off_) samples.push_back({.light = light});
  int cluster = 0;
  for (int c = 0; c < lights_->channel_count; ++c) {
    for (const int light : few_[static_cast<std::size_t>(c)]) {
      if (lights_->is_emitter(light)) samples.push_back({.light = light});
    }
    const LightTree* const tree = trees_[static_cast<std::size_t>(c)].of_emitters.get();
    if (!tree) continue;
    for (const CutPart& part : light_cut(roots({tree}, choice.at), choice.at,
                                         {.share = choice.cluster_share, .most = most_cut_parts})) {
      add_part(part, cluster++, choice, samples);
    }
  }
  return samples;
}

namespace {

// Some lights of a tree, drawn by what each half of a cluster may give: candidates of
// one_for_all(). A few from parts of the chances that follow each other leave no more noise in a
// flat with 82 lights than those of a cut, which take longer to find.
void add_candidates(const LightTree& tree, int number, const LightChoice& choice,
                    std::vector<LightSample>& samples) {
  const auto weight = [&](const LightNode& node) {
    return may_give(node, greatest_intensity(node, choice.at.position), choice.at);
  };
  constexpr int count = 4;
  const double u = random_uniform(
      random_key(choice.key, RandomPurpose::light_clusters, static_cast<std::uint64_t>(number)));
  for (int i = 0; i < count; ++i) {
    const LightTree::Draw draw = tree.draw_by(0, (i + u) / count, weight);
    if (draw.light >= 0) samples.push_back({.light = draw.light, .chance = count * draw.chance});
  }
}

}  // namespace

// The light of a channel that stands for all but the sky's dome. Each candidate has a part of the
// chance whatever its estimate, since the middle of a light may lie below the horizon or outside of
// a beam of which other points see a part. Empty if the channel has no lights.
std::optional<LightSample> LightSampler::one_for_all(int channel, const LightChoice& choice) const {
  constexpr double even = 0.1;
  std::vector<LightSample> samples, few;
  add_few(channel, choice.lights, few);
  std::ranges::copy_if(few, std::back_inserter(samples),
                       [&](const LightSample& s) { return !lights_->is_dome(s.light); });
  int number = 0;
  for (const LightTree* tree : trees_of(channel, choice.lights)) {
    add_candidates(*tree, number++, choice, samples);
  }
  if (samples.empty()) return std::nullopt;
  std::vector<double> weight;
  double sum = 0.0;
  for (const LightSample& sample : samples) {
    weight.push_back(approximate_light(sample.light, choice.at) / sample.chance);
    sum += weight.back();
  }
  const auto count = static_cast<double>(samples.size());
  const double by_weight = sum > 0.0 ? (1.0 - even) / sum : 0.0;
  const double by_number = sum > 0.0 ? even / count : 1.0 / count;
  double left = random_uniform(
      random_key(choice.key, RandomPurpose::drawn_lights, static_cast<std::uint64_t>(channel)));
  std::size_t k = 0;
  double chance = by_weight * weight[k] + by_number;
  while (k + 1 < samples.size() && left >= chance) {
    left -= chance;
    chance = by_weight * weight[++k] + by_number;
  }
  return LightSample{.light = samples[k].light, .chance = chance * samples[k].chance};
}

std::vector<LightSample> LightSampler::one_of_each_channel(const LightChoice& choice) const {
  std::vector<LightSample> samples;
  for (int c = 0; c < lights_->channel_count; ++c) {
    std::vector<LightSample> few;
    add_few(c, choice.lights, few);
    std::ranges::copy_if(few, std::back_inserter(samples),
                         [&](const LightSample& s) { return lights_->is_dome(s.light); });
    if (const std::optional<LightSample> one = one_for_all(c, choice)) samples.push_back(*one);
  }
  return samples;
}

}  // namespace lightwell
