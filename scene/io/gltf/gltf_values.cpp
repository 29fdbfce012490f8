#include "scene/io/gltf/gltf_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace lightwell {

Spectrum gltf_color(const std::optional<JsonObject>& owner, const char* key, std::size_t count) {
  Spectrum result = Spectrum::Ones(3);
  if (!owner) return result;
  const std::vector<double> factors = owner->numbers(key, count);
  for (std::size_t c = 0; c < std::min<std::size_t>(3, factors.size()); ++c) {
    result[static_cast<int>(c)] = static_cast<float>(factors[c]);
  }
  return result;
}

double number_or(const std::optional<JsonObject>& owner, const char* key, double otherwise) {
  return owner ? owner->number_or(key, otherwise) : otherwise;
}

double share_or(const std::optional<JsonObject>& owner, const char* key, double otherwise) {
  return std::clamp(number_or(owner, key, otherwise), 0.0, 1.0);
}

BaseColor::BaseColor(const JsonObject& from)
    : owner(from.extension("KHR_materials_pbrSpecularGlossiness")) {
  if (owner) {
    factor = "diffuseFactor";
    texture = "diffuseTexture";
  } else {
    owner = from.object("pbrMetallicRoughness");
  }
}

std::string coordinates_of(const JsonObject& info) {
  const auto transform = info.extension("KHR_texture_transform");
  const std::size_t set = info.index_or("texCoord", 0);
  return fmt::format("TEXCOORD_{}", transform ? transform->index_or("texCoord", set) : set);
}

bool is_cut_by_alpha(const JsonObject& from) {
  const std::string mode = from.string_or("alphaMode", "OPAQUE");
  return mode == "MASK" || mode == "BLEND";
}

}  // namespace lightwell
