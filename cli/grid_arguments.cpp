#include "cli/grid_arguments.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "cli/arguments.h"

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

void GridArguments::add_to(CLI::App& command) {
  command.add_option("--surface", request.surfaces, "measure on this surface; may be repeated")
      ->type_name("NAME")
      ->type_size(1)
      ->allow_extra_args(false);
  command
      .add_option_function<std::vector<std::string>>(
          "--plane",
          [this](const std::vector<std::string>& texts) {
            for (const auto& text : texts) {
              request.planes.push_back(named_number(text, '@', "--plane", 0.0));
            }
          },
          "measure on a plane at this height above a surface, or above all that fit a pattern: "
          "floor@0.75, '*Floor@0.8'; may be repeated")
      ->type_name("NAME@HEIGHT")
      ->type_size(1)
      ->allow_extra_args(false);
  constexpr double farthest = 1e9;  // as points of scenes
  command
      .add_option("--margin", request.margin,
                  "strip along the outline of planes that is left out (default 0.5 m)")
      ->type_name("LENGTH")
      ->check(number_within(0.0, farthest, "a length"));
  command
      .add_option("--spacing", request.spacing,
                  "largest distance between points (default: by EN 12464-1)")
      ->type_name("LENGTH")
      ->check(positive());
}

GridRequest GridArguments::in_metres(const Scene& scene) const {
  const double metres = scene.metres_per_unit;
  GridRequest scaled = request;
  for (NamedNumber& plane : scaled.planes) plane.value *= metres;
  if (scaled.margin) *scaled.margin *= metres;
  scaled.spacing *= metres;
  return scaled;
}

void add_watts(CLI::App& command, std::vector<NamedNumber>& watts) {
  command
      .add_option_function<std::vector<std::string>>(
          "--watts",
          [&watts](const std::vector<std::string>& texts) {
            for (const auto& text : texts) {
              watts.push_back(
                  named_number(text, '=', "--watts", std::numeric_limits<double>::min()));
            }
          },
          "electric power of each luminaire of this name; may be repeated")
      ->type_name("NAME=W")
      ->type_size(1)
      ->allow_extra_args(false);
}

}  // namespace lightwell
