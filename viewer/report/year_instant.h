#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daylight/sky_year.h"
#include "viewer/report/year_report.h"

namespace lightwell {

/// The daylight of one instant, in what a YearReport has of title, weather, error, conventions,
/// notes and rooms.
struct InstantReport {
  YearReport of{};
  std::string when{};         ///< "2024-11-21 15:30"
  SkyHour sky{};              ///< of the instant
  std::string states{};       ///< of the windows, see states_text(); empty: none is operated
  Eigen::ArrayXf total{};     ///< lx, per sensor
  Eigen::ArrayXf sunlight{};  ///< lx, the part straight from the sun
};

/// Figures of the instant.
nlohmann::ordered_json instant_json(const InstantReport& report);

/// The figures that people look for first, a line for each room.
std::string instant_text(const InstantReport& report);

/// The instant as one HTML page without external files.
std::string instant_page(const InstantReport& report);

}  // namespace lightwell
