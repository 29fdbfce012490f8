#include "cli/refinement.h"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "cli/arguments.h"
#include "radiosity/solve_words.h"

namespace lightwell {
namespace {

const char* refine_outcome_name(RefineOutcome outcome) {
  switch (outcome) {
    case RefineOutcome::tolerance_reached:
      return "tolerance_reached";
    case RefineOutcome::max_elements_reached:
      return "max_elements_reached";
    case RefineOutcome::memory_limit_reached:
      return "memory_limit_reached";
    case RefineOutcome::time_limit_reached:
      return "time_limit_reached";
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
            const auto tolerance = text == "off" ? std::optional(0.0) : parse_share(text);
            if (!tolerance) {
              throw CLI::ValidationError(
                  "--refine",
                  fmt::format("'{}' is not a tolerance; write a share of the mean irradiance from "
                              "0.001% to 100%, such as 0.5%, or off",
                              text));
            }
            options.tolerance = *tolerance;
          },
          fmt::format("split elements until the interpolation error is below ERROR, or off "
                      "(default {:g}%)",
                      100.0 * options.tolerance))
      ->type_name("ERROR")
      ->group(group);
  constexpr int most_elements = 20000000;  // the limit of meshes without refinement
  command
      .add_option_function<int>(
          "--max-elements", [&options](int most) { options.max_elements = most; },
          "most elements of refinement (default: about those of an even mesh of half the edge)")
      ->type_name("N")
      ->check(whole_number(1, most_elements))
      ->group(group);
}

void add_accuracy(CLI::App& command, std::optional<Accuracy>& accuracy, const std::string& group) {
  command
      .add_option_function<std::string>(
          "--accuracy",
          [&accuracy, &command](const std::string& text) {
            refuse_beside(command, "--accuracy", {"--gather-rays"});
            const CLI::Option& refine = *command.get_option("--refine");
            if (refine.count() > 0 && refine.as<std::string>() != "off") {
              refuse_beside(command, "--accuracy", {"--refine"});
            }
            try {
              accuracy = parse_accuracy(text);
            } catch (const std::invalid_argument& error) {
              throw CLI::ValidationError("--accuracy", error.what());
            }
          },
          "target of the estimated RMS error: a share of the mean irradiance, 1%, or lux, 5lx")
      ->type_name("ERROR")
      ->group(group);
}

std::string accuracy_text(const std::optional<Accuracy>& accuracy) {
  if (!accuracy) return "";
  return accuracy->share > 0.0 ? fmt::format(" --accuracy {:g}%", 100.0 * accuracy->share)
                               : fmt::format(" --accuracy {:g}lx", accuracy->lux);
}

std::string refinement_text(const RefineOptions& options) {
  if (!(options.tolerance > 0.0)) return " --refine off";
  return fmt::format(" --refine {:g}%", 100.0 * options.tolerance) +
         (options.max_elements > 0 ? fmt::format(" --max-elements {}", options.max_elements) : "");
}

Json refinement_json(const RefineReport& report) {
  return {{"outcome", refine_outcome_name(report.outcome)},
          {"tolerance", report.tolerance},
          {"estimate", report.estimate},
          {"rounds", report.rounds},
          {"elements_at_first", report.elements_at_first},
          {"elements", report.elements},
          {"gathers", report.gathers}};
}

}  // namespace lightwell
