#include "scene/io/honeybee/honeybee_modifiers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "scene/io/honeybee/honeybee_bsdf.h"

namespace lightwell {
namespace {

// A kind's place in modifier sets, and its generic modifier, which Honeybee uses without a set.
struct Slot {
  const char* table;
  const char* key;
  const char* generic;
  double value;  // reflectance of a grey plastic, or transmissivity of glass
  bool is_glass = false;
};

// Windows that pass 0.64 and 0.88 along their normal, and their transmissivities.
constexpr const char *outer_pane = "generic_exterior_window_vis_0.64",
                     *inner_pane = "generic_interior_window_vis_0.88";
constexpr double outer_glass = 0.6975761815384331, inner_glass = 0.9584154328610596;

// Slots in the order of HoneybeeKind.
constexpr auto slots = std::to_array<Slot>({
    {"wall_set", "exterior_modifier", "generic_wall_0.50", 0.5},
    {"wall_set", "interior_modifier", "generic_wall_0.50", 0.5},
    {"floor_set", "exterior_modifier", "generic_floor_0.20", 0.2},
    {"floor_set", "interior_modifier", "generic_floor_0.20", 0.2},
    {"roof_ceiling_set", "exterior_modifier", "generic_ceiling_0.80", 0.8},
    {"roof_ceiling_set", "interior_modifier", "generic_ceiling_0.80", 0.8},
    {"aperture_set", "window_modifier", outer_pane, outer_glass, true},
    {"aperture_set", "operable_modifier", outer_pane, outer_glass, true},
    {"aperture_set", "skylight_modifier", outer_pane, outer_glass, true},
    {"aperture_set", "interior_modifier", inner_pane, inner_glass, true},
    {"door_set", "exterior_modifier", "generic_opaque_door_0.50", 0.5},
    {"door_set", "interior_modifier", "generic_opaque_door_0.50", 0.5},
    {"door_set", "overhead_modifier", "generic_opaque_door_0.50", 0.5},
    {"door_set", "exterior_glass_modifier", outer_pane, outer_glass, true},
    {"door_set", "interior_glass_modifier", inner_pane, inner_glass, true},
    {"shade_set", "exterior_modifier", "generic_exterior_shade_0.35", 0.35},
    {"shade_set", "interior_modifier", "generic_interior_shade_0.50", 0.5},
    {"", "", "generic_context_0.20", 0.2},
});
static_assert(slots.size() == static_cast<std::size_t>(HoneybeeKind::context) + 1);

const Slot& slot_of(HoneybeeKind kind) {
  return slots[static_cast<std::size_t>(kind)];
}

// Names of the arguments of a modifier in RADIANCE's order, with Honeybee's values for those that a
// file leaves out.
using Arguments = std::vector<std::pair<const char*, double>>;

std::optional<Arguments> arguments_of(const std::string& type) {
  const Arguments reflecting = {{"r_reflectance", 0.0},
                                {"g_reflectance", 0.0},
                                {"b_reflectance", 0.0},
                                {"specularity", type == "Metal" ? 0.9 : 0.0},
                                {"roughness", 0.0}};
  const Arguments shining = {{"r_emittance", 0.0}, {"g_emittance", 0.0}, {"b_emittance", 0.0}};
  const auto with = [](Arguments first, const Arguments& more) {
    first.insert(first.end(), more.begin(), more.end());
    return first;
  };
  if (type == "Plastic" || type == "Metal") return reflecting;
  if (type == "Trans") {
    return with(reflecting, {{"transmitted_diff", 0.0}, {"transmitted_spec", 0.0}});
  }
  if (type == "Glass") {
    return Arguments{
        {"r_transmissivity", 0.0}, {"g_transmissivity", 0.0}, {"b_transmissivity", 0.0}};
  }
  if (type == "Light") return shining;
  if (type == "Glow") return with(shining, {{"max_radius", 0.0}});
  if (type == "Mirror") {
    return Arguments{{"r_reflectance", 1.0}, {"g_reflectance", 1.0}, {"b_reflectance", 1.0}};
  }
  return std::nullopt;
}

bool is_shade(HoneybeeKind kind) {
  return kind == HoneybeeKind::outdoor_shade || kind == HoneybeeKind::indoor_shade ||
         kind == HoneybeeKind::context;
}

std::string lower_case(std::string type) {
  type.front() = static_cast<char>(type.front() - 'A' + 'a');
  return type;
}

}  // namespace

std::optional<JsonObject> radiance_properties(const JsonObject& object) {
  const auto properties = object.object("properties");
  return properties ? properties->object("radiance") : std::nullopt;
}

HoneybeeModifiers::HoneybeeModifiers(const std::filesystem::path& file,
                                     const std::optional<JsonObject>& radiance, Scene& scene,
                                     Remarks& remarks)
    : file_(file), scene_(scene), remarks_(remarks), materials_(scene, remarks) {
  if (!radiance) return;
  if (const auto usual = radiance->object("global_modifier_set")) {
    for (const JsonObject& modifier : usual->objects("modifiers")) try_to_define(modifier);
  }
  for (const JsonObject& modifier : radiance->objects("modifiers")) try_to_define(modifier);
  for (const JsonObject& set : radiance->objects("modifier_sets")) {
    sets_.insert_or_assign(set.string_or("identifier", ""), set);
  }
}

void HoneybeeModifiers::try_to_define(const JsonObject& modifier) {
  remarks_.attempt("Modifiers that cannot be read were left out", modifier.place(),
                   [&] { define(modifier); });
}

void HoneybeeModifiers::define(const JsonObject& modifier) {
  const std::string type = modifier.string_or("type", ""),
                    name = modifier.string_or("identifier", "");
  RadiancePrimitive primitive{.modifier = std::string(radiance_void),
                              .name = name,
                              .location = {.file = &file_, .line = 0}};
  if (type == "BSDF") {
    primitive.type = "trans";
    primitive.reals = trans_of_bsdf(modifier, remarks_);
  } else if (type == "Void") {
    primitive.type = "antimatter";
  } else if (const auto arguments = arguments_of(type)) {
    primitive.type = lower_case(type);
    for (const auto& [key, otherwise] : *arguments) {
      primitive.reals.push_back(modifier.number_or(key, otherwise));
    }
    if (type == "Glass" && modifier.has("refraction_index")) {
      primitive.reals.push_back(modifier.number_or("refraction_index", 1.52));
    }
  } else {
    modifier.fail(fmt::format(
        "modifier '{}' is of the type '{}', which is none of Plastic, Metal, Trans, Glass, Light, "
        "Glow, Mirror, BSDF and Void",
        name, type));
  }
  materials_.define(primitive);
  primitives_.insert_or_assign(name, std::move(primitive));
}

// Defines the generic modifier of a name.
void HoneybeeModifiers::define_generic(const std::string& name) {
  const auto found = std::ranges::find(slots, std::string_view(name), [](const Slot& slot) {
    return std::string_view(slot.generic);
  });
  if (found == slots.end()) return;
  RadiancePrimitive primitive{.modifier = std::string(radiance_void),
                              .type = found->is_glass ? "glass" : "plastic",
                              .name = name,
                              .reals = {found->value, found->value, found->value},
                              .location = {.file = &file_, .line = 0}};
  if (!found->is_glass) primitive.reals.insert(primitive.reals.end(), {0.0, 0.0});
  materials_.define(primitive);
  primitives_.emplace(name, std::move(primitive));
}

// The name of a modifier that a set has for a kind of object. Sets name modifiers, or contain them.
std::optional<std::string> HoneybeeModifiers::from_set(const std::string& set, HoneybeeKind kind) {
  const auto found = sets_.find(set);
  if (found == sets_.end()) return std::nullopt;
  const Slot& slot = slot_of(kind);
  const auto table = found->second.object(slot.table);
  if (!table || !table->has(slot.key)) return std::nullopt;
  if (table->is_object(slot.key)) {
    const JsonObject modifier = *table->object(slot.key);
    const std::string name = modifier.string_or("identifier", "");
    if (!primitives_.contains(name)) try_to_define(modifier);
    return name;
  }
  return table->string_or(slot.key, "");
}

std::optional<int> HoneybeeModifiers::named(const std::string& modifier) {
  if (!primitives_.contains(modifier)) define_generic(modifier);
  return materials_.of_surface({.modifier = modifier,
                                .type = "polygon",
                                .name = modifier,
                                .location = {.file = &file_, .line = 0}});
}

std::optional<Material> HoneybeeModifiers::material(const std::string& modifier) {
  if (!primitives_.contains(modifier)) define_generic(modifier);
  const auto found = primitives_.find(modifier);
  if (found == primitives_.end()) return std::nullopt;
  return read_radiance_material(found->second, {}, remarks_);
}

// The modifier that an object has where it is in none of its states.
std::string HoneybeeModifiers::without_states(const JsonObject& object, HoneybeeKind kind,
                                              const std::string& set) {
  if (const auto radiance = radiance_properties(object)) {
    if (const std::string own = radiance->string_or("modifier", ""); !own.empty()) return own;
  }
  if (!set.empty() && !sets_.contains(set)) {
    remarks_.add("Modifier sets that are not defined were read as the generic one", set);
  }
  return from_set(set, kind).value_or(slot_of(kind).generic);
}

void HoneybeeModifiers::remark_states(const JsonObject& object, HoneybeeKind kind,
                                      const std::vector<JsonObject>& states) {
  const std::string name = object.string_or("identifier", object.place());
  if (is_shade(kind) && states.size() > 1) {
    remarks_.add("Shades that change were read in their first state", name);
  }
  for (const JsonObject& state : states) {
    if (!state.objects("shades").empty() || state.has("vmtx_geometry")) {
      remarks_.add("Shades and geometry that a state adds were left out", name);
    }
  }
}

std::vector<std::string> HoneybeeModifiers::of_states(const JsonObject& object, HoneybeeKind kind,
                                                      const std::string& set) {
  std::vector<std::string> names;
  const auto radiance = radiance_properties(object);
  if (!radiance) return names;
  for (const JsonObject& state : radiance->objects("states")) {
    const std::string of_state = state.string_or("modifier", "");
    names.push_back(of_state.empty() ? without_states(object, kind, set) : of_state);
  }
  return names;
}

std::optional<int> HoneybeeModifiers::of(const JsonObject& object, HoneybeeKind kind,
                                         const std::string& set) {
  const std::vector<std::string> states = of_states(object, kind, set);
  if (states.empty()) return named(without_states(object, kind, set));
  remark_states(object, kind, radiance_properties(object)->objects("states"));
  return named(states.front());
}

}  // namespace lightwell
