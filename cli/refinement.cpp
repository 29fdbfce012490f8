#include "cli/refinement.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "cli/arguments.h"

namespace lightwell {
namespace {

// "0.5%", "0.5 %", or the same as a share, "0.005"; 0 for "off".
std::optional<double> parse_tolerance(const std::string& text) {
  if (text == "off") return 0.0;
  double value = 0.0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc()) return std::nullopt;
  std::string unit(end, last);
  if (unit.starts_with(' ')) unit.erase(0, 1);
  constexpr double percent = 0.01;
  const double tolerance = unit == "%" ? percent * value : value;
  if (!unit.empty() && unit != "%") return std::nullopt;
  // Below a thousandth of a percent there is nothing but rounding; above all, nothing to refine.
  constexpr double least = 1e-5, most = 1.0;
  if (!(tolerance >= least && tolerance <= most)) return std::nullopt;
  return tolerance;
}

const char* outcome_name(RefineOutcome outcome) {
  switch (outcome) {
    case RefineOutcome::tolerance_reached:
      return "tolerance_reached";
    case RefineOutcome::max_elements_reached:
      return "max_elements_reached";
    case RefineOutcome::smallest_size_reached:
      return "smallest_size_reached";
    case RefineOutcome::off:
      break;
  }
  return "off";
}

}  // namespace

void add_refinement(CLI::App& command, RefineOptions& options, const std::string& group) {
  command
      .add_option_function<std::string>(
          "--refine",
          [&options](const std::string& text) {
            const auto tolerance = parse_tolerance(text);
            if (!tolerance) {
              throw CLI::ValidationError(
                  "--refine",
                  fmt::format("'{}' is no error to refine to; write a share of the mean irradiance "
                              "from 0.001% to 100%, such as 0.5%, or off",
                              text));
            }
            options.tolerance = *tolerance;
          },
          fmt::format("split elements until interpolation is this exact, or off (default {:g}%)",
                      100.0 * options.tolerance))
      ->type_name("ERROR")
      ->group(group);
  constexpr int most_elements = 20000000;  // as for meshes that are not refined
  command
      .add_option_function<int>(
          "--max-elements", [&options](int most) { options.max_elements = most; },
          "elements that refinement may make (default: about those of an even mesh of half the edge)")
      ->type_name("N")
      ->check(whole_number(1, most_elements))
      ->group(group);
}

std::string refinement_text(const RefineOptions& options) {
  if (!(options.tolerance > 0.0)) return " --refine off";
  return fmt::format(" --refine {:g}%", 100.0 * options.tolerance) +
         (options.max_elements > 0 ? fmt::format(" --max-elements {}", options.max_elements) : "");
}

Json refinement_json(const RefineReport& report) {
  return {{"outcome", outcome_name(report.outcome)},
          {"tolerance", report.tolerance},
          {"estimate", report.estimate},
          {"rounds", report.rounds},
          {"elements_at_first", report.elements_at_first},
          {"elements", report.elements},
          {"gathers", report.gathers}};
}

}  // namespace lightwell
