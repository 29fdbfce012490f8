#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "daylight/annual_metrics.h"

namespace lightwell {

/// A sensor grid of a Honeybee model within all sensors of a year.
struct MetricGrid {
  std::string name{}, group{};  ///< group: a folder for the grid's files; empty: none
  Eigen::Index first = 0, count = 0;
};

/// The files of write_honeybee_metrics(), relative to their folder.
std::vector<std::filesystem::path> honeybee_metric_files(std::span<const MetricGrid> grids);

/// Writes measures of a year as the annual daylight recipe of Honeybee does: a folder each for
/// `da`, `cda`, `udi_lower` (below 100 lx), `udi` (100 to 3000 lx) and `udi_upper`, with a file for
/// each grid, a line for each sensor, percent with two decimals, and grids_info.json. Makes missing
/// folders. Throws std::runtime_error with the file and the reason.
void write_honeybee_metrics(const std::filesystem::path& folder, std::span<const MetricGrid> grids,
                            const SensorMetrics& metrics);

}  // namespace lightwell
