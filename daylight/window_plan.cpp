#include "daylight/window_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "scene/errors.h"

namespace lightwell {
namespace {

// Groups with their states, other than the first, that some hour has; one changed group each.
std::vector<WindowStates> single_changes(const Eigen::ArrayXXi& states) {
  std::vector<WindowStates> changes;
  for (Eigen::Index g = 0; g < states.rows(); ++g) {
    const std::set<int> of_group(states.row(g).begin(), states.row(g).end());
    for (const int state : of_group) {
      if (state == 0) continue;
      WindowStates change(static_cast<std::size_t>(states.rows()), 0);
      change[static_cast<std::size_t>(g)] = state;
      changes.push_back(std::move(change));
    }
  }
  return changes;
}

// All groups that change, in their last state.
WindowStates all_changed(const std::vector<WindowStates>& changes) {
  WindowStates all = changes.front();
  for (const WindowStates& change : changes) {
    for (std::size_t g = 0; g < all.size(); ++g) all[g] = std::max(all[g], change[g]);
  }
  return all;
}

double changed_groups(const WindowStates& states) {
  return static_cast<double>(std::ranges::count_if(states, [](int state) { return state != 0; }));
}

}  // namespace

Scene scene_in_states(const Scene& scene, const OperatedWindows& windows,
                      const WindowStates& states) {
  Scene changed = scene;
  for (std::size_t g = 0; g < windows.groups.size(); ++g) {
    const WindowGroup& group = windows.groups[g];
    const auto& given = group.states[static_cast<std::size_t>(states[g])].material;
    if (!given) continue;
    const Material& material = windows.materials[static_cast<std::size_t>(*given)];
    // The scene's own number of the material, where there is one: states then differ in nothing
    // else.
    const auto found = std::ranges::find_if(changed.materials, [&](const Material& other) {
      return other.name == material.name && material_hash(other) == material_hash(material);
    });
    const int number = static_cast<int>(found - changed.materials.begin());
    if (found == changed.materials.end()) changed.materials.push_back(material);
    for (const int surface : group.surfaces) {
      changed.surfaces[static_cast<std::size_t>(surface)].material = number;
    }
  }
  return changed;
}

std::string states_text(const OperatedWindows& windows, const WindowStates& states) {
  std::string text;
  for (std::size_t g = 0; g < windows.groups.size(); ++g) {
    const WindowGroup& group = windows.groups[g];
    text += fmt::format("{}{}: {}", g == 0 ? "" : ", ", group.name,
                        group.states[static_cast<std::size_t>(states[g])].name);
  }
  return text;
}

double WindowPlan::weight(std::size_t computation, const WindowStates& states) const {
  if (is_superposed && states != computations.back()) {
    return superposed_weight(computation, states);
  }
  return computations[computation] == states ? 1.0 : 0.0;
}

double WindowPlan::superposed_weight(std::size_t computation, const WindowStates& states) const {
  if (computation == 0) return 1.0 - changed_groups(states);
  if (computation + 1 == computations.size()) return 0.0;
  const WindowStates& computed = computations[computation];
  const auto changed = std::ranges::find_if(computed, [](int state) { return state != 0; });
  const auto g = static_cast<std::size_t>(changed - computed.begin());
  return states[g] == computed[g] ? 1.0 : 0.0;
}

WindowStates states_of_hour(const Eigen::ArrayXXi& states, Eigen::Index hour) {
  return {states.col(hour).begin(), states.col(hour).end()};
}

WindowPlan plan_computations(const OperatedWindows& windows, const Eigen::ArrayXXi& states) {
  const WindowStates open(windows.groups.size(), 0);
  WindowPlan plan{.computations = {open}};
  if (windows.groups.empty()) return plan;
  std::set<WindowStates> combinations;
  for (Eigen::Index h = 0; h < states.cols(); ++h) combinations.insert(states_of_hour(states, h));
  combinations.erase(open);
  const std::vector<WindowStates> changes = single_changes(states);
  const std::size_t superposed = changes.size() + 2;  // with none and all of them changed
  if (combinations.size() < std::max(superposed, std::size_t{most_combinations})) {
    plan.computations.insert(plan.computations.end(), combinations.begin(), combinations.end());
  } else {
    plan.is_superposed = true;
    plan.computations.insert(plan.computations.end(), changes.begin(), changes.end());
    plan.computations.push_back(all_changed(changes));
  }
  const std::size_t count = plan.computations.size();
  if (count > std::size_t{most_computations}) {
    throw InputError(fmt::format(
        "the states of the windows need {} computations of the room, and {} are the most; join "
        "groups that open and close together, or give them fewer states",
        count, most_computations));
  }
  return plan;
}

}  // namespace lightwell
