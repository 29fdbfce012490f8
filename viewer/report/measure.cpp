#include "viewer/report/measure.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "radiosity/emitters/free_source.h"
#include "radiosity/solution/relight.h"
#include "raytrace/readings/glare_rating.h"
#include "viewer/report/plan_lines.h"

namespace lightwell {
namespace {

/// Kinds of light in a channel.
struct Kinds {
  bool electric = false, daylight = false;
};

// Kinds of light that reach a scene at its present scales: of the sources whose channel is
// `channel`, or of all with channel -1.
Kinds kinds_of(const Scene& scene, const SolvedScene& solved, const DirectLight& lights,
               int channel) {
  Kinds kinds;
  const RadiositySolution& solution = solved.solution;
  const auto is_asked = [&](const std::vector<int>& of, int i) {
    return channel < 0 || of[static_cast<std::size_t>(i)] == channel;
  };
  for (int p = 0; p < solved.mesh.patch_count(); ++p) {
    if (!is_asked(solution.patch_channel, p)) continue;
    kinds.electric |= (solved.mesh.emission.row(p) > 0.0f).any();
  }
  const auto lamps = static_cast<int>(scene.lamps.size());
  for (const FreeSource& source : lights.free_sources()) {
    if (!is_asked(solution.source_channel, source.number) || !(source.light > 0.0f).any()) continue;
    (source.number < lamps ? kinds.electric : kinds.daylight) = true;
  }
  return kinds;
}

/// A solved scene with what rays from points need.
struct MeasurableScene {
  const Scene& scene;
  const SolvedScene& solved;
  const ElementCaster& caster;
  DirectLight lights;
};

// The solution without reflected light, for grids that leave it out.
std::optional<RadiositySolution> without_reflections(const RadiositySolution& solution,
                                                     const std::vector<LuxGrid>& grids) {
  if (std::ranges::none_of(grids, &LuxGrid::is_direct_only)) return {};
  RadiositySolution dark = solution;
  for (BandArray* light :
       {&dark.direct_irradiance, &dark.indirect_irradiance, &dark.caustic_irradiance}) {
    light->setZero();
  }
  return dark;
}

std::vector<LuxField> fields(const MeasurableScene& lit, const Measurements& what, double factor) {
  const RadiositySolution& all = lit.solved.solution;
  const std::optional<RadiositySolution> dark = without_reflections(all, what.grids);
  std::vector<LuxField> fields;
  for (const LuxGrid& grid : what.grids) {
    fields.push_back(measure_grid(lit.scene, lit.caster, lit.lights,
                                  grid.is_direct_only ? *dark : all, grid, factor, what.gathering));
    if (what.between) what.between();
  }
  return fields;
}

std::vector<Observer> observers(const MeasurableScene& lit, const Measurements& what) {
  GatherOptions gathering = what.gathering;
  gathering.rays = std::max(gathering.rays, rays_of_an_eye);
  std::vector<Observer> found;
  for (const Camera& eye : what.eyes) {
    found.push_back(
        {.name = eye.name,
         .eye = eye,
         .glare = unified_glare_rating(lit.scene, lit.caster, lit.lights, lit.solved.solution, eye,
                                       gathering, what.luminous_heights)});
    if (what.has_glare_rating) {
      found.back().arriving = arriving_light(lit.scene, lit.caster, lit.lights, eye.position);
    }
    if (what.between) what.between();
  }
  return found;
}

/// Light of the plane of an eye, with a bound in lx.
struct EyeReading {
  Spectrum irradiance{};  // W/m^2
  double lux_within = 0.0;
};

// Light of the eyes' planes, times `factor`.
std::vector<EyeReading> eye_readings(const MeasurableScene& lit, const Measurements& what,
                                     double factor) {
  std::vector<Probe> probes;
  for (const Camera& eye : what.eyes) {
    probes.push_back({.position = eye.position, .normal = eye.direction.normalized()});
  }
  if (probes.empty()) return {};
  ProbeBounds bounds;
  const BandArray E = probe_irradiance(lit.scene, lit.caster, lit.lights, lit.solved.solution,
                                       probes, what.gathering, &bounds);
  std::vector<EyeReading> readings;
  for (Eigen::Index i = 0; i < E.rows(); ++i) {
    const Spectrum here = static_cast<float>(factor) * E.row(i).transpose();
    readings.push_back({.irradiance = here, .lux_within = factor * bounds.lux_within[i]});
  }
  return readings;
}

void set_eye_light(const Bands& bands, const std::vector<EyeReading>& readings,
                   const ColourSamples* colours, LightingReport& report) {
  for (std::size_t i = 0; i < readings.size(); ++i) {
    Observer& observer = report.observers[i];
    observer.lux = luminous(bands, readings[i].irradiance);
    observer.lux_within = readings[i].lux_within;
    if (const auto power = spectral_power(bands, readings[i].irradiance)) {
      observer.light = eye_light(*power);
      if (colours) observer.fidelity = colour_fidelity(*power, *colours);
    }
  }
}

}  // namespace

LightContent light_content(const Scene& scene, const SolvedScene& solved,
                           const DirectLight& lights) {
  const Kinds all = kinds_of(scene, solved, lights, -1);
  if (!all.daylight) return LightContent::electric;
  if (!all.electric) return LightContent::daylight;
  const auto count = static_cast<int>(solved.solution.channels.size());
  for (int c = 0; c < count; ++c) {
    const Kinds kinds = kinds_of(scene, solved, lights, c);
    if (kinds.electric && kinds.daylight) return LightContent::together;
  }
  return count == 0 ? LightContent::together : LightContent::apart;
}

void measure(const Scene& scene, SolvedScene& solved, const DirectLight& lights,
             const Measurements& what, LightingReport& report) {
  const ElementCaster caster(solved.mesh);
  const auto lit = [&] {
    return MeasurableScene{scene, solved, caster, {scene, solved.mesh, {}, &lights}};
  };
  report.content = light_content(scene, solved, lights);
  report.surfaces = std::vector<CalculationSurface>(what.grids.size());
  for (std::size_t i = 0; i < what.grids.size(); ++i) {
    report.surfaces[i].grid = what.grids[i];
    report.surfaces[i].lines = plan_lines(scene, caster, what.grids[i], what.eyes);
  }
  if (report.content != LightContent::apart) {
    const bool is_maintained = report.content != LightContent::daylight;
    const MeasurableScene all = lit();
    std::vector<LuxField> found = fields(all, what, is_maintained ? what.maintenance_factor : 1.0);
    for (std::size_t i = 0; i < found.size(); ++i) report.surfaces[i].field = std::move(found[i]);
    report.observers = observers(all, what);
    set_eye_light(scene.bands,
                  eye_readings(all, what, is_maintained ? what.maintenance_factor : 1.0),
                  what.colours, report);
    return;
  }
  const std::vector<Spectrum> scales = effective_scales(solved.solution);
  const auto alone = [&](bool daylight) {
    std::vector<Spectrum> some = scales;
    for (std::size_t c = 0; c < some.size(); ++c) {
      const Kinds kinds = kinds_of(scene, solved, lights, static_cast<int>(c));
      if (kinds.daylight != daylight) some[c].setZero();
    }
    return some;
  };
  const std::vector<Spectrum> of_day = alone(true), of_lamps = alone(false);
  relight(solved, of_day);
  const MeasurableScene outside = lit();
  std::vector<LuxField> day = fields(outside, what, 1.0);
  std::vector<EyeReading> seen = eye_readings(outside, what, 1.0);
  relight(solved, of_lamps);
  const MeasurableScene lamps = lit();
  std::vector<LuxField> electric = fields(lamps, what, what.maintenance_factor);
  report.observers = observers(lamps, what);
  const std::vector<EyeReading> by_lamps = eye_readings(lamps, what, what.maintenance_factor);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    // No bound is known where there is no light; then the bound is that of the other part.
    const auto bound = [&](const EyeReading& part) {
      return (part.irradiance == 0.0f).all() ? 0.0 : part.lux_within;
    };
    seen[i].lux_within = bound(seen[i]) + bound(by_lamps[i]);
    seen[i].irradiance += by_lamps[i].irradiance;
  }
  set_eye_light(scene.bands, seen, what.colours, report);
  relight(solved, scales);
  for (std::size_t i = 0; i < day.size(); ++i) {
    CalculationSurface& surface = report.surfaces[i];
    surface.field = sum_of(day[i], electric[i]);
    surface.daylight = std::move(day[i]);
    surface.electric = std::move(electric[i]);
  }
}

}  // namespace lightwell
