#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scene/errors.h"
#include "scene/io/honeybee/honeybee_model.h"
#include "scene/io/honeybee/honeybee_shapes.h"
#include "scene/io/window_states.h"

namespace lightwell {
namespace {

// A dynamic group and the modifiers of its states, and the surfaces that have both.
using Groups = std::map<std::pair<std::string, std::vector<std::string>>, std::set<int>>;

Groups groups_of(const std::vector<DynamicOpening>& openings, const Scene& scene) {
  std::map<std::string, int> surface_of;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    surface_of.emplace(scene.surfaces[s].name, static_cast<int>(s));
  }
  Groups groups;
  for (const DynamicOpening& opening : openings) {
    const auto surface = surface_of.find(opening.surface);
    if (surface == surface_of.end()) continue;
    groups[{opening.group, opening.states}].insert(surface->second);
  }
  return groups;
}

// Adds a state; the scene itself has the first.
void add_state(const JsonObject& model, const std::string& modifier, HoneybeeModifiers& modifiers,
               std::vector<Material>& materials, WindowGroup& group) {
  const bool is_named = std::ranges::any_of(
      group.states, [&](const WindowState& state) { return state.name == modifier; });
  WindowState state{.name = is_named ? fmt::format("state {}", group.states.size() + 1) : modifier};
  if (!group.states.empty() && modifier != group.states.front().name) {
    auto material = modifiers.material(modifier);
    if (!material) {
      model.fail(fmt::format(
          "state {} of the windows '{}' has the modifier '{}', which is not defined or cannot be "
          "seen; define it, or give other states with '--windows FILE.toml'",
          group.states.size() + 1, group.name, modifier));
    }
    state.material = static_cast<int>(materials.size());
    material->name = modifier;
    materials.push_back(std::move(*material));
  }
  group.states.push_back(std::move(state));
}

}  // namespace

OperatedWindows read_honeybee_windows(const Scene& scene) {
  const nlohmann::json document = read_honeybee_document(scene.file);
  const JsonObject model(scene.file, document, "");
  Scene shapes_of;
  shapes_of.bands = scene.bands;
  Remarks remarks;  // The reader of the scene has reported the same ones.
  HoneybeeModifiers modifiers(scene.file, radiance_properties(model), shapes_of, remarks);
  HoneybeeShapes shapes(metres_of(model), modifiers, shapes_of, remarks);
  shapes.add(model);
  OperatedWindows windows;
  std::map<std::string, int> times_named;
  for (const auto& [key, surfaces] : groups_of(shapes.dynamic_openings(), scene)) {
    const auto& [name, states] = key;
    if (states.size() > most_window_states) {
      model.fail(fmt::format("the group '{}' of windows has {} states; at most {} can be read",
                             name, states.size(), most_window_states));
    }
    const int number = ++times_named[name];
    WindowGroup group{.name = number == 1 ? name : fmt::format("{} {}", name, number),
                      .surfaces = {surfaces.begin(), surfaces.end()}};
    for (const std::string& modifier : states) {
      add_state(model, modifier, modifiers, windows.materials, group);
    }
    windows.groups.push_back(std::move(group));
  }
  return windows;
}

}  // namespace lightwell
