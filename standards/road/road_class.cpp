#include "standards/road/road_class.h"

#include <fmt/format.h>

#include <algorithm>

namespace lightwell {
namespace {

// EN 13201-2:2015, table 1.
void add_luminance_classes(std::vector<RoadClass>& classes) {
  constexpr double lanes_dry[6][5] = {{2.00, 0.40, 0.70, 10, 0.35}, {1.50, 0.40, 0.70, 10, 0.35},
                                      {1.00, 0.40, 0.60, 15, 0.30}, {0.75, 0.40, 0.60, 15, 0.30},
                                      {0.50, 0.35, 0.40, 15, 0.30}, {0.30, 0.35, 0.40, 20, 0.30}};
  constexpr double wet = 0.15;
  int number = 0;
  for (const auto& [L, U_o, U_l, f_TI, R_EI] : lanes_dry) {
    classes.push_back({.key = fmt::format("M{}", ++number),
                       .luminance = L,
                       .uniformity = U_o,
                       .wet_uniformity = wet,
                       .longitudinal_uniformity = U_l,
                       .threshold_increment = f_TI,
                       .edge_ratio = R_EI});
  }
}

// EN 13201-2:2015, tables 2 and 3. The mean of a P class must not exceed 1.5 times its limit, which
// bounds the contrast.
void add_illuminance_classes(std::vector<RoadClass>& classes) {
  int number = 0;
  for (const double mean : {50.0, 30.0, 20.0, 15.0, 10.0, 7.5}) {
    classes.push_back({.key = fmt::format("C{}", number++), .uniformity = 0.40, .mean = mean});
  }
  constexpr double paths[6][2] = {{15.0, 3.0}, {10.0, 2.0}, {7.5, 1.5},
                                  {5.0, 1.0},  {3.0, 0.6},  {2.0, 0.4}};
  number = 0;
  for (const auto& [mean, least] : paths) {
    classes.push_back({.key = fmt::format("P{}", ++number),
                       .mean = mean,
                       .greatest_mean = 1.5 * mean,
                       .least = least});
  }
  classes.push_back({.key = "P7"});
}

// EN 13201-2:2015, tables 5 and 6.
void add_upright_classes(std::vector<RoadClass>& classes) {
  int number = 0;
  for (const double least : {10.0, 7.5, 5.0, 3.0, 2.0, 1.5, 1.0, 0.75, 0.5}) {
    classes.push_back({.key = fmt::format("SC{}", ++number), .semicylindrical = least});
  }
  number = 0;
  for (const double least : {50.0, 30.0, 10.0, 7.5, 5.0, 0.5}) {
    classes.push_back({.key = fmt::format("EV{}", ++number), .vertical = least});
  }
}

}  // namespace

const std::vector<RoadClass>& road_classes() {
  static const auto all = [] {
    std::vector<RoadClass> classes;
    add_luminance_classes(classes);
    add_illuminance_classes(classes);
    add_upright_classes(classes);
    return classes;
  }();
  return all;
}

std::optional<RoadClass> find_road_class(const std::string& key) {
  const auto& all = road_classes();
  const auto at = std::ranges::find(all, key, &RoadClass::key);
  if (at == all.end()) return {};
  return *at;
}

}  // namespace lightwell
