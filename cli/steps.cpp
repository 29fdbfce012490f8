#include "cli/steps.h"

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/picture_in_time.h"
#include "cli/refinement.h"
#include "cli/scene_hints.h"
#include "cli/several_processes.h"
#include "mesh/patches/patch_textures.h"
#include "radiosity/dark_rooms.h"
#include "radiosity/solution/solution_file.h"
#include "scene/errors.h"
#include "scene/io/text_file.h"
#include "scene/specular.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

// Advice for a solve whose refinement ended before elements were small enough for --accuracy.
std::string way_to_smaller_elements(RefineOutcome outcome) {
  constexpr const char* smaller = "make elements smaller with --max-patch-size";
  switch (outcome) {
    case RefineOutcome::off:
      return fmt::format("Leave out '--refine off', or {}", smaller);
    case RefineOutcome::memory_limit_reached:
      return fmt::format("Allow more --memory, or {}", smaller);
    case RefineOutcome::max_elements_reached:
      return "Allow more --max-elements";
    case RefineOutcome::time_limit_reached:
      return "Allow more --time";
    case RefineOutcome::smallest_size_reached:
    case RefineOutcome::tolerance_reached:
      break;
  }
  return "Make elements smaller with --max-patch-size";
}

// " in 'floor, wall'", the part with the largest error; "" with a single part.
std::string place_of_worst(const SceneParts& parts) {
  if (parts.count() < 2) return "";
  const auto worst = std::ranges::max_element(parts.parts, {}, &ScenePart::error_estimate);
  return fmt::format(" in '{}'", worst->name);
}

// Surfaces of rooms without light.
Json unlit_json(const Scene& scene, const SolvedScene& solved) {
  const DarkRooms dark = find_dark_rooms(scene, solved.mesh, solved.solution);
  Json json = {{"area", dark.area}, {"share", dark.share}};
  if (dark.surface >= 0) {
    json["surface"] = scene.surfaces[static_cast<std::size_t>(dark.surface)].name;
  }
  return json;
}

// Prints notes and warnings on a solve that ended above its tolerances.
void warn_of_outcome(const RadiositySolution& solution, const SolveReport& solve_report,
                     double solver_tolerance, Console& console) {
  const RefineOutcome refined = solve_report.refinement.outcome;
  if (refined == RefineOutcome::max_elements_reached ||
      refined == RefineOutcome::memory_limit_reached) {
    console.say("note: refinement " + sentence(solve_report.refinement));
  }
  if (solution.outcome == Outcome::accuracy_missed) {
    console.say(
        fmt::format("warning: the estimated error of {:.3g} %{} is above the {:.3g} % that "
                    "--accuracy asks for; "
                    "the solution is written. {}",
                    100.0 * solution.error_estimate, place_of_worst(solution.parts),
                    100.0 * solve_report.accuracy, way_to_smaller_elements(refined)));
  }
  if (solution.outcome == Outcome::cut_short) {
    console.say(fmt::format(
        "warning: the solve was ended early; the solution is the best there was, with an estimated "
        "error of {:.3g} %{}",
        100.0 * solution.error_estimate, place_of_worst(solution.parts)));
  }
  if (solution.outcome == Outcome::max_sweeps_reached) {
    console.say(
        fmt::format("warning: the solver ({}) stopped after {} sweeps at a residual of {:.2g}, "
                    "above the tolerance of {:g}; the solution so far is written. Allow more "
                    "--max-sweeps, or try --solver bicgstab",
                    solution.solver, solution.history.size(), solution.residual, solver_tolerance));
  }
}

// A note on branches of the ray tree that ended at the maximum depth; without --verbose only if the
// light of these branches could be visible.
void note_depth_cut(const std::string& label, const RenderReport& rendered, int max_depth,
                    Console& console) {
  if (!(rendered.depth_cut > 0)) return;
  // A share below one grey level of an 8-bit picture is invisible.
  constexpr double visible = 1.0 / 255.0;
  const std::string cut = fmt::format(
      "{}: {} branches of the ray tree ended after {} mirrors and glass surfaces; about {:.2g} % "
      "of the picture's light is missing",
      label, rendered.depth_cut, max_depth, 100.0 * rendered.cut_share);
  if (rendered.cut_share > visible) {
    console.say("note: " + cut + ". A larger '--depth' follows more");
  } else {
    console.say_verbose(cut);
  }
}

