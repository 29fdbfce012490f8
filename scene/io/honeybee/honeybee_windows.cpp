#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scene/errors.h"
#include "scene/io/honeybee/honeybee_model.h"
#include "scene/io/honeybee/honeybee_modifiers.h"
#include "scene/io/remarks.h"
#include "scene/io/window_states.h"

namespace lightwell {
namespace {

// Modifiers of the states of an opening, "" where the state keeps that of the opening.
using StateModifiers = std::vector<std::string>;

class WindowCollector {
 public:
  explicit WindowCollector(const Scene& scene) {
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
      surface_of_.emplace(scene.surfaces[s].name, static_cast<int>(s));
    }
  }

  void collect(const JsonObject& model) {
    for (const JsonObject& room : model.objects("rooms")) collect_faces(room, "faces");
    collect_faces(model, "orphaned_faces");
    collect_openings(model, "orphaned_apertures");
    collect_openings(model, "orphaned_doors");
  }

  OperatedWindows operated(const JsonObject& model, HoneybeeModifiers& modifiers) const {
    OperatedWindows windows;
    std::map<std::string, int> times_named;
    for (const auto& [key, surfaces] : groups_) {
      const auto& [name, states] = key;
      if (states.size() > most_window_states) {
        model.fail(fmt::format("the group '{}' of windows has {} states; at most {} can be read",
                               name, states.size(), most_window_states));
      }
      const int number = ++times_named[name];
      WindowGroup group{.name = number == 1 ? name : fmt::format("{} {}", name, number),
                        .surfaces = {surfaces.begin(), surfaces.end()}};
      for (const std::string& modifier : states) {
        add_state(modifier, modifiers, windows.materials, group);
      }
      windows.groups.push_back(std::move(group));
    }
    return windows;
  }

 private:
  void collect_faces(const JsonObject& parent, const char* list) {
    for (const JsonObject& face : parent.objects(list)) {
      collect_openings(face, "apertures");
      collect_openings(face, "doors");
    }
  }

  void collect_openings(const JsonObject& parent, const char* list) {
    for (const JsonObject& opening : parent.objects(list)) {
      const auto radiance = radiance_properties(opening);
      if (!radiance) continue;
      StateModifiers states;
      for (const JsonObject& state : radiance->objects("states")) {
        states.push_back(state.string_or("modifier", ""));
      }
      const auto surface = surface_of_.find(opening.string_or("identifier", ""));
      if (states.size() < 2 || surface == surface_of_.end()) continue;
      const std::string name =
          radiance->string_or("dynamic_group_identifier", opening.string_or("identifier", ""));
      groups_[{name, states}].insert(surface->second);
    }
  }

  // The scene has the first state.
  static void add_state(const std::string& modifier, HoneybeeModifiers& modifiers,
                        std::vector<Material>& materials, WindowGroup& group) {
    const auto has_name = [&](const std::string& name) {
      return std::ranges::any_of(group.states, [&](const auto& s) { return s.name == name; });
    };
    WindowState state{.name = modifier};
    if (modifier.empty() || has_name(modifier)) {
      state.name = fmt::format("state {}", group.states.size() + 1);
    }
    if (!group.states.empty() && !modifier.empty()) {
      if (auto material = modifiers.material(modifier)) {
        state.material = static_cast<int>(materials.size());
        material->name = modifier;
        materials.push_back(std::move(*material));
      }
    }
    group.states.push_back(std::move(state));
  }

  std::map<std::string, int, std::less<>> surface_of_{};
  std::map<std::pair<std::string, StateModifiers>, std::set<int>> groups_{};
};

}  // namespace

OperatedWindows read_honeybee_windows(const Scene& scene) {
  const nlohmann::json document = read_honeybee_document(scene.file);
  const JsonObject model(scene.file, document, "");
  WindowCollector windows(scene);
  windows.collect(model);
  Scene unused;
  unused.bands = scene.bands;
  Remarks remarks;  // of the reader of the scene
  HoneybeeModifiers modifiers(scene.file, radiance_properties(model), unused, remarks);
  return windows.operated(model, modifiers);
}

}  // namespace lightwell
