#include "viewer/export/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "cli/arguments.h"
#include "cli/channels.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/lux_range.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/steps.h"
#include "cli/white_balance.h"
#include "radiosity/solution/solution_file.h"
#include "scene/io/remarks.h"
#include "scene/io/text_file.h"
#include "viewer/export/baked_channels.h"

namespace lightwell {
namespace {

struct ExportArguments {
  std::string solution, scene, cues;
  std::vector<std::string> outputs;
  double exposure_ev = 0.0;
  std::optional<LuxRange> range;
  WhitePoint white{};
  Sides sides = Sides::front;
  bool lightmap = false;
  std::string lightmap_pass = "interpolate";
  LightmapOptions light{};
};

/// A solution, its scene (empty without --scene) and the models baked from both. A page draws no
/// backs, so it has all lit sides.
struct Exported {
  const Scene& scene;
  const SolvedScene& solved;
  std::optional<BakedModel> model{}, page{};

  const BakedModel& of(const std::string& kind) const { return kind == ".html" ? *page : *model; }
};

SolvedScene read_alone(const std::string& file, Console& console, Report& report) {
  const Stopwatch watch;
  note_input(file);
  SolvedScene solved = read_solution(file);
  report.add_solution(solved, false);
  report.add("light", light_name(solved.solution.relative_units));
  report.add_phase("read_solution", watch.seconds());
  console.say(
      "note: a solution has no names of surfaces, no cameras, mirrors or glass; '--scene SCENE' "
      "does.");
  return solved;
}

// The MTL beside an OBJ is written unasked, and must not replace one that no export wrote.
void require_own_materials(const std::filesystem::path& obj) {
  const std::filesystem::path materials = std::filesystem::path(obj).replace_extension(".mtl");
  require_writable(materials);
  if (!std::filesystem::exists(materials) || is_exported_library(materials)) return;
  throw std::runtime_error(fmt::format(
      "{}: cannot be written, since '{}', which belongs to it, is not of an export; name "
      "another output, or remove that file",
      obj.string(), materials.string()));
}

void require_all_writable(const ExportArguments& arguments) {
  for (const std::filesystem::path file : arguments.outputs) {
    require_writable(file);
    if (lower_extension(file) == ".obj") require_own_materials(file);
    // The number of lightmaps is not known yet; the first always exists.
    if (arguments.lightmap && lower_extension(file) == ".glb") {
      require_writable(lightmap_files(file, 1).front());
    }
  }
}

void write_lightmap(const std::filesystem::path& file, const Exported& exported,
                    const ExportArguments& arguments, const Feedback& feedback) {
  const auto& [console, report] = feedback;
  LightmapOptions options = arguments.light;
  options.pass = arguments.lightmap_pass == "interpolate" ? Pass::interpolate
                 : arguments.lightmap_pass == "gather"    ? Pass::gather
                                                          : Pass::direct;
  options.run.progress = console.progress();
  const LightmapReport made =
      write_lightmapped_gltf(file, *exported.model, exported.solved, exported.scene, options);
  for (const auto& written : made.files) report.add_file(written);
  report.add("lightmap", {{"atlases", made.atlases},
                          {"size", options.size},
                          {"charts", made.charts},
                          {"texels_per_metre", made.texels_per_metre},
                          {"coverage", made.coverage}});
}

void write_file(const std::filesystem::path& file, const Exported& exported,
                const ExportArguments& arguments, const Feedback& feedback) {
  Report& report = feedback.report;
  const std::string kind = lower_extension(file);
  const BakedModel& model = exported.of(kind);
  const Stopwatch watch;
  if (kind == ".glb" && arguments.lightmap) {
    write_lightmap(file, exported, arguments, feedback);
  } else if (kind == ".glb") {
    write_gltf(file, model);
  } else if (kind == ".ply") {
    write_ply(file, model);
  } else if (kind == ".obj") {
    write_obj(file, model);
    report.add_file(std::filesystem::path(file).replace_extension(".mtl"));
  } else {
    write_walkthrough(file, model, arguments.range, arguments.white);
  }
  report.add_file(file);
  report.add_phase("write_" + kind.substr(1), watch.seconds());
}

// Says which cameras the files cannot show as they are: perspective and orthographic cameras alone,
// without shift.
void note_cameras(const Scene& scene, const std::vector<std::string>& files, Console& console) {
  const auto has = [&](const char* extension) {
    return std::ranges::any_of(
        files, [&](const std::string& file) { return lower_extension(file) == extension; });
  };
  if (!has(".html") && !has(".glb")) return;
  Remarks remarks;
  for (const Camera& camera : scene.cameras) {
    std::string loss = loss_in_window(camera);
    if (loss.empty() && !camera.shift.isZero(0.0)) loss = "Cameras are shown without their shift";
    if (!loss.empty()) remarks.mention(loss, camera.name);
  }
  for (const std::string& sentence : remarks.sentences()) console.say("note: " + sentence);
}

int export_model(const ExportArguments& arguments, Console& console) {
  Report report(console.options());
  require_all_writable(arguments);
  Scene scene;
  CleanUpReport clean_up;
  if (!arguments.scene.empty()) {
    scene = read_scene_step(arguments.scene, console, report, &clean_up);
  }
  std::vector<WordedCue> cues;
  if (!arguments.cues.empty()) cues = read_cue_file(arguments.cues);
  const SolvedScene solved = arguments.scene.empty()
                                 ? read_alone(arguments.solution, console, report)
                                 : read_solution_step(arguments.solution, scene, console, report);
  note_cameras(scene, arguments.outputs, console);
  const Stopwatch watch;
  Exported exported{scene, solved};
  for (const std::string& file : arguments.outputs) {
    const bool is_page = lower_extension(file) == ".html";
    std::optional<BakedModel>& model = is_page ? exported.page : exported.model;
    if (model) continue;
    model = bake_model(solved, scene, arguments.exposure_ev, clean_up.names.get(),
                       is_page ? Sides::lit : arguments.sides);
  }
  if (!cues.empty()) {
    exported.page->cues =
        bake_cues(solved.solution, cues_of(solved.solution, cues, arguments.solution));
  }
  const BakedModel& model = exported.of(lower_extension(arguments.outputs.front()));
  report.add("exported", {{"vertices", model.vertex_count()},
                          {"faces", model.face_count()},
                          {"parts", model.parts.size()}});
  report.add_phase("bake", watch.seconds());
  stop_if_interrupted();
  for (const std::string& file : arguments.outputs) {
    write_file(file, exported, arguments, {console, report});
    stop_if_interrupted();
  }
  report.print();
  return exit_done;
}

void add_sides(CLI::App& command, Sides& sides) {
  command
      .add_option_function<std::string>(
          "--sides",
          [&sides](const std::string& name) {
            sides = name == "both" ? Sides::both : Sides::front;
          },
          "of models, sides of thin surfaces: front (those seen from within rooms; default) or\n"
          "both (also the outside of a daylit room)")
      ->type_name("WHICH")
      ->check(one_of("sides", {"front", "both"}));
}

void add_lightmap(CLI::App& command, ExportArguments& arguments) {
  const std::string group = "Lightmaps";
  LightmapOptions& light = arguments.light;
  CLI::Option* lightmap =
      command
          .add_flag(
              "--lightmap", arguments.lightmap,
              "light of the .glb in textures instead of vertex colours; their values go into\n"
              "FILE-lightmap-1.exr, ... beside it")
          ->group(group);
  command
      .add_option("--lightmap-size", light.size,
                  "texels along an edge of a lightmap (default 2048)")
      ->check(whole_number(least_lightmap_size, most_lightmap_size))
      ->group(group)
      ->needs(lightmap);
  command
      .add_option("--texels-per-metre", light.texels_per_metre,
                  "resolution, in several lightmaps if necessary (default: what fits into one)")
      ->check(positive())
      ->group(group)
      ->needs(lightmap);
  command
      .add_option("--lightmap-padding", light.padding,
                  "texels of padding around a chart (default 4)")
      ->check(whole_number(1, 64))
      ->group(group)
      ->needs(lightmap);
  command
      .add_option("--lightmap-pass", arguments.lightmap_pass,
                  "light of a texel: interpolate (from the solution), direct (direct light anew)\n"
                  "or gather (indirect light anew too)")
      ->check(one_of("pass", {"interpolate", "direct", "gather"}))
      ->group(group)
      ->needs(lightmap);
  command
      .add_flag("--lightmap-channels", light.per_channel,
                "data of each light channel too, FILE-lightmap-1-CHANNEL.exr, ...")
      ->group(group)
      ->needs(lightmap);
}

void check(const CLI::App& command, const ExportArguments& arguments) {
  const auto is_page = [](const std::string& file) { return lower_extension(file) == ".html"; };
  if (command.count("--sides") > 0 && std::ranges::all_of(arguments.outputs, is_page)) {
    throw CLI::ValidationError(
        "--sides", "is for models, and a page draws no backs; add '-o FILE.glb', or remove it");
  }
  for (const char* const of_pages : {"--white-balance", "--cues"}) {
    if (command.count(of_pages) > 0 && std::ranges::none_of(arguments.outputs, is_page)) {
      throw CLI::ValidationError(of_pages, "is for pages; add '-o FILE.html', or remove it");
    }
  }
  if (!arguments.lightmap) return;
  const bool has_glb = std::ranges::any_of(
      arguments.outputs, [](const std::string& file) { return lower_extension(file) == ".glb"; });
  if (!has_glb) {
    throw CLI::ValidationError("--lightmap", "needs a .glb output; add '-o FILE.glb'");
  }
  if (arguments.scene.empty() && arguments.lightmap_pass != "interpolate") {
    throw CLI::ValidationError("--lightmap-pass",
                               arguments.lightmap_pass + " traces rays and needs '--scene SCENE'");
  }
}

}  // namespace

Action add_export(CLI::App& command) {
  const auto arguments = std::make_shared<ExportArguments>();
  command.description(
      "Writes a solution as a model with its light in the colours of its vertices, or as a page\n"
      "to walk through in a web browser.");
  command.add_option("solution", arguments->solution, "solution file (.vtp)")
      ->required()
      ->type_name("SOLUTION");
  command
      .add_option("-o,--output", arguments->outputs,
                  ".html (page), .glb (glTF), .ply or .obj; may be repeated")
      ->required()
      ->type_name("FILE")
      ->type_size(1)
      ->allow_extra_args(false)
      ->check(with_extension({".glb", ".ply", ".obj", ".html"}));
  command
      .add_option("--scene", arguments->scene,
                  "the solution's scene, for names, cameras, mirrors and glass")
      ->type_name("SCENE");
  add_exposure(command, arguments->exposure_ev);
  add_lux_range(command, arguments->range);
  add_white_balance(command, arguments->white,
                    "light that the page shows as white at first: as-lit (default), auto, or a "
                    "temperature such as 2700K");
  add_cues(command, arguments->cues, "lighting cues that the page steps through and plays, .toml");
  add_sides(command, arguments->sides);
  add_lightmap(command, *arguments);
  command.callback([arguments, &command] { check(command, *arguments); });
  command.footer(
      "Example: lightwell export cornell.vtp --scene cornell/cornell.toml -o cornell.html");
  return [arguments](Console& console) { return export_model(*arguments, console); };
}

}  // namespace lightwell
