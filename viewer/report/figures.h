#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "viewer/report/lighting_report.h"

namespace lightwell {

/// All figures of a report but the values of points.
nlohmann::ordered_json figures_json(const LightingReport& report);

/// Illuminance and bound of every point, and where they are apart also electric light and daylight.
std::string points_csv(const LightingReport& report);

/// Limits with the figures that are held to them, and verdicts.
nlohmann::ordered_json requirements_json(std::span<const Requirement> requirements);

/// A line for the verdict of each area, with a line for each limit that is not surely kept.
std::string verdicts_text(std::span<const Requirement> requirements);

/// A value of a figure as people read it, without its unit: "512", "0.60", "19.0"; of NaN "not
/// defined".
std::string figure_text(Figure figure, double value);

/// The figures that people look for first, a line each.
std::string figures_text(const LightingReport& report);

}  // namespace lightwell
