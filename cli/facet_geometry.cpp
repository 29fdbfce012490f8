#include "cli/facet_geometry.h"

#include <fmt/format.h>

#include "cli/arguments.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/steps.h"
#include "radiosity/form_factors/view_factor_rows.h"

namespace lightwell {

FacetGeometry read_facet_geometry(const std::string& file, const CommonOptions& options) {
  FacetGeometry geometry{.numbered = [&] {
    const InterruptEndsAtOnce at_once;
    return read_numbered_scene(file, allowed_references(options));
  }()};
  for (const auto& read : geometry.numbered.scene.files) note_input(read);
  refuse_losses(geometry.numbered.scene, options);
  geometry.check = check_facets(geometry.numbered.scene);
  geometry.notes = findings(geometry.numbered, geometry.check);
  return geometry;
}

void add_facet_geometry(CLI::App& command, std::string& scene) {
  command.add_option("scene", scene, fmt::format("geometry: {}", scene_extensions))
      ->required()
      ->type_name("SCENE");
}

void add_target_error(CLI::App& command, double& target_error, const std::string& group) {
  command
      .add_option("--target-error", target_error,
                  "target standard error of every factor (default 1e-3)")
      ->type_name("E")
      ->check(positive())
      ->group(group);
}

}  // namespace lightwell
