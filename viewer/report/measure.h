#pragma once

#include <functional>
#include <string>
#include <vector>

#include "radiosity/direct_light/direct_light.h"
#include "radiosity/solve.h"
#include "viewer/report/lighting_report.h"

namespace lightwell {

/// Gather rays for the eye of an observer, at least: the background luminance of UGR is one
/// reading.
inline constexpr int rays_of_an_eye = 1 << 14;

/// Places that a report measures, and how.
struct Measurements {
  std::vector<LuxGrid> grids{};
  std::vector<Camera> eyes{};
  double maintenance_factor = 1.0;
  GatherOptions gathering{};
  std::vector<double> luminous_heights{};  ///< see unified_glare_rating()
  const ColourSamples* colours = nullptr;  ///< for R_f and R_g of observers; null: none
  bool has_glare_rating = false;           ///< observers get ArrivingLight
  std::function<void()> between{};         ///< called between grids, to stop early by an exception
};

/// The light that figures of this solution contain: whether the channels of the solution tell sky
/// and sun from lamps and emitting surfaces. `lights` are those of scene and mesh.
LightContent light_content(const Scene& scene, const SolvedScene& solved,
                           const DirectLight& lights);

/// Measures into `report`: content, surfaces and observers. Where electric light and daylight are
/// kept apart, each is measured by itself, glare is that of electric light alone, and the
/// maintenance factor multiplies electric light alone. `solved` is relit meanwhile, and is
/// afterwards as before. `lights` are those of scene and mesh.
void measure(const Scene& scene, SolvedScene& solved, const DirectLight& lights,
             const Measurements& what, LightingReport& report);

}  // namespace lightwell
