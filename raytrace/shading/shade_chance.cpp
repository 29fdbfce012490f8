// Steps of RayTree that leave weak branches to chance.
#include <algorithm>

#include "raytrace/shading/shade.h"
#include "scene/optics.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {

// Largest share of any band that a surface mirrors of the interaction's light.
float RayTree::mirrored_share(const SurfaceInteraction& interaction) {
  return scattering_weight(interaction,
                           {.direction = reflect(interaction.direction, interaction.normal)})
      .maxCoeff();
}

// Ends most branches that a coat would mirror behind another one, and strengthens the rest. One in
// six goes on of those that meet the second coat steeply, with a quarter of the first coat's
// weight. Light that passes a coated sheet straight on is no fainter for the coat, and goes on.
bool RayTree::goes_on_at_coat(const SurfaceInteraction& interaction, Branch& branch,
                              const TreeState& state) const {
  if (!interaction.material.mirrors_by_coat() || branch.behind_coat == 0 || !state.shades)
    return true;
  constexpr float left_weight = 0.25f;
  const float chance = mirrored_share(interaction) / left_weight;
  if (chance >= 1.0f) return true;
  if (!(roulette(branch, 2, state) < static_cast<double>(chance))) return false;
  branch.weight /= chance;
  return true;
}

// A number in [0,1) of a branch, `purpose` 0 to 2. Branches of other depths have other nodes.
double RayTree::roulette(const Branch& branch, int purpose, const TreeState& state) {
  return random_uniform(random_key(state.key, branch.node, RandomPurpose::ray_tree_roulette,
                                   static_cast<std::uint64_t>(2 * branch.depth + purpose)));
}

// Leaves one of two lobes, by their weights, with the weight of both: a branch of little weight
// does not fork.
void RayTree::choose_one(const Branch& branch, SmoothScattering& lobes,
                         const TreeState& state) const {
  const float first = lobes.sample[0].weight.maxCoeff(), second = lobes.sample[1].weight.maxCoeff();
  if (lobes.count < 2 || !(first + second > 0.0f)) return;
  const float chance = first / (first + second);
  const bool is_first = roulette(branch, 1, state) < static_cast<double>(chance);
  lobes.sample[is_first ? 0 : 1].weight /= is_first ? chance : 1.0f - chance;
  lobes.sample[is_first ? 1 : 0].weight.setZero();
}

// Ends branches far below the least weight by Russian roulette (Arvo & Kirk 1990): a survivor
// stands for those that end. A tree without light needs no branch of little weight, and a single
// path has no other branch.
bool RayTree::survives(Branch& branch, const TreeState& state) const {
  const float weight = branch.share();
  if (weight >= options_.min_contribution || state.turns) return weight > 0.0f;
  if (!state.shades) return false;
  constexpr float far_below = 0.1f;
  const float least = far_below * options_.min_contribution;
  if (weight >= least) return true;
  const double chance = double{weight} / double{least};
  if (!(roulette(branch, 0, state) < chance)) return false;
  branch.weight *= static_cast<float>(1.0 / chance);
  return true;
}

}  // namespace lightwell
