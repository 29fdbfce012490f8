#include "standards/requirement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lightwell {

double share(double part, double whole) {
  return whole > 0.0 ? part / whole : 0.0;
}

const char* figure_symbol(Figure figure) {
  constexpr std::array names = {"E_m",
                                "E_min",
                                "U_0",
                                "E_max / E_min",
                                "E_m,z",
                                "E_m,z / E_m",
                                "UGR",
                                "L_m",
                                "U_o",
                                "U_o,wet",
                                "U_l",
                                "f_TI",
                                "R_EI",
                                "E_v,min",
                                "E_sc,min",
                                "E_v,m",
                                "E_v,min / E_v,m",
                                "E_v,min / E_v,max",
                                "gradient",
                                "R_G",
                                "R_a"};
  static_assert(names.size() == static_cast<std::size_t>(Figure::colour_rendering) + 1,
                "each figure has a symbol");
  return names[static_cast<std::size_t>(figure)];
}

const char* verdict_name(Verdict standing) {
  switch (standing) {
    case Verdict::met:
      return "met";
    case Verdict::missed:
      return "missed";
    case Verdict::too_close:
      break;
  }
  return "too close to tell";
}

Verdict verdict_of(const Requirement& requirement) {
  if (!requirement.value) return Verdict::met;
  const double above = *requirement.value - requirement.limit;
  const double spare = requirement.is_upper ? -above : above;
  const bool is_known = !std::isnan(requirement.within);
  if (!is_known || std::abs(spare) < requirement.within) return Verdict::too_close;
  return spare >= 0.0 ? Verdict::met : Verdict::missed;
}

std::vector<std::span<const Requirement>> by_area(std::span<const Requirement> requirements) {
  std::vector<std::span<const Requirement>> areas;
  for (std::size_t begin = 0; begin < requirements.size();) {
    std::size_t end = begin;
    while (end < requirements.size() && requirements[end].area == requirements[begin].area) ++end;
    areas.push_back(requirements.subspan(begin, end - begin));
    begin = end;
  }
  return areas;
}

Verdict verdict_of(std::span<const Requirement> requirements) {
  Verdict worst = Verdict::met;
  for (const Requirement& requirement : requirements) {
    if (requirement.is_recommended) continue;
    const Verdict standing = verdict_of(requirement);
    if (standing == Verdict::missed) return Verdict::missed;
    if (standing == Verdict::too_close) worst = Verdict::too_close;
  }
  return worst;
}

double known_bound(const LuxField& field, double lux) {
  const double within = bound_at(field, lux);
  return std::isfinite(within) ? within : 0.0;
}

Requirement mean_at_least(double limit, const GridField& of) {
  const LuxField& field = *of.field;
  return {.place = of.name,
          .figure = Figure::mean,
          .limit = limit,
          .value = field.mean,
          .within = field.mean_within * field.mean};
}

Requirement uniformity_at_least(double limit, const GridField& of) {
  const LuxField& field = *of.field;
  return {.place = of.name,
          .figure = Figure::uniformity,
          .limit = limit,
          .value = field.uniformity,
          .within = share(known_bound(field, field.least), field.mean) +
                    field.uniformity * field.mean_within};
}

Requirement least_at_least(double limit, const GridField& of) {
  const LuxField& field = *of.field;
  return {.place = of.name,
          .figure = Figure::least,
          .limit = limit,
          .value = field.least,
          .within = known_bound(field, field.least)};
}

Requirement diversity_at_most(double limit, const GridField& of) {
  const LuxField& field = *of.field;
  Requirement made{.place = of.name, .figure = Figure::diversity, .is_upper = true, .limit = limit};
  if (!(field.least > 0.0)) {
    made.value = std::numeric_limits<double>::infinity();
    return made;
  }
  made.value = field.greatest / field.least;
  made.within = *made.value * (share(known_bound(field, field.greatest), field.greatest) +
                               share(known_bound(field, field.least), field.least));
  return made;
}

void add_colour_rendering(double limit, const std::vector<NamedRating>& luminaires,
                          const std::string& area, std::vector<Requirement>& requirements) {
  const auto worst = std::ranges::min_element(luminaires, {}, [](const NamedRating& one) {
    const bool is_known = !std::isnan(one.value) && !std::isnan(one.within);
    return is_known ? one.value - one.within : -std::numeric_limits<double>::infinity();
  });
  if (!(limit > 0.0) || worst == luminaires.end()) return;
  requirements.push_back({.area = area,
                          .place = worst->name,
                          .figure = Figure::colour_rendering,
                          .limit = limit,
                          .value = worst->value,
                          .within = worst->within});
}

}  // namespace lightwell