// True if the picture is as asked for; warns of one that is not.
bool is_as_asked(const std::string& label, const RenderArguments& asked,
                 const PictureInTime& picture, const Feedback& feedback) {
  const bool is_whole = picture.rows == picture.image.height;
  const std::string options = picture.arguments.text();
  if (is_whole && options == asked.text()) return true;
  std::string what = fmt::format("rendered with {}", options);
  if (!is_whole) {
    what += fmt::format(
        " as far as row {} of {}; below, four samples for each pixel show the light "
        "of the solution",
        picture.rows, picture.image.height);
  }
  feedback.console.say(fmt::format("warning: {}: for want of time the picture is {}", label, what));
  feedback.report.add("cut_short_" + label, {{"options", options}, {"rows", picture.rows}});
  return false;
}

}  // namespace

References allowed_references(const CommonOptions& options) {
  return options.inside_folder ? References::inside_folder : References::anywhere;
}

void refuse_losses(const Scene& scene, const CommonOptions& options) {
  if (!options.strict || scene.losses.empty()) return;
  std::string list;
  for (const std::string& loss : scene.losses) list += "\n  " + loss;
  throw InputError(
      fmt::format("{}: not all of the scene can be used, and --strict makes that an error:{}",
                  scene.file.string(), list));
}

Scene read_scene_step(const fs::path& file, Console& console, Report& report,
                      CleanUpReport* clean_up) {
  const Stopwatch watch;
  console.begin("reading");
  const Scene scene = [&] {
    const InterruptEndsAtOnce at_once;
    return read_scene(file, allowed_references(console.options()));
  }();
  console.finish_phase();
  for (const fs::path& read : scene.files) note_input(read);
  refuse_losses(scene, console.options());
  console.say_notes(scene);
  for (const std::string& hint : scene_hints(scene)) console.say("note: " + hint);
  report.add("light", light_name(scene.relative_units));
  report.add_phase("read_scene", watch.seconds());
  stop_if_interrupted();
  const Stopwatch clean_up_watch;
  CleanUpReport done;
  console.begin("clean-up");
  Scene clean = [&] {
    const InterruptEndsAtOnce at_once;
    return merge_planar_regions(scene, &done);
  }();
  console.finish_phase();
  console.say_verbose(sentence(done));
  report.add("cleaned", clean_up_json(done));
  if (clean_up) *clean_up = done;
  report.add_phase("clean_up", clean_up_watch.seconds());
  stop_if_interrupted();
  return clean;
}

void note_mesh(const Scene& scene, const PatchMesh& mesh, Console& console, Report& report) {
  std::vector<std::string> notes = scene.notes;  // read_scene_step() has printed them
  notes.insert(notes.end(), mesh.notes.begin(), mesh.notes.end());
  report.add("notes", notes);
  for (const std::string& note : mesh.notes) console.say("note: " + note);
}

Provenance provenance(const Scene& scene, const SolveArguments& arguments) {
  return {.version = LIGHTWELL_VERSION,
          .scene_file = scene.file.string(),
          .scene_hash = scene_hash(scene),
          .options = arguments.text(scene)};
}

SolvedScene solve_step(const Scene& scene, const SolveTask& task, Checkpoint& checkpoint,
                       const Feedback& feedback) {
  const SolveArguments& arguments = task.arguments;
  const auto& [console, report] = feedback;
  SolveOptions options = arguments.options(scene);
  options.run.progress = [watched = checkpoint.watched(console.progress())](std::string_view phase,
                                                                            double share) {
    const bool is_nothing_there = phase == "mesh" && early_end_requested();
    return watched(phase, share) && !is_nothing_there;
  };
  options.run.processes = console.processes();
  if (!console.processes()) {
    options.run.seconds_left = task.time.seconds_left(task.share_of_time);
  }
  Journal* const journal = checkpoint.journal();
  const bool is_of_another = journal && journal->is_read_only();
  (is_of_another ? options.form_factors.run.journal : options.run.journal) = journal;
  options.form_factors.memory = std::make_shared<MemoryBudget>(
      MemoryOptions{.limit = arguments.memory, .folder = task.output.parent_path()});
  std::optional<SolvedScene> start;
  if (!arguments.start_from.empty()) {
    note_input(arguments.start_from);
    start = read_solution(arguments.start_from);
    options.start = &*start;
  }
  console.say_verbose("solving with " + arguments.text(scene));
  SolveReport solve_report;
  SolvedScene solved;
  try {
    solved = solve_scene(scene, options, &solve_report);
    stop_if_interrupted();
  } catch (const std::exception&) {
    checkpoint.rethrow_stopped();
  }
  console.finish_phase();
  add_traffic(solved.mesh.patch_count(), feedback);
  note_mesh(scene, solved.mesh, console, report);
  solved.solution.provenance.version = LIGHTWELL_VERSION;
  solved.solution.provenance.options = arguments.text(scene) + task.time.text();
  if (!options.view_rays.empty()) {
    solved.solution.provenance.looked_from = arguments.look_from.names;
  }
  report.add_solution(solved, true);
  report.add("refinement", refinement_json(solve_report.refinement));
  report.add("unlit", unlit_json(scene, solved));
  if (const CutSizes& cuts = solve_report.cuts; cuts.lights > 0) {
    report.add("lights", {{"count", cuts.lights}, {"asked", cuts.mean}, {"asked_most", cuts.most}});
  }
  report.add_storage(options.form_factors.memory->report());
  if (solve_report.accuracy > 0.0) {
    report.add("accuracy", {{"asked", solve_report.accuracy},
                            {"reached", solved.solution.error_estimate},
                            {"gather_rays", solve_report.gather_rays}});
  }
  if (task.time.seconds() > 0.0) {
    report.add("time", {{"asked", task.time.seconds()}, {"aimed_at", solve_report.stage}});
  }
  warn_of_outcome(solved.solution, solve_report, options.solver.tolerance, console);
  return solved;
}

