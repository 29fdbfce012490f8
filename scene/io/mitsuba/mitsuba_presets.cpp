#include "scene/io/mitsuba/mitsuba_presets.h"

#include <algorithm>
#include <array>

namespace lightwell {
namespace {

struct NamedIndex {
  std::string_view name;
  double index;
};

// Refractive indices in the visible that Mitsuba knows by name.
constexpr std::array named_indices = {
    NamedIndex{"vacuum", 1.0},         NamedIndex{"air", 1.000277},
    NamedIndex{"water ice", 1.31},     NamedIndex{"water", 1.333},
    NamedIndex{"acetone", 1.36},       NamedIndex{"ethanol", 1.361},
    NamedIndex{"fused quartz", 1.458}, NamedIndex{"pyrex", 1.47},
    NamedIndex{"acrylic glass", 1.49}, NamedIndex{"polypropylene", 1.49},
    NamedIndex{"bk7", 1.5046},         NamedIndex{"sodium chloride", 1.544},
    NamedIndex{"amber", 1.55},         NamedIndex{"pet", 1.575},
    NamedIndex{"diamond", 2.419},
};

struct NamedMetal {
  std::string_view name;
  std::array<float, 3> reflectance;  // r, g, b at normal incidence
};

// Akenine-Moeller, Haines & Hoffman, "Real-Time Rendering", 4th ed. 2018, table 9.2, to two digits.
// The red of gold, 1.00 in the table, is kept below 1.
constexpr std::array named_metals = {
    NamedMetal{"none", {1.0f, 1.0f, 1.0f}},  NamedMetal{"Ag", {0.97f, 0.96f, 0.92f}},
    NamedMetal{"Al", {0.91f, 0.92f, 0.92f}}, NamedMetal{"Au", {0.99f, 0.78f, 0.34f}},
    NamedMetal{"Cu", {0.95f, 0.64f, 0.54f}}, NamedMetal{"Cr", {0.55f, 0.56f, 0.55f}},
};

}  // namespace

std::optional<double> index_preset(std::string_view name) {
  const auto* const found = std::ranges::find(named_indices, name, &NamedIndex::name);
  if (found == named_indices.end()) return std::nullopt;
  return found->index;
}

std::vector<std::string> index_preset_names() {
  std::vector<std::string> names;
  for (const NamedIndex& each : named_indices) names.emplace_back(each.name);
  return names;
}

std::optional<Spectrum> metal_preset(std::string_view name) {
  const auto* const found = std::ranges::find(named_metals, name, &NamedMetal::name);
  if (found == named_metals.end()) return std::nullopt;
  const auto& [r, g, b] = found->reflectance;
  return Spectrum(Eigen::Array3f(r, g, b));
}

}  // namespace lightwell
