#include "daylight/daylight_glare.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiosity/visibility/clear_panes.h"
#include "raytrace/readings/glare.h"
#include "scene/degree.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

double capped_position_index(const Camera& eye, const Eigen::Vector3d& towards) {
  return std::min(position_index(eye, towards), most_position_index);
}

// Sums over the rays of one cell.
struct CellSum {
  double seen = 0.0, passed = 0.0, weight = 0.0;
};

CellSum sum_of_cell(const DaylightModel& model, const ClearPanes& panes, const Camera& eye,
                    int cell, int rays) {
  const SkyPatches& sky = model.sky();
  const double solid_angle = sky.solid_angle(cell) / (rays * rays);
  CellSum sum;
  for (int i = 0; i < rays * rays; ++i) {
    const int column = i % rays, row = i / rays;
    const Eigen::Vector3d towards = sky.direction(cell, (column + 0.5) / rays, (row + 0.5) / rays);
    if (!(towards.dot(eye.direction) > 0.0)) continue;
    const Ray ray{.origin = eye.position, .direction = towards};
    std::uint8_t blocked = 0;
    model.caster().occluded({&ray, 1}, {&blocked, 1});
    if (blocked != 0 && panes.empty()) continue;
    const double T =
        blocked == 0
            ? 1.0
            : luminous(model.scene().bands, panes.passed(model.caster(), ray)) /
                  luminous(model.scene().bands, constant_spectrum(model.scene().bands, 1.0f));
    if (!(T > 0.0)) continue;
    const double P = capped_position_index(eye, towards);
    sum.seen += solid_angle;
    sum.passed += T * solid_angle;
    sum.weight += T * T / (P * P) * solid_angle;
  }
  return sum;
}

}  // namespace

double daylight_glare_probability(double vertical_lux, double contrast) {
  if (!(vertical_lux > 0.0)) return 0.0;
  const double dgp = 5.87e-5 * vertical_lux +
                     9.18e-2 * std::log10(1.0 + contrast / std::pow(vertical_lux, 1.87)) + 0.16;
  return std::min(dgp, 1.0);
}

double simplified_glare_probability(double vertical_lux) {
  return vertical_lux > 0.0 ? std::min(6.22e-5 * vertical_lux + 0.184, 1.0) : 0.0;
}

GlareView glare_view(const DaylightModel& model, const Camera& eye, int rays) {
  const SkyPatches& sky = model.sky();
  const ClearPanes panes(model.scene());
  std::vector<CellSum> cells(static_cast<std::size_t>(sky.cell_count()));
  constexpr int grain = 32;
  parallel_for(sky.cell_count(), grain, [&](int begin, int end) {
    for (int c = begin; c < end; ++c) {
      cells[static_cast<std::size_t>(c)] = sum_of_cell(model, panes, eye, c, rays);
    }
  });
  Eigen::ArrayXd seen = Eigen::ArrayXd::Zero(sky.column_count()), passed = seen, weight = seen;
  for (int c = 0; c < sky.cell_count(); ++c) {
    const CellSum& cell = cells[static_cast<std::size_t>(c)];
    const int column = sky.column_of(c);
    seen[column] += cell.seen;
    passed[column] += cell.passed;
    weight[column] += cell.weight;
  }
  return {.transmittance = (seen > 0.0).select(passed / seen.max(1e-300), 0.0).cast<float>(),
          .weight = weight.cast<float>()};
}

Eigen::ArrayXd sky_contrast(const DaylightModel& model, const GlareView& view,
                            std::span<const SkyHour> hours, double ground_reflectance) {
  Eigen::ArrayXd contrast(static_cast<Eigen::Index>(hours.size()));
  constexpr int grain = 8;
  parallel_for(static_cast<int>(hours.size()), grain, [&](int begin, int end) {
    for (int h = begin; h < end; ++h) {
      const Eigen::ArrayXf L =
          column_luminances(model.sky(), hours[static_cast<std::size_t>(h)], ground_reflectance);
      const Eigen::ArrayXf share = L.square() * view.weight;
      contrast[h] = (view.transmittance * L > glare_luminance)
                        .select(share, Eigen::ArrayXf::Zero(L.size()))
                        .cast<double>()
                        .sum();
    }
  });
  return contrast;
}

double sun_contrast(const Camera& eye, const SkyHour& hour, double sunlight) {
  const double cosine = hour.sun.dot(eye.direction);
  if (!(sunlight > 0.0) || !(cosine > 0.0)) return 0.0;
  const double half = 0.5 * Sun{}.angle_degrees * degree;
  const double solid_angle = 2.0 * std::numbers::pi * (1.0 - std::cos(half));
  // Part of the disc is ahead of an eye that the sun grazes, where the cosine of the disc's middle
  // may be next to nothing.
  const double across = std::min(sunlight / cosine, hour.sun_lux);
  const double P = capped_position_index(eye, hour.sun);
  return across * across / (solid_angle * P * P);
}

void count_glare(std::span<const SkyHour> hours, const Occupancy& occupancy, int occupied_hours,
                 GlareOfYear& glare) {
  constexpr double most_hours = 5.0;  // %
  const auto share = [&](auto value, double limit) {
    int count = 0;
    for (std::size_t h = 0; h < hours.size(); ++h) {
      if (occupancy.holds(hours[h].number) && value(h) > limit) ++count;
    }
    return 100.0 * count / occupied_hours;
  };
  const auto dgp = [&](std::size_t h) { return double{glare.dgp[h]}; };
  const auto simplified = [&](std::size_t h) {
    return simplified_glare_probability(double{glare.vertical_lux[h]});
  };
  glare.above_35 = share(dgp, 0.35);
  glare.above_40 = share(dgp, 0.40);
  glare.above_45 = share(dgp, 0.45);
  glare.simplified_above_35 = share(simplified, 0.35);
  glare.simplified_above_40 = share(simplified, 0.40);
  glare.simplified_above_45 = share(simplified, 0.45);
  glare.level = glare.above_35 <= most_hours   ? "high"
                : glare.above_40 <= most_hours ? "medium"
                : glare.above_45 <= most_hours ? "minimum"
                                               : "none";
}

}  // namespace lightwell
