// Members of DirectLight that decide which lights a point asks.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "radiosity/direct_light/direct_light.h"
#include "radiosity/emitters/emitter_point.h"
#include "radiosity/many_lights/light_tree.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// The most parts of a cut: six times those of 10 000 panels at the default share. Clusters of a cut
// that ends here are larger than asked for, and their members' difference says what that costs.
constexpr int most_cut_parts = 2048;

}  // namespace

int DirectLight::channel_of(int light) const {
  if (channel_count_ == 1) return 0;
  if (is_emitter(light)) return first_column(emitters_[light].facet) / bands_;
  return source(light).channel;
}

void DirectLight::cluster_lights() {
  const auto channels = static_cast<std::size_t>(channel_count_);
  std::vector<std::vector<LightBound>> emitters(channels), lamps(channels);
  for (const LightBound& bound : bounds_of(emitters_)) {
    emitters[static_cast<std::size_t>(channel_of(bound.light))].push_back(bound);
  }
  for (const LightBound& bound : bounds_of(free_sources_, static_cast<int>(emitters_.size()))) {
    lamps[static_cast<std::size_t>(channel_of(bound.light))].push_back(bound);
  }
  trees_.resize(channels);
  std::vector<char> is_clustered(static_cast<std::size_t>(light_count()), 0);
  const auto tree_of = [&](std::vector<LightBound>& bounds) -> std::shared_ptr<const LightTree> {
    if (bounds.size() < fewest_clustered) return nullptr;
    for (const LightBound& bound : bounds) is_clustered[static_cast<std::size_t>(bound.light)] = 1;
    return std::make_shared<const LightTree>(std::move(bounds));
  };
  const auto lights_of = [](const std::vector<LightBound>& bounds) {
    std::vector<int> lights;
    if (bounds.size() < fewest_clustered) return lights;
    for (const LightBound& bound : bounds) lights.push_back(bound.light);
    return lights;
  };
  for (std::size_t c = 0; c < channels; ++c) {
    std::vector<int> of_emitters = lights_of(emitters[c]), of_lamps = lights_of(lamps[c]);
    trees_[c] = {.of_emitters = tree_of(emitters[c]),
                 .of_lamps = tree_of(lamps[c]),
                 .emitters = std::move(of_emitters),
                 .lamps = std::move(of_lamps)};
  }
  few_.resize(channels);
  for (int i = 0; i < light_count(); ++i) {
    if (is_clustered[static_cast<std::size_t>(i)] != 0) continue;
    if (is_on(i)) {
      few_[static_cast<std::size_t>(channel_of(i))].push_back(i);
    } else if (is_emitter(i)) {
      off_.push_back(i);
    }
  }
}

bool DirectLight::is_on(int light) const {
  const Spectrum& L = is_emitter(light) ? emitters_[light].exitance : source(light).light;
  return (L > 0.0f).any();
}

bool DirectLight::has_emitter_clusters() const {
  return std::ranges::any_of(trees_,
                             [](const Trees& trees) { return trees.of_emitters != nullptr; });
}

bool DirectLight::has_clusters() const {
  return std::ranges::any_of(
      trees_, [](const Trees& trees) { return trees.of_emitters || trees.of_lamps; });
}

int DirectLight::asked(const ElementCaster& caster, const LightQuery& query) const {
  return static_cast<int>(chosen_lights(query, pilot_light(caster, query)).size());
}

// Emitters come first, then lamps, then sky and sun.
int DirectLight::first_light(Lights lights) const {
  std::size_t first = 0;
  if (lights == Lights::free || lights == Lights::distant) first = emitters_.size();
  if (lights == Lights::distant) {
    first += static_cast<std::size_t>(
        std::ranges::count_if(free_sources_, [](const auto& s) { return !s.is_distant(); }));
  }
  return static_cast<int>(first);
}

// About what a light would give at a point without occluders, mean of the bands, W/m^2.
double DirectLight::approximate_light(int light, const SurfacePoint& at) const {
  const auto& [point, normal, facet] = at;
  if (!is_emitter(light)) {
    const SourceSample middle = sample_source(source(light), point, 0.5, 0.5);
    return std::max(0.0, middle.direction.dot(normal)) * middle.irradiance *
           static_cast<double>(source(light).light.mean());
  }
  const Emitter& emitter = emitters_[light];
  const Eigen::Vector3d to = emitter.center - point;
  const double above = to.dot(normal) + emitter.radius;
  if (facet == emitter.facet || !(above > 0.0)) return 0.0;
  const double cosine = std::min(1.0, above / std::hypot(to.norm(), emitter.radius));
  return cosine * approximate_kernel(emitter, point) * emitter.area * std::numbers::inv_pi *
         static_cast<double>(emitter.exitance.mean());
}

std::vector<const LightTree*> DirectLight::trees_of(int channel, Lights lights) const {
  const Trees& of = trees_[static_cast<std::size_t>(channel)];
  std::vector<const LightTree*> trees;
  const bool has_emitters = lights == Lights::all || lights == Lights::all_but_dome;
  if (of.of_emitters && has_emitters) trees.push_back(of.of_emitters.get());
  if (of.of_lamps && lights != Lights::distant) trees.push_back(of.of_lamps.get());
  return trees;
}

