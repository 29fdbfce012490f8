#include <fmt/format.h>

#include <filesystem>

#include "cli/daylight_year.h"
#include "cli/interrupt.h"
#include "viewer/export/baked_year.h"
#include "viewer/export/export.h"

namespace lightwell {

void write_walk(const DaylightArguments& arguments, const DaylightInputs& inputs,
                const DaylightModel& model, std::span<const SkyHour> hours, Console& console,
                Report& report) {
  if (!inputs.windows.groups.empty()) {
    console.say("note: '" + arguments.walk + "' shows all windows in their first states");
  }
  const YearBasis basis = find_year_basis(model, hours, arguments.ground);
  console.finish_phase();
  stop_if_interrupted();
  const Provenance provenance{.version = LIGHTWELL_VERSION,
                              .scene_file = inputs.scene.file.filename().string()};
  const BakedModel page = bake_year({.model = model,
                                     .basis = basis,
                                     .hours = hours,
                                     .weather = inputs.weather,
                                     .ground_reflectance = arguments.ground},
                                    inputs.scene, provenance,
                                    inputs.clean_up.names ? &*inputs.clean_up.names : nullptr);
  write_walkthrough(arguments.walk, page);
  report.add_file(arguments.walk);
  report.add("walk", {{"vertices", page.vertex_count()},
                      {"terms", basis.term_count()},
                      {"relative_error", basis.error},
                      {"bytes", std::filesystem::file_size(arguments.walk)}});
}

}  // namespace lightwell
