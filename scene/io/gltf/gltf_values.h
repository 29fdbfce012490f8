#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "scene/bands.h"
#include "scene/io/json_object.h"

namespace lightwell {

/// Colour factors of an object's key; white if the object or the key is missing.
Spectrum gltf_color(const std::optional<JsonObject>& owner, const char* key, std::size_t count);
/// Number of a key; `otherwise` if the object or the key is missing.
double number_or(const std::optional<JsonObject>& owner, const char* key, double otherwise);
/// The same, within [0,1].
double share_or(const std::optional<JsonObject>& owner, const char* key, double otherwise);

/// Source of a material's base colour: the object with the picture, and the keys of factor and
/// picture.
struct BaseColor {
  std::optional<JsonObject> owner{};
  const char* factor = "baseColorFactor";
  const char* texture = "baseColorTexture";

  explicit BaseColor(const JsonObject& from);
  std::optional<JsonObject> info() const { return owner ? owner->object(texture) : std::nullopt; }
};

/// Name of the set of texture coordinates of a texture's use.
std::string coordinates_of(const JsonObject& info);
/// Returns whether alpha of the material's base colour says what is there.
bool is_cut_by_alpha(const JsonObject& from);

}  // namespace lightwell