// Adds the parts of a cut through trees: single lights, and two members of each cluster. The two
// halves of the chances that they are drawn from show what drawing leaves to chance.
void DirectLight::add_cut(std::span<const LightTree* const> trees, const SurfacePoint& at,
                          std::uint64_t key, double share, double light,
                          std::vector<Choice>& choices) const {
  int cluster = 0;
  for (const Choice& choice : choices) cluster = std::max(cluster, choice.cluster + 1);
  for (const CutPart& part : light_cut(trees, at, share, light, most_cut_parts)) {
    const int node = part.seen.node;
    if (!part.tree->is_cluster(node)) {
      choices.push_back({.light = part.tree->light(node)});
      continue;
    }
    const double u = random_uniform(
        random_key(key, RandomPurpose::light_clusters, static_cast<std::uint64_t>(cluster)));
    for (const double from : {0.0, 0.5}) {
      const LightTree::Draw draw = part.tree->draw(node, at, from + 0.5 * u);
      if (draw.light < 0) continue;
      choices.push_back({.light = draw.light, .chance = 2.0 * draw.chance, .cluster = cluster});
    }
    ++cluster;
  }
}

// Emitters that are switched off exchange as all others, since they reflect.
std::vector<DirectLight::Choice> DirectLight::chosen_emitters(const SurfacePoint& at,
                                                              std::uint64_t key,
                                                              double share) const {
  std::vector<Choice> choices;
  for (const int light : off_) choices.push_back({.light = light});
  for (int c = 0; c < channel_count_; ++c) {
    for (const int light : few_[static_cast<std::size_t>(c)]) {
      if (is_emitter(light)) choices.push_back({.light = light});
    }
    const LightTree* const tree = trees_[static_cast<std::size_t>(c)].of_emitters.get();
    if (tree) add_cut({&tree, 1}, at, key, share, 0.0, choices);
  }
  return choices;
}

// The light of a channel that stands for all but the sky's dome. Each candidate has a part of the
// chance whatever its estimate, since the middle of a light may lie below the horizon or outside of
// a beam of which other points see a part. Empty if the channel has no lights.
std::optional<DirectLight::Choice> DirectLight::one_for_all(int channel,
                                                            const LightQuery& query) const {
  constexpr double even = 0.1;
  // A tenth of the light at most for a cluster: one light is drawn, so that finer clusters save
  // nothing.
  constexpr double coarse = 0.1;
  std::vector<Choice> choices;
  std::vector<double> weight;
  const int first = first_light(query.lights);
  for (const int light : few_[static_cast<std::size_t>(channel)]) {
    if (light >= first && !is_dome(light)) choices.push_back({.light = light});
  }
  add_cut(trees_of(channel, query.lights), query.at, query.key, coarse, 0.0, choices);
  double sum = 0.0;
  for (const Choice& choice : choices) {
    weight.push_back(approximate_light(choice.light, query.at) / choice.chance);
    sum += weight.back();
  }
  if (choices.empty()) return std::nullopt;
  const auto count = static_cast<double>(choices.size());
  const double by_weight = sum > 0.0 ? (1.0 - even) / sum : 0.0;
  const double by_number = sum > 0.0 ? even / count : 1.0 / count;
  double left = random_uniform(
      random_key(query.key, RandomPurpose::drawn_lights, static_cast<std::uint64_t>(channel)));
  std::size_t k = 0;
  double chance = by_weight * weight[k] + by_number;
  while (k + 1 < choices.size() && left >= chance) {
    left -= chance;
    chance = by_weight * weight[++k] + by_number;
  }
  return Choice{.light = choices[k].light, .chance = chance * choices[k].chance};
}

// The lights that a query asks: all, those of a cut, or one of each channel and the sky's dome.
std::vector<DirectLight::Choice> DirectLight::chosen_lights(
    const LightQuery& query, const std::vector<double>& light) const {
  std::vector<Choice> choices;
  const int first = first_light(query.lights);
  for (int c = 0; c < channel_count_; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    for (const int i : few_[channel]) {
      const bool is_asked = is_dome(i) || !query.one_stands_for_all;
      if (i >= first && is_asked) choices.push_back({.light = i});
    }
    if (query.one_stands_for_all) {
      const std::optional<Choice> one = one_for_all(c, query);
      if (one) choices.push_back(*one);
      continue;
    }
    const double arriving = light.empty() ? 0.0 : light[channel];
    switch (query.shadows.many_lights) {
      case ManyLights::lightcuts:
        add_cut(trees_of(c, query.lights), query.at, query.key, query.shadows.cluster_share,
                arriving, choices);
        break;
      case ManyLights::sorted:
        add_sorted(c, query, arriving, choices);
        break;
      case ManyLights::importance:
        add_important(c, query, arriving, choices);
        break;
      case ManyLights::all:
        for (const int i : clustered_lights(c, query.lights)) choices.push_back({.light = i});
        break;
    }
  }
  return choices;
}

}  // namespace lightwell
