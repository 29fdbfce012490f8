#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "standards/road/road_figures.h"
#include "standards/road/road_spacing.h"
#include "viewer/document/document.h"

namespace lightwell {

/// A road and what was computed of it.
struct RoadReport {
  Road road{};
  RoadFigures figures{};
  std::vector<SpacingRange> spacings{};  ///< at which the classes are met, if searched for
  bool has_search = false;               ///< true: `spacings` is known
  std::string version{};                 ///< of the program
};

/// The report as a document in English: verdicts, observers, plans of luminance and illuminance, a
/// cross-section, and the basis of the calculation.
Document road_document(const RoadReport& report);

/// All figures.
nlohmann::ordered_json road_json(const RoadReport& report);

/// The figures that people look for first, a line each.
std::string road_text(const RoadReport& report);

/// Writes the report as .html, .pdf or .json, by the extension; files are written under a temporary
/// name and renamed. Throws as require_pdf() does, and std::runtime_error if writing fails.
void write_road_report(const std::filesystem::path& path, const RoadReport& report);

}  // namespace lightwell
