#include "cli/look_from.h"

#include <algorithm>

#include "cli/arguments.h"
#include "cli/outputs.h"
#include "cli/quoted.h"
#include "raytrace/readings/view_rays.h"

namespace lightwell {
namespace {

bool is_file_of_places(const std::string& name) {
  return name.ends_with(".csv") || name.ends_with(".CSV");
}

}  // namespace

void LookFromArguments::add_to(CLI::App& command, const std::string& group) {
  command
      .add_option("--look-from", names,
                  "spend effort on what these see: cameras, .csv files of places (x,y,z,nx,ny,nz), "
                  "or everywhere; the error is estimated there")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->check([](const std::string& name) {
        return name.empty() ? "name a camera, a .csv file of places, or everywhere" : "";
      })
      ->group(group);
}

std::vector<Ray> LookFromArguments::rays(const Scene& scene) const {
  std::vector<Ray> rays;
  if (std::ranges::count(names, everywhere) > 0) return rays;
  for (const std::string& name : names) {
    if (!is_file_of_places(name)) {
      add_view_rays(choose_camera(scene, name), rays);
      continue;
    }
    note_input(name);
    add_view_rays(read_probes(name, scene.metres_per_unit), scene_bounds(scene).diagonal(), rays);
  }
  return rays;
}

std::string LookFromArguments::text() const {
  std::string text;
  for (const std::string& name : names) text += " --look-from " + quoted(name);
  return text;
}

}  // namespace lightwell
