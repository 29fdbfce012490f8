#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "radiosity/direct_light/direct_light.h"
#include "raytrace/readings/glare.h"
#include "raytrace/readings/lux_grid.h"
#include "viewer/report/make_report.h"
#include "viewer/report/plan_lines.h"

namespace lightwell {

/// Places where light is measured, and how.
struct LightPlaces {
  std::vector<CalculationGrid> grids{};
  std::vector<int> limited{};  ///< indices of those that are measured
  std::vector<Camera> eyes{};
  std::vector<double> luminous_heights{};  ///< see unified_glare_rating()
  double maintenance_factor = 1.0;         ///< of illuminance; glare is that of new luminaires
  int rays = 1024;                         ///< of the gather at each point
};

/// A field for each grid and a rating for each eye.
struct LightReadings {
  std::vector<LuxField> fields{};
  std::vector<Glare> glares{};
};

/// Measurements of a solved scene with channels at any levels. Refers to scene and solution, which
/// must outlive it, and leaves the solution relit as it was measured last.
class MeasuredLight {
 public:
  /// Throws InputError for a grid that has no points, see lux_grid().
  MeasuredLight(const ReportedScene& of, SolvedScene& solved, LightPlaces places);

  /// Relights the solution at levels per channel and measures. Another replica gives independent
  /// noise. `between` is called between readings, to stop early by an exception.
  LightReadings measure(const std::vector<double>& levels, std::uint64_t replica,
                        const std::function<void()>& between = {});
  void relight_at(const std::vector<double>& levels);

  /// The room around a grid, for its plan.
  PlanLines lines_of(const LuxGrid& grid) const;

  const std::vector<LuxGrid>& grids() const { return grids_; }
  const std::vector<Camera>& eyes() const { return places_.eyes; }
  const RadiositySolution& solution() const { return solved_.solution; }
  std::size_t channel_count() const { return solved_.solution.channels.size(); }
  /// Lamps without luminous area that ratings had to leave out so far.
  const std::set<std::string>& left_out() const { return left_out_; }

 private:
  const Scene& scene_;
  SolvedScene& solved_;
  LightPlaces places_;
  ElementCaster caster_;
  DirectLight tables_;
  std::vector<LuxGrid> grids_{};
  std::set<std::string> left_out_{};
};

}  // namespace lightwell
