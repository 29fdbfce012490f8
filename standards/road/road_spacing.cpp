#include "standards/road/road_spacing.h"

#include <algorithm>
#include <cmath>

#include "scene/parallel.h"
#include "standards/road/road_figures.h"
#include "standards/road/road_light.h"

namespace lightwell {

std::vector<SpacingRange> spacings_that_meet(const Road& road, const Progress& progress) {
  constexpr double least = 1.0, greatest = 500.0;  // m
  constexpr double heights_least = 0.5;
  // The luminaires of two staggered rows are half a spacing apart.
  const double apart = road.luminaires.arrangement == RoadArrangement::staggered ? 2.0 : 1.0;
  const double heights_most = apart * (heights_around_point + heights_beyond_point);
  constexpr int steps_of_metre = static_cast<int>(1.0 / spacing_step + 0.5);
  const double height = road.luminaires.height;
  const int first =
      static_cast<int>(std::ceil(steps_of_metre * std::max(least, heights_least * height)));
  const int last =
      static_cast<int>(std::floor(steps_of_metre * std::min(greatest, heights_most * height)));
  const auto spacing_of = [&](int number) {
    return static_cast<double>(first + number) / steps_of_metre;
  };
  const int count = last - first + 1;
  std::vector<char> is_met(static_cast<std::size_t>(count), 0);
  constexpr int block = 64, grain = 4;  // the caller may interrupt between blocks
  for (int begin = 0; begin < count; begin += block) {
    report(progress, "trying spacings", static_cast<double>(begin) / count);
    parallel_for(std::min(block, count - begin), grain, [&](int from, int to) {
      Road tried = road;
      for (int i = begin + from; i < begin + to; ++i) {
        tried.luminaires.spacing = spacing_of(i);
        is_met[static_cast<std::size_t>(i)] = road_figures(tried).meets_all() ? 1 : 0;
      }
    });
  }
  std::vector<SpacingRange> ranges;
  for (int i = 0; i < count; ++i) {
    if (is_met[static_cast<std::size_t>(i)] == 0) continue;
    const bool continues = i > 0 && is_met[static_cast<std::size_t>(i - 1)] != 0;
    if (!continues) ranges.push_back({spacing_of(i), spacing_of(i)});
    ranges.back().greatest = spacing_of(i);
  }
  return ranges;
}

}  // namespace lightwell
