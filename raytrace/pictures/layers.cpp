#include "raytrace/pictures/layers.h"

#include <algorithm>

namespace lightwell {

const NamedLayer& named(Layer layer) {
  return *std::find_if(named_layers.begin(), named_layers.end(),
                       [&](const NamedLayer& known) { return known.layer == layer; });
}

std::optional<Layer> layer_named(std::string_view name) {
  const auto found = std::find_if(named_layers.begin(), named_layers.end(),
                                  [&](const NamedLayer& known) { return known.name == name; });
  if (found == named_layers.end()) return std::nullopt;
  return found->layer;
}

std::vector<std::string> channel_names(Layer layer) {
  const NamedLayer& it = named(layer);
  const std::string stem = std::string(it.name) + ".";
  if (layer == Layer::patch) return {stem + std::string(it.components)};
  if (layer == Layer::coverage) return {std::string(it.components)};
  std::vector<std::string> names;
  for (const char component : it.components) names.push_back(stem + component);
  return names;
}

}  // namespace lightwell
