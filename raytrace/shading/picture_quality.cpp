#include "raytrace/shading/picture_quality.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace lightwell {
namespace {

// Half the noise takes four times the samples; `good` are the defaults of RenderOptions.
constexpr std::array<PictureQuality, 3> picture_qualities{{
    {.name = "draft", .shadow_rays = 16, .photons = 1 << 16, .noise = 0.1},
    {.name = "good", .shadow_rays = 64, .photons = 1 << 19, .noise = 0.02},
    {.name = "final", .shadow_rays = most_shadow_rays, .photons = 1 << 21, .noise = 0.01},
}};

struct NamedPass {
  const char* name;
  Pass pass;
};
constexpr std::array<NamedPass, 5> passes{{{"auto", Pass::automatic},
                                           {"interpolate", Pass::interpolate},
                                           {"direct", Pass::direct},
                                           {"gather", Pass::gather},
                                           {"virtual-lights", Pass::virtual_lights}}};

template <class Table>
std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  for (const auto& known : table) names.emplace_back(known.name);
  return names;
}

template <class Table>
const auto& find_named(const Table& table, std::string_view name, const char* what) {
  const auto at = std::ranges::find_if(table, [&](const auto& each) { return name == each.name; });
  if (at != table.end()) return *at;
  throw std::invalid_argument(fmt::format("there is no {} '{}'; choose from: {}", what, name,
                                          fmt::join(names_of(table), ", ")));
}

}  // namespace

std::vector<std::string> picture_quality_names() {
  return names_of(picture_qualities);
}

PictureQuality picture_quality(std::string_view name) {
  return find_named(picture_qualities, name, "quality");
}

std::vector<std::string> pass_names() {
  return names_of(passes);
}

RenderOptions picture_options(std::string_view pass, std::string_view quality,
                              const PictureQuality& numbers) {
  RenderOptions options;
  options.pass = find_named(passes, pass, "pass").pass;
  const bool is_draft = quality == "draft";
  options.has_records = !is_draft;
  // A draft takes all light of virtual lights from the mesh.
  if (options.pass == Pass::virtual_lights && is_draft) {
    options.pass = Pass::interpolate;
    options.max_subdivision = 1;
    options.glossy_rays = 1;
    options.sampling.least = 4;
  }
  options.photons = numbers.photons;
  options.sampling.noise = static_cast<float>(numbers.noise);
  options.shadows.max_rays = numbers.shadow_rays;
  options.shadows.min_rays = std::min(options.shadows.min_rays, numbers.shadow_rays);
  return options;
}

}  // namespace lightwell
