#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "viewer/report/lighting_report.h"

namespace lightwell {

/// All figures of a report but the values of points.
nlohmann::ordered_json figures_json(const LightingReport& report);

/// Illuminance and bound of every point, and where they are apart also electric light and daylight.
std::string points_csv(const LightingReport& report);

/// A value of a figure as people read it, without its unit: "512", "0.60", "19.0".
std::string figure_text(Figure figure, double value);

/// The figures that people look for first, a line each.
std::string figures_text(const LightingReport& report);

}  // namespace lightwell
