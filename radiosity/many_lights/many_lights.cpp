// Members of DirectLight that choose among many lights as the ancestors of lightcuts did.
#include <algorithm>
#include <vector>

#include "radiosity/direct_light/direct_light.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {

std::vector<int> DirectLight::clustered_lights(int channel, Lights lights) const {
  const Trees& trees = trees_[static_cast<std::size_t>(channel)];
  std::vector<int> all;
  if (lights == Lights::all || lights == Lights::all_but_dome) all = trees.emitters;
  if (lights != Lights::distant) all.insert(all.end(), trees.lamps.begin(), trees.lamps.end());
  return all;
}

// Adds lights that may give more than a share of the light each, and two drawn among the others.
void DirectLight::add_important(int channel, const LightQuery& query, double light,
                                std::vector<Choice>& choices) const {
  // The chance of light that the estimate takes for none, as in one_for_all().
  constexpr double even = 0.1;
  std::vector<int> dim;
  std::vector<double> about;
  double all = 0.0, of_dim = 0.0;
  const std::vector<int> lights = clustered_lights(channel, query.lights);
  for (const int i : lights) about.push_back(approximate_light(i, query.at));
  for (const double value : about) all += value;
  const double least = query.shadows.cluster_share * (light > 0.0 ? light : all);
  std::vector<double> of_each;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    if (about[k] > least) {
      choices.push_back({.light = lights[k]});
      continue;
    }
    dim.push_back(lights[k]);
    of_each.push_back(about[k]);
    of_dim += about[k];
  }
  if (dim.empty()) return;
  const double by_number = (of_dim > 0.0 ? even : 1.0) / static_cast<double>(dim.size());
  const double by_light = of_dim > 0.0 ? (1.0 - even) / of_dim : 0.0;
  int cluster = 0;
  for (const Choice& choice : choices) cluster = std::max(cluster, choice.cluster + 1);
  const double u = random_uniform(
      random_key(query.key, RandomPurpose::light_clusters, static_cast<std::uint64_t>(cluster)));
  std::size_t k = 0;
  double before = 0.0, chance = by_number + by_light * of_each[0];
  for (const double from : {0.0, 0.5}) {
    while (k + 1 < dim.size() && from + 0.5 * u >= before + chance) {
      before += chance;
      chance = by_number + by_light * of_each[++k];
    }
    choices.push_back({.light = dim[k], .chance = 2.0 * chance, .cluster = cluster});
  }
}

// Adds lights in order of what they may give, until all others together may give no more than a
// share of the light. The others count as if they were as visible as these.
void DirectLight::add_sorted(int channel, const LightQuery& query, double light,
                             std::vector<Choice>& choices) const {
  struct Potential {
    double about = 0.0;
    int light = 0;
  };
  std::vector<Potential> lights;
  double all = 0.0;
  for (const int i : clustered_lights(channel, query.lights)) {
    lights.push_back({approximate_light(i, query.at), i});
    all += lights.back().about;
  }
  std::ranges::sort(lights, [](const Potential& a, const Potential& b) {
    return a.about != b.about ? a.about > b.about : a.light < b.light;
  });
  const double least = query.shadows.cluster_share * (light > 0.0 ? light : all);
  double asked = 0.0;
  std::size_t count = 0;
  while (count < lights.size() && all - asked > least) asked += lights[count++].about;
  for (std::size_t k = 0; k < count; ++k) {
    choices.push_back({.light = lights[k].light, .chance = std::min(1.0, asked / all)});
  }
}

}  // namespace lightwell