void write_solution_step(const fs::path& file, const SolvedScene& solved, Console& console,
                         Report& report) {
  const Stopwatch watch;
  write_solution(file, solved);
  report.add_file(file);
  report.add_phase("write_solution", watch.seconds());
  console.say_verbose("wrote " + file.string());
}

SolvedScene read_solution_step(const fs::path& file, const Scene& scene, Console& console,
                               Report& report) {
  const Stopwatch watch;
  note_input(file);
  SolvedScene solved = read_solution(file);
  check_matches(scene, solved.solution);
  attach_textures(scene, solved.mesh);
  solved.solution.relative_units = scene.relative_units;  // older files lack the unit
  report.add_solution(solved, false);
  report.add_phase("read_solution", watch.seconds());
  console.say_verbose("the solution was made with " + solved.solution.provenance.options);
  stop_if_interrupted();
  return solved;
}

Provenance picture_provenance(const Scene& scene, const RadiositySolution& solution,
                              const RenderArguments& arguments) {
  return {.version = LIGHTWELL_VERSION,
          .scene_file = scene.file.string(),
          .scene_hash = solution.provenance.scene_hash,
          .options = fmt::format("render {} of a solution with {}", arguments.text(),
                                 solution.provenance.options)};
}

bool render_step(RenderableScene& renderable, const PictureTask& task, Checkpoint& checkpoint,
                 const Feedback& feedback) {
  const Camera& camera = task.camera;
  const RenderArguments& asked = task.arguments;
  const auto& [console, report] = feedback;
  const Stopwatch watch;
  const std::string& label = task.label.empty() ? camera.name : task.label;
  console.say_verbose(fmt::format("rendering {} with {}", label, asked.text()));
  RenderOptions options;
  options.layers = asked.film.rendered_layers(renderable.scene);
  options.run = {.progress = checkpoint.watched(console.progress()),
                 .journal = checkpoint.journal(),
                 .processes = console.processes(),
                 .seconds_left = task.seconds_left};
  const Camera view = asked.projection.view(camera, renderable.scene);
  PictureInTime rendered;
  try {
    rendered = render_in_time(renderable.renderer, view, asked, options);
    stop_if_interrupted();
  } catch (const std::exception&) {
    checkpoint.rethrow_stopped();
  }
  console.finish_phase();
  if (!console.is_first()) return true;
  const Picture picture{
      .image = rendered.image,
      .solution = renderable.solved.solution,
      .camera = view,
      .render_options = rendered.arguments.text(),
      .exposure_ev = asked.exposure_ev,
      .incident = task.incident ? task.incident : renderable.renderer.incident_light(view)};
  for (const fs::path& file : task.files) {
    write_picture(file, picture, asked.film);
    report.add_file(file);
  }
  report.add_phase("render_" + label, watch.seconds());
  report.add("depth_cut_" + label, rendered.rendered.cut_share);
  note_depth_cut(label, rendered.rendered, deepest_path(asked.depth), console);
  return is_as_asked(label, asked, rendered, feedback);
}

int exit_code(const RadiositySolution& solution) {
  return solution.outcome == Outcome::converged ? exit_done : exit_not_accurate;
}

}  // namespace lightwell
