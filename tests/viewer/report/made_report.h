#pragma once

#include <fmt/format.h>

#include "tests/temporary_folder.h"
#include "viewer/report/lighting_report.h"

namespace lightwell {

/// A level grid of 4 x 3 points whose illuminance rises from `lux` in steps of 1.25 lx, above a
/// surface of 2 m x 1.5 m.
inline CalculationSurface made_surface(const std::string& name, double lux) {
  CalculationSurface surface;
  LuxGrid& grid = surface.grid;
  grid.name = name;
  grid.options = {.height = 0.75, .margin = 0.0, .spacing = 0.5};
  grid.columns = 4;
  grid.rows = 3;
  grid.step_u = grid.step_v = 0.5;
  grid.area = 3.0;
  constexpr int points = 12;
  Eigen::ArrayXd values(points);
  for (int i = 0; i < points; ++i) {
    grid.cell.push_back(i);
    const double x = 0.25 + 0.5 * (i % 4), y = 0.25 + 0.5 * (i / 4);
    grid.points.push_back({.position = {x, y, 0.75}});
    constexpr double step = 1.25;
    values[i] = lux + step * i;
  }
  surface.field = field_of(values);
  constexpr double within = 0.02;
  surface.field.lux_within = within * values;
  surface.field.mean_within = surface.field.point_within = within;
  surface.lines.low = {0.0, 0.0};
  surface.lines.high = {2.0, 1.5};
  return surface;
}

/// A report of `grids` grids, `luminaires` luminaires and one observer, without a solve.
inline LightingReport made_report(int grids, int luminaires) {
  LightingReport report{.title = "Made room", .maintenance_factor = 0.8, .rays = 256};
  report.heading = {.project = "Project A", .client = "Client B", .remarks = "as planned"};
  report.provenance = {.version = "1.2.3",
                       .scene_file = "made.toml",
                       .scene_hash = 0x0123456789abcdefu,
                       .options = "--rays 512"};
  constexpr double error = 0.0155;
  report.error_estimate = error;
  for (int i = 0; i < grids; ++i) {
    constexpr double first = 517.0, apart = 16.0;  // lx
    report.surfaces.push_back(made_surface(fmt::format("grid {}", i + 1), first + apart * i));
  }
  for (int i = 0; i < luminaires; ++i) {
    report.luminaires.push_back({.name = fmt::format("lamp {}", i + 1),
                                 .count = 2 + i,
                                 .flux = 4321.0 + 11.0 * i,
                                 .watts = 35.5 + i});
  }
  Observer observer{.name = "desk"};
  constexpr double ugr = 17.3, background = 45.67;
  observer.glare.ugr = ugr;
  observer.glare.background = background;
  observer.glare.sources = {{.name = "lamp 1",
                             .solid_angle = 0.0123,
                             .luminance = 5432.0,
                             .position_index = 3.21,
                             .share = 7.0}};
  observer.glare.left_out = {"bare bulb"};
  report.observers.push_back(observer);
  return report;
}

}  // namespace lightwell
