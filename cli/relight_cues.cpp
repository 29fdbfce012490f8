#include "cli/relight_cues.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "cli/checkpoint.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "radiosity/solution/solution_file.h"
#include "raytrace/cameras/camera_ray.h"
#include "raytrace/fade_pictures.h"
#include "scene/errors.h"

namespace lightwell {
namespace fs = std::filesystem;
namespace {

// The scene of pictures and the camera that they are seen by.
struct Seen {
  Scene scene{};
  Camera camera{};
};

std::optional<Seen> read_seen(const RelightByCues& task, const Feedback& feedback) {
  if (task.scene.empty()) return {};
  Seen seen{.scene = read_scene_step(task.scene, feedback.console, feedback.report)};
  seen.camera = choose_camera(seen.scene, task.camera);
  // Throws for a bad camera.
  static_cast<void>(CameraRays(task.render.projection.view(seen.camera, seen.scene)));
  return seen;
}

struct CueFiles {
  fs::path solution{};
  std::vector<fs::path> pictures{};
};

std::vector<CueFiles> name_files(const std::vector<WordedCue>& cues, const OutputFolder& folder,
                                 bool has_pictures) {
  std::vector<CueFiles> named;
  for (const WordedCue& cue : cues) {
    CueFiles& files = named.emplace_back();
    files.solution = folder / (cue.name + ".vtp");
    if (has_pictures) files.pictures = {folder / (cue.name + ".exr"), folder / (cue.name + ".png")};
    require_writable(files.solution);
    for (const fs::path& picture : files.pictures) require_writable(picture);
  }
  return named;
}

std::vector<fs::path> name_frames(const std::vector<WordedCue>& cues, const OutputFolder& folder,
                                  int frames) {
  for (const WordedCue& cue : cues) {
    if (frames == 0 || !cue.name.starts_with("frame-")) continue;
    throw InputError(fmt::format(
        "cue '{}': files whose names begin with 'frame-' are those of the film; rename the cue",
        cue.name));
  }
  std::vector<fs::path> named;
  for (int i = 0; i < frames; ++i) {
    require_writable(named.emplace_back(folder / fmt::format("frame-{:04}.png", i)));
  }
  return named;
}

SolvedScene read_relightable(const RelightByCues& task, const std::optional<Seen>& seen,
                             const Feedback& feedback) {
  if (seen) {
    return read_solution_step(task.solution, seen->scene, feedback.console, feedback.report);
  }
  const Stopwatch watch;
  note_input(task.solution);
  SolvedScene solved = read_solution(task.solution);
  feedback.report.add_solution(solved, false);
  feedback.report.add_phase("read_solution", watch.seconds());
  return solved;
}

// The light of the cue with the most light on what the camera sees. Leaves `solved` relit.
std::optional<IncidentLight> meter_brightest(const RelightByCues& task, const Seen& seen,
                                             const std::vector<Cue>& cues, SolvedScene& solved) {
  const Camera view = task.render.projection.view(seen.camera, seen.scene);
  const RenderableScene renderable(seen.scene, solved);
  std::optional<IncidentLight> brightest;
  for (const Cue& cue : cues) {
    relight(solved, cue.scales);
    const auto light = renderable.renderer.incident_light(view);
    if (light && (!brightest || light->exposure < brightest->exposure)) brightest = light;
  }
  return brightest;
}

Json cue_json(const Cue& cue, const SolvedScene& solved, const CueFiles& files) {
  Json scales = Json::object();
  for (const LightChannel& channel : solved.solution.channels) {
    scales[channel.name] = std::vector<float>(channel.scale.begin(), channel.scale.end());
  }
  Json pictures = Json::array();
  for (const fs::path& picture : files.pictures) pictures.push_back(picture.string());
  return {{"name", cue.name},           {"wait", cue.wait}, {"fade_up", cue.fade_up},
          {"fade_down", cue.fade_down}, {"hold", cue.hold}, {"solution", files.solution.string()},
          {"pictures", pictures},       {"scales", scales}};
}

struct CueFilm {
  const std::vector<Cue>& cues;
  const std::vector<fs::path>& files;  // of the frames; empty: no film
  std::optional<IncidentLight> incident{};
};

// The film of the fades of all cues, from the light of `before` on.
void write_film(const RelightByCues& task, const Seen& seen, const CueFilm& film,
                const SolvedScene& before, const Feedback& feedback) {
  if (film.files.empty()) return;
  const Stopwatch watch;
  RenderOptions options = task.render.options();
  options.run.progress = feedback.console.progress();
  const Camera view = task.render.projection.view(seen.camera, seen.scene);
  const CueSequence sequence(before.solution, film.cues);
  FadePictures pictures(seen.scene, before, view, options);
  const double last = std::max<double>(1.0, static_cast<double>(film.files.size()) - 1.0);
  for (std::size_t i = 0; i < film.files.size(); ++i) {
    const double second = static_cast<double>(i) / last * sequence.seconds();
    const Image frame = pictures.at(sequence.shares_at(second));
    write_picture(film.files[i],
                  {.image = frame,
                   .solution = before.solution,
                   .camera = view,
                   .render_options = task.render.text(),
                   .exposure_ev = task.render.exposure_ev,
                   .incident = film.incident},
                  task.render.film);
    feedback.report.add_file(film.files[i]);
    stop_if_interrupted();
  }
  feedback.console.finish_phase();
  feedback.report.add_phase("film", watch.seconds());
  feedback.report.add("film", {{"frames", film.files.size()}, {"rendered", pictures.rendered()}});
}

// Cues with the files that their results go into, one for each.
struct CueResults {
  const std::vector<Cue>& cues;
  const std::vector<CueFiles>& files;
  std::optional<IncidentLight> incident{};  // of the .png files
};

void render_cue(const Seen& seen, const SolvedScene& solved, const PictureTask& picture,
                const Feedback& feedback) {
  Checkpoint none({}, {}, {}, feedback.console);
  RenderableScene renderable(seen.scene, solved);
  render_step(renderable, picture, none, feedback);
}

void write_cues(const RelightByCues& task, const std::optional<Seen>& seen,
                const CueResults& results, SolvedScene& solved, const Feedback& feedback) {
  const std::optional<IncidentLight>& incident = results.incident;
  double relighting = 0.0, writing = 0.0;  // s
  Json made = Json::array();
  for (std::size_t i = 0; i < results.cues.size(); ++i) {
    const Cue& cue = results.cues[i];
    const CueFiles& files = results.files[i];
    Stopwatch watch;
    relight(solved, cue.scales);
    relighting += watch.lap();
    write_solution(files.solution, solved);
    writing += watch.lap();
    feedback.report.add_file(files.solution);
    made.push_back(cue_json(cue, solved, files));
    if (seen) {
      render_cue(*seen, solved,
                 {.camera = seen->camera,
                  .arguments = task.render,
                  .files = files.pictures,
                  .label = cue.name,
                  .incident = incident},
                 feedback);
    }
    stop_if_interrupted();
  }
  feedback.report.add_phase("relight", relighting);
  feedback.report.add_phase("write_solutions", writing);
  feedback.report.add("cues", std::move(made));
}

}  // namespace

void relight_by_cues(const RelightByCues& task, const Feedback& feedback) {
  const std::vector<WordedCue> worded = read_cue_file(task.cues);
  const std::optional<Seen> seen = read_seen(task, feedback);
  const OutputFolder folder(task.folder);
  const std::vector<CueFiles> files = name_files(worded, folder, seen.has_value());
  const std::vector<fs::path> frames = name_frames(worded, folder, task.frames);
  if (seen) task.render.film.check(seen->scene, files.front().pictures);
  SolvedScene solved = read_relightable(task, seen, feedback);
  relight(solved, channel_scales(solved.solution, task.settings, task.solution));
  const std::vector<Cue> cues = cues_of(solved.solution, worded, task.solution);
  if (task.frames > 0 && !(CueSequence(solved.solution, cues).seconds() > 0.0)) {
    throw InputError("the cues take no time; give them a 'fade' or a 'hold' for a film");
  }
  std::optional<IncidentLight> incident;
  const SolvedScene before = task.frames > 0 ? solved : SolvedScene();
  if (seen) incident = meter_brightest(task, *seen, cues, solved);
  write_cues(task, seen, {cues, files, incident}, solved, feedback);
  if (seen) write_film(task, *seen, {cues, frames, incident}, before, feedback);
}

}  // namespace lightwell
