#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radiosity/solution/solution.h"
#include "scene/progress.h"
#include "viewer/export/false_color.h"
#include "viewer/report/language.h"
#include "viewer/report/lighting_report.h"
#include "viewer/report/requested_grids.h"

namespace lightwell {

class JoinedSurfaces;
struct LimitTables;

/// Request for a lighting report, besides the calculation grids of the scene file. Lengths in
/// metres.
struct ReportRequest {
  GridRequest grids{};                   ///< measured on
  std::vector<std::string> observers{};  ///< cameras for whose eyes glare is rated
  std::vector<NamedNumber> watts{};      ///< electric power of each luminaire of the name, W, > 0
  /// Maintenance factor of electric light, (0,1]; empty: that of the design, or 1.
  std::optional<double> maintenance_factor{};
  /// Design of a scene that was not read from a file; empty: that of the scene's file.
  std::optional<LightingDesign> design{};
  std::filesystem::path areas{};       ///< file with tables of the design; empty: the scene's
  std::string activity{};              ///< of all working planes without an area; empty: none
  std::filesystem::path activities{};  ///< table of activities; empty: the program's
  std::filesystem::path sports{};      ///< table of sports; empty: the program's
  std::filesystem::path colours{};     ///< colour evaluation samples of TM-30; empty: none
  int rays = 1024;                     ///< of the gather at each point, a power of two
  bool has_picture = false;
  std::string camera{};  ///< of the picture; empty: the first
};

/// A request whose names were found.
struct ReportPlan {
  ReportRequest request{};
  LightingDesign design{};
  std::shared_ptr<const LimitTables> tables{};  ///< limits by keys; set by plan_report()
  ColourSamples colours{};                      ///< empty: none
  std::vector<Camera> eyes{};                   ///< of the observers, those of areas included

  /// True if there is nothing to measure.
  bool is_empty() const { return design.grids.empty() && request.grids.is_empty() && eyes.empty(); }
};

/// Reads the lighting design of a scene and looks names of cameras up, before anything is computed.
/// Throws InputError for a scene without units of light, for a name or an activity that is not
/// there, and as read_lighting_design() does; also for a table that cannot be read.
ReportPlan plan_report(const Scene& scene, ReportRequest request);

/// A scene after merge_planar_regions(), and the surfaces that it joined; null: none.
struct ReportedScene {
  const Scene& scene;
  const JoinedSurfaces* names = nullptr;
};

/// Measures what a plan asks for. `solved` is relit meanwhile, and is afterwards as before.
/// Throws InputError for surfaces and luminaires that are not there, Interrupted when progress says
/// stop.
LightingReport make_report(const ReportPlan& plan, const ReportedScene& of, SolvedScene& solved,
                           const Progress& progress);

/// All figures of a report but the values of points, as a JSON object.
std::string report_json(const LightingReport& report);

/// Throws InputError unless write_report() can write a file of that name: for other extensions than
/// .html, .pdf, .json and .csv, and for .pdf in a build without PDF.
void require_report_file(const std::filesystem::path& path);

/// Writes a report: .html (one page to print), .pdf, .json (all figures) or .csv (every point).
/// `range` is the scale of the false colours of all plans; `language` that of pages. The file is
/// written under a temporary name and renamed. Throws as require_report_file() does, and
/// std::runtime_error that names the file if writing fails.
void write_report(const std::filesystem::path& path, const LightingReport& report,
                  const std::optional<LuxRange>& range = {}, Language language = Language::english);

}  // namespace lightwell
