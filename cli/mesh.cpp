#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "mesh/build_patches.h"
#include "mesh/cleaning/joined_surfaces.h"
#include "mesh/patches/element_quality.h"
#include "radiosity/solution/mesh_file.h"

namespace lightwell {
namespace {

struct MeshCommandArguments {
  std::string scene, output;
  bool both_sides = false;
  MeshArguments mesh;
};

// Area (m^2) and place of an element, with the surface's name and the unit of the scene file.
Json element_json(const Scene& scene, const JoinedSurfaces* names, const PatchMesh& mesh,
                  int element) {
  const int patch = mesh.patch[element];
  const Eigen::Vector3d middle = element_center(mesh, element).position;
  const Eigen::Vector3d at = middle / scene.metres_per_unit;
  const int surface =
      names ? names->surface_of(mesh, element, middle) : mesh.surface[mesh.patch[element]];
  return {{"element", element},
          {"area", mesh.element_area[element]},
          {"surface", scene.surfaces[surface].name},
          {"patch", patch},
          {"center", {at.x(), at.y(), at.z()}}};
}

Json mesh_facts(const Scene& scene, const JoinedSurfaces* names, const PatchMesh& mesh,
                const std::string& options) {
  const ElementQuality quality = element_quality(mesh);
  const double area = scene_area(scene);
  return {{"scene", scene.file.string()},
          {"options", options},
          {"patches", mesh.patch_count()},
          {"elements", mesh.element_count()},
          {"vertices", mesh.vertex_count()},
          {"front_patches", quality.patches},
          {"front_elements", quality.elements},
          {"area", quality.area},
          {"scene_area", area},
          {"area_error", std::abs(quality.area - area) / area},
          {"least_angle", quality.least_angle_degrees},
          {"below_10_degrees", quality.below_10_degrees},
          {"below_20_degrees", quality.below_20_degrees},
          {"largest_aspect_ratio", quality.largest_aspect_ratio},
          {"smallest_element", element_json(scene, names, mesh, quality.smallest)},
          {"largest_element", element_json(scene, names, mesh, quality.largest)}};
}

std::string mesh_text(const Json& facts, const CleanUpReport& clean_up) {
  std::string text;
  const auto line = [&text](const char* head, const std::string& body) {
    text += fmt::format("{:<9} {}\n", head, body);
  };
  const auto count = [&facts](const char* key) { return facts[key].get<int>(); };
  const auto number = [&facts](const char* key) { return facts[key].get<double>(); };
  const auto size = [&facts](const char* key) {
    const Json &element = facts[key], &at = element["center"];
    return fmt::format("{:.4g} m2 ('{}' at {:.4g}, {:.4g}, {:.4g})", element["area"].get<double>(),
                       element["surface"].get<std::string>(), at[0].get<double>(),
                       at[1].get<double>(), at[2].get<double>());
  };
  line("cleaned", sentence(clean_up));
  const auto of_fronts = [&count](const char* all, const char* fronts) {
    return count(all) == count(fronts)
               ? fmt::format("{}, all on fronts", count(all))
               : fmt::format("{}, of which {} on fronts", count(all), count(fronts));
  };
  line("patches", of_fronts("patches", "front_patches"));
  line("elements",
       fmt::format("{}; {} vertices", of_fronts("elements", "front_elements"), count("vertices")));
  line("area", fmt::format("{:.6g} m2 of fronts; the scene has {:.6g} m2 (difference {:.1e})",
                           number("area"), number("scene_area"), number("area_error")));
  line("angles", fmt::format("{:.3g} degrees at least; {:.2f} % of elements below 10, {:.2f} % "
                             "below 20",
                             number("least_angle"), 100.0 * number("below_10_degrees"),
                             100.0 * number("below_20_degrees")));
  line("aspect", fmt::format("{:.3g} at most", number("largest_aspect_ratio")));
  line("smallest", size("smallest_element"));
  line("largest", size("largest_element"));
  return text;
}

int mesh(const MeshCommandArguments& arguments, Console& console) {
  Report report(console.options());
  CleanUpReport clean_up;
  const Scene scene = read_scene_step(arguments.scene, console, report, &clean_up);
  if (!arguments.output.empty()) require_writable(arguments.output);

  Stopwatch watch;
  const std::string options = arguments.mesh.text(scene);
  console.say_verbose("meshing with " + options);
  MeshOptions mesh_options = arguments.mesh.options(scene);
  const PatchMesh mesh = build_patches(scene, mesh_options, console.progress());
  console.finish_phase();
  stop_if_interrupted();
  report.add_phase("mesh", watch.lap());
  note_mesh(scene, mesh, console, report);
  const Json found = mesh_facts(scene, clean_up.names.get(), mesh, options);
  for (const auto& [key, value] : found.items()) report.add(key, value);
  report.add_phase("quality", watch.lap());

  if (!arguments.output.empty()) {
    write_mesh(arguments.output, mesh, arguments.both_sides ? MeshSides::both : MeshSides::fronts,
               {.version = LIGHTWELL_VERSION,
                .scene_file = scene.file.string(),
                .scene_hash = scene_hash(scene),
                .options = options});
    report.add_file(arguments.output);
    report.add_phase("write", watch.lap());
  }
  const CommonOptions& common = console.options();
  if (!common.json && !common.quiet) fmt::print("{}", mesh_text(found, clean_up));
  report.print();
  return exit_done;
}

}  // namespace

Action add_mesh(CLI::App& command) {
  const auto arguments = std::make_shared<MeshCommandArguments>();
  command.description(
      "Makes the patches and elements that 'solve' would use, and reports their quality.");
  add_scene(command, arguments->scene);
  auto* const output = command
                           .add_option("-o,--output", arguments->output,
                                       "the mesh, .vtp for ParaView (default: only a report)")
                           ->type_name("FILE")
                           ->check(with_extension({".vtp"}));
  command
      .add_flag("--both-sides", arguments->both_sides,
                "also the backs of two-sided surfaces, which lie exactly on their fronts")
      ->needs(output);
  arguments->mesh.add_to(command, "How surfaces are cut");
  command.footer("Example: lightwell mesh cornell/cornell.toml -o mesh.vtp --max-patch-size 25");
  return [arguments](Console& console) { return mesh(*arguments, console); };
}

}  // namespace lightwell
