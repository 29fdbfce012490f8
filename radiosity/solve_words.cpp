#include "radiosity/solve_words.h"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>

namespace lightwell {
namespace {

// A number and its unit: "0.5%", "0.5 %", "5lx".
struct Quantity {
  double value = 0.0;
  std::string unit{};
};

std::optional<Quantity> parse_quantity(const std::string& text) {
  Quantity quantity;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, quantity.value);
  if (error != std::errc()) return std::nullopt;
  quantity.unit.assign(end, last);
  if (quantity.unit.starts_with(' ')) quantity.unit.erase(0, 1);
  return quantity;
}

std::optional<Accuracy> accuracy_in(const std::string& text) {
  if (const auto share = parse_share(text)) return Accuracy{.share = *share};
  const auto quantity = parse_quantity(text);
  if (!quantity || quantity->unit != "lx") return std::nullopt;
  constexpr double least = 1e-6, most = 1e9;
  if (!(quantity->value >= least && quantity->value <= most)) return std::nullopt;
  return Accuracy{.lux = quantity->value};
}

// True for a number without a unit that means per cent more probably than a share: "1".
bool is_doubtful(const std::string& text, const Accuracy& accuracy) {
  constexpr double least = 0.25;  // an error of more than 16 % takes no fewer rays than that
  const auto quantity = parse_quantity(text);
  return quantity && quantity->unit.empty() && accuracy.share >= least;
}

// Progressive refinement stores no form factors and is not among solver_methods.
constexpr std::string_view progressive = "progressive";

}  // namespace

std::optional<double> parse_share(const std::string& text) {
  const auto quantity = parse_quantity(text);
  if (!quantity || (!quantity->unit.empty() && quantity->unit != "%")) return std::nullopt;
  constexpr double percent = 0.01;
  const double share = quantity->unit == "%" ? percent * quantity->value : quantity->value;
  // Errors below 0.001 % are those of rounding; above 100 % nothing would be refined.
  constexpr double least = 1e-5, most = 1.0;
  if (!(share >= least && share <= most)) return std::nullopt;
  return share;
}

Accuracy parse_accuracy(const std::string& text) {
  const std::optional<Accuracy> accuracy = accuracy_in(text);
  if (accuracy && is_doubtful(text, *accuracy)) {
    throw std::invalid_argument(
        fmt::format("'{0}' would be {1:g} %; write {0}% or {1:g}%", text, 100.0 * accuracy->share));
  }
  if (accuracy) return *accuracy;
  throw std::invalid_argument(
      fmt::format("'{}' is no accuracy; write a share of the mean irradiance from 0.001% to 100%, "
                  "such as 1%, or an illuminance, such as 5lx",
                  text));
}

std::vector<std::string> solver_names() {
  std::vector<std::string> names;
  for (const NamedSolverMethod& known : solver_methods) names.emplace_back(known.name);
  names.emplace_back(progressive);
  return names;
}

void choose_solver(std::string_view name, SolveOptions& options) {
  if (name == progressive) {
    options.progressive = {.tolerance = options.solver.tolerance,
                           .overshooting = Overshooting::ambient};
  } else {
    options.solver_method = solver_method(name);
  }
}

}  // namespace lightwell
