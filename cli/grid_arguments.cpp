#include "cli/grid_arguments.h"

#include <fmt/format.h>

#include <charconv>

#include "cli/arguments.h"
#include "scene/errors.h"
#include "scene/io/nearest_name.h"

namespace lightwell {

NamedNumber named_number(const std::string& text, char mark, const char* option, double least) {
  const std::size_t at = text.rfind(mark);
  NamedNumber named{.name = text.substr(0, at)};
  if (at != std::string::npos && at > 0) {
    const char* const last = text.data() + text.size();
    const auto [end, bad] = std::from_chars(text.data() + at + 1, last, named.value);
    if (bad == std::errc() && end == last && named.value >= least && named.value < 1e9)
      return named;
  }
  throw CLI::ValidationError(option, fmt::format("'{}' is not NAME{}NUMBER with a number {} 0",
                                                 text, mark, least > 0.0 ? "above" : "from"));
}

namespace {

int find_surface(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    if (scene.surfaces[i].name == name) return static_cast<int>(i);
    names.push_back(scene.surfaces[i].name);
  }
  throw InputError(
      fmt::format("{}: there is no surface '{}'.{} 'lightwell info {} --surfaces' lists all.",
                  scene.file.string(), name, did_you_mean(name, names), scene.file.string()));
}

}  // namespace

void GridArguments::add_to(CLI::App& command) {
  command.add_option("--surface", surfaces, "measure on this surface; may be repeated")
      ->type_name("NAME")
      ->type_size(1)
      ->allow_extra_args(false);
  command
      .add_option_function<std::vector<std::string>>(
          "--plane",
          [this](const std::vector<std::string>& texts) {
            for (const auto& text : texts) {
              planes.push_back(named_number(text, '@', "--plane", 0.0));
            }
          },
          "measure on a plane at this height above a surface: floor@0.75; may be repeated")
      ->type_name("NAME@HEIGHT")
      ->type_size(1)
      ->allow_extra_args(false);
  command
      .add_option("--margin", margin,
                  "strip along the outline of planes that is left out (default 0.5 m)")
      ->type_name("LENGTH")
      ->check(CLI::NonNegativeNumber.description(""));  // no ":NONNEGATIVE" in --help
  command
      .add_option("--spacing", spacing, "largest distance between points (default: by EN 12464-1)")
      ->type_name("LENGTH")
      ->check(positive());
}

std::vector<LuxGrid> GridArguments::grids(const Scene& scene, const LightingDesign& design,
                                          const Eigen::Vector3d& up) const {
  std::vector<LuxGrid> grids;
  const double metres = scene.metres_per_unit;
  const double greatest = spacing * metres;
  constexpr double strip = 0.5;  // m; strip along walls that EN 12464-1 leaves out
  const double left_out = margin ? *margin * metres : strip;
  for (const CalculationGrid& grid : design.grids) {
    const double usual = grid.height > 0.0 ? left_out : 0.0;
    grids.push_back(lux_grid(scene, grid.surface, up,
                             {.height = grid.height,
                              .margin = grid.margin.value_or(usual),
                              .spacing = grid.spacing > 0.0 ? grid.spacing : greatest}));
    grids.back().name = grid.name;
  }
  for (const std::string& name : surfaces) {
    grids.push_back(lux_grid(scene, find_surface(scene, name), up, {.spacing = greatest}));
  }
  for (const NamedNumber& plane : planes) {
    grids.push_back(
        lux_grid(scene, find_surface(scene, plane.name), up,
                 {.height = plane.value * metres, .margin = left_out, .spacing = greatest}));
    grids.back().name = fmt::format("{} + {:g} {}", plane.name, plane.value, scene.unit_name);
  }
  return grids;
}

}  // namespace lightwell
