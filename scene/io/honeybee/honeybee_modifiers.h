#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/io/json_object.h"
#include "scene/io/radiance/radiance_materials.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Kinds of objects of a Honeybee model, by which modifier sets and generic modifiers are chosen.
enum class HoneybeeKind {
  wall,
  inner_wall,
  floor,
  inner_floor,
  roof,
  ceiling,
  window,
  operable_window,
  skylight,
  inner_window,
  door,
  inner_door,
  overhead_door,
  glass_door,
  inner_glass_door,
  outdoor_shade,
  indoor_shade,
  context
};

/// The modifiers (materials) of a Honeybee model.
///
/// An object has the modifier of its first state, else that which it names itself, else that of its
/// room's modifier set for objects of its kind, else Honeybee's generic one. Modifiers are those of
/// RADIANCE, and are read as such.
class HoneybeeModifiers {
 public:
  /// `radiance` is the object properties.radiance of the model, if there is one. Keeps references
  /// to `file`, `scene` and `remarks`. Modifiers that cannot be read are left out, with a remark.
  HoneybeeModifiers(const std::filesystem::path& file, const std::optional<JsonObject>& radiance,
                    Scene& scene, Remarks& remarks);

  /// Index of the material of an object in the scene; empty for objects that cannot be seen. `set`
  /// names the modifier set of the object's room, or is empty.
  std::optional<int> of(const JsonObject& object, HoneybeeKind kind, const std::string& set);
  /// Names of the modifiers of an object's states: each state's own, else that which the object has
  /// without states. Empty for an object without states.
  std::vector<std::string> of_states(const JsonObject& object, HoneybeeKind kind,
                                     const std::string& set);
  /// The material of a modifier, which is not added to the scene; empty if the modifier is not
  /// defined, or cannot be seen.
  std::optional<Material> material(const std::string& modifier);

 private:
  void define(const JsonObject& modifier);
  void try_to_define(const JsonObject& modifier);
  void define_generic(const std::string& name);
  std::optional<int> named(const std::string& modifier);
  std::string without_states(const JsonObject& object, HoneybeeKind kind, const std::string& set);
  void remark_states(const JsonObject& object, HoneybeeKind kind,
                     const std::vector<JsonObject>& states);
  std::optional<std::string> from_set(const std::string& set, HoneybeeKind kind);

  const std::filesystem::path& file_;
  Scene& scene_;
  Remarks& remarks_;
  RadianceMaterials materials_;
  std::map<std::string, RadiancePrimitive, std::less<>> primitives_{};
  std::map<std::string, JsonObject, std::less<>> sets_{};
};

/// The object properties.radiance of an object of a model.
std::optional<JsonObject> radiance_properties(const JsonObject& object);

}  // namespace lightwell
