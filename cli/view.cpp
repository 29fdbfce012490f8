#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <set>
#include <stdexcept>

#include "cli/arguments.h"
#include "cli/channels.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/lux_range.h"
#include "cli/outputs.h"
#include "cli/report.h"
#include "cli/scene_of_solution.h"
#include "cli/steps.h"
#include "cli/white_balance.h"
#include "radiosity/solution/relight.h"
#include "scene/errors.h"
#ifdef LIGHTWELL_VIEWER
#include "scene/io/remarks.h"
#include "viewer/window/camera_path.h"
#include "viewer/window/view.h"
#endif

namespace lightwell {
namespace fs = std::filesystem;
namespace {

struct ViewArguments {
  std::string scene, solution, camera, offscreen, overlay, false_colour, output;
  std::optional<LuxRange> range;
  std::optional<std::pair<int, int>> size;
  double exposure_ev = 0.0;
  WhitePoint white;
  double text_scale = 0.0;
  std::vector<NamedSetting> channels;
  std::string cues;
  ChannelArguments kept_apart;
  MeshArguments mesh;
  std::vector<int> shots;
  bool no_ambient = false;
  std::string path;
  int frames = 0, turntable = 0;
  std::vector<double> isolux;
  double eye_height = 0.0;  // in the scene file's unit; 0: automatic
  bool walk = false, look_through = false, from_outside = false;
  std::vector<Eigen::Vector2d> pointer, clicks;  // pixels
};

#ifdef LIGHTWELL_VIEWER
Annotations annotations(const ViewArguments& arguments) {
  Annotations result{.keys = arguments.overlay == "keys"};
  if (!arguments.pointer.empty()) result.pointer = arguments.pointer[0];
  if (arguments.clicks.size() == 1) result.click = arguments.clicks[0];
  if (arguments.clicks.size() == 2) result.measured = {arguments.clicks[0], arguments.clicks[1]};
  return result;
}

// The scene's camera called `name`. A digit that names no camera selects the view of its key in the
// window: the bookmark, otherwise the camera of that number.
Camera choose_view(const Scene& scene, const std::string& name, const fs::path& bookmark_file) {
  const bool is_digit = name.size() == 1 && name[0] >= '1' && name[0] <= '9';
  const auto has_name = [&](const Camera& camera) { return camera.name == name; };
  if (is_digit && std::ranges::none_of(scene.cameras, has_name)) {
    const auto index = static_cast<std::size_t>(name[0] - '1');
    if (fs::exists(bookmark_file)) {
      const auto bookmark = read_views(bookmark_file).bookmarks[index];
      if (bookmark) return *bookmark;
    }
    if (index < scene.cameras.size()) return scene.cameras[index];
  }
  return choose_camera(scene, name);
}

ViewOptions view_options(const ViewArguments& arguments, const Scene& scene) {
  std::vector<Camera> cameras = scene.cameras;
  for (Camera& camera : cameras) camera = for_window(camera);
  ViewOptions options{.cameras = cameras,
                      .exposure_ev = arguments.exposure_ev,
                      .white = arguments.white,
                      .materials = scene.materials,
                      .scene = &scene};
  options.mesh = arguments.overlay == "mesh";
  options.annotations = annotations(arguments);
  options.look_through = arguments.look_through;
  options.from_outside = arguments.from_outside;
  options.illuminance = !arguments.false_colour.empty() && arguments.false_colour != "error";
  options.lux_classes = arguments.false_colour == "classes";
  options.text_scale = arguments.text_scale;
  options.measure = arguments.false_colour == "luminance" ? Measure::luminance
                    : arguments.false_colour == "unshot"  ? Measure::unshot
                                                          : Measure::illuminance;
  options.interpolation_error = arguments.false_colour == "error";
  options.lux_range = arguments.range;
  options.relative_units = scene.relative_units;
  options.solution_file = arguments.output;
  options.isolux = arguments.isolux;
  options.eye_height = arguments.eye_height * scene.metres_per_unit;
  options.walk = arguments.walk;
  fs::path beside = scene.file.filename();
  if (!arguments.output.empty()) beside = arguments.output;
  if (!arguments.solution.empty()) beside = arguments.solution;
  options.bookmark_file = beside.replace_extension(".views.json");
  if (!arguments.camera.empty()) {
    options.camera = for_window(choose_view(scene, arguments.camera, options.bookmark_file));
  }
  // An offscreen picture has the size that 'render' would give it.
  if (!arguments.offscreen.empty() && !scene.cameras.empty()) {
    const Camera& camera = options.camera ? *options.camera : scene.cameras.front();
    std::tie(options.width, options.height) = std::pair(camera.width, camera.height);
  }
  if (arguments.size) std::tie(options.width, options.height) = *arguments.size;
  return options;
}

// True if a channel per luminaire is affordable: each channel can be dimmed while light arrives,
// and takes one column per band at every vertex.
bool has_few_luminaires(const Scene& scene) {
  constexpr std::size_t few = 8;
  std::set<std::string> names;
  for (const Surface& surface : scene.surfaces) {
    if (scene.materials[surface.material].is_emitter()) names.insert(surface.name);
  }
  for (int i = 0; i < free_source_count(scene); ++i) names.insert(free_source_name(scene, i));
  return names.size() <= few;
}

bool is_by_default(const ChannelArguments& channels) {
  return !channels.is_off && !channels.by_kind && !channels.per_luminaire &&
         channels.patterns.empty();
}

// Shows the scene while progressive refinement solves it.
int view_live(const ViewArguments& arguments, const Scene& scene, const ViewOptions& options,
              const Feedback& feedback) {
  const auto& [console, report] = feedback;
  if (options.interpolation_error) {
    throw InputError(
        fmt::format("'--false-colour error' needs a solution: lightwell view {} SOLUTION.vtp ...",
                    arguments.scene));
  }
  SolveArguments solving;
  solving.channels = arguments.kept_apart;
  if (is_by_default(solving.channels)) {
    (has_few_luminaires(scene) ? solving.channels.per_luminaire : solving.channels.is_off) = true;
  }
  solving.mesh = arguments.mesh;
  solving.solver = "progressive";
  LiveViewOptions live;
  live.solve = solving.options(scene);
  live.ambient = !arguments.no_ambient;
  live.provenance = {.version = LIGHTWELL_VERSION,
                     .scene_file = scene.file.string(),
                     .scene_hash = scene_hash(scene),
                     .options = solving.text(scene)};
  live.solve.run.progress = console.progress();
  if (!arguments.channels.empty()) {
    live.scales = [&](const RadiositySolution& dark) {
      return channel_scales(dark, arguments.channels, arguments.scene);
    };
  }
  if (arguments.offscreen.empty()) {
    const InterruptEndsAtOnce interrupt;
    show_live_window(scene, live, options);
    return exit_done;
  }
  if (arguments.shots.empty()) {
    throw InputError(
        "'--offscreen' without a solution needs the number of shots before the picture, such as "
        "'--shots 100'; or give a solution");
  }
  if (!std::is_sorted(arguments.shots.begin(), arguments.shots.end())) {
    throw InputError("the numbers of '--shots' must rise, as in 1,10,100");
  }
  const Stopwatch watch;
  const int shots = write_live_snapshot(scene, live, arguments.shots, options, arguments.offscreen);
  console.finish_phase();
  report.add("shots", shots);
  report.add_phase("draw", watch.seconds());
  report.add_file(arguments.offscreen);
  report.print();
  return exit_done;
}

// The arguments with the scene in place where a solution was given alone.
ViewArguments with_scene(ViewArguments arguments) {
  if (!arguments.solution.empty() || lower_extension(arguments.scene) != ".vtp") return arguments;
  arguments.solution = arguments.scene;
  arguments.scene = scene_of_solution(arguments.solution).string();
  return arguments;
}

int view(const ViewArguments& given, Console& console) {
  const ViewArguments arguments = with_scene(given);
  Report report(console.options());
  CleanUpReport clean_up;
  const Scene scene = read_scene_step(arguments.scene, console, report, &clean_up);
  Remarks remarks;
  for (const Camera& camera : scene.cameras) {
    const std::string loss = loss_in_window(camera);
    if (!loss.empty()) remarks.mention(loss, camera.name);
  }
  for (const std::string& sentence : remarks.sentences()) console.say("note: " + sentence);
  ViewOptions options = view_options(arguments, scene);
  options.names = clean_up.names.get();
  const bool is_film = arguments.frames > 0 || arguments.turntable > 0;
  std::vector<WordedCue> cues;
  if (!arguments.cues.empty()) cues = read_cue_file(arguments.cues);
  if (!arguments.cues.empty() && arguments.solution.empty()) {
    throw InputError("'--cues' needs a solution: lightwell view SCENE SOLUTION.vtp --cues FILE");
  }
  if (is_film && arguments.solution.empty()) {
    throw InputError("a film needs a solution: lightwell view SCENE SOLUTION.vtp --frames ...");
  }
  if (!cues.empty() && !arguments.offscreen.empty() && !is_film) {
    throw InputError(
        "'--cues' with '--offscreen' needs the number of pictures of the fades, as in '--frames "
        "100'; 'lightwell relight --cues' makes a picture of each cue");
  }
  const std::string first_picture =
      is_film ? frame_name(arguments.offscreen, 0).string() : arguments.offscreen;
  for (const std::string& file : {first_picture, arguments.output}) {
    if (!file.empty()) require_writable(file);
  }
  if (arguments.solution.empty()) return view_live(arguments, scene, options, {console, report});
  if (!arguments.shots.empty()) {
    throw InputError(fmt::format("'--shots' is for a scene without a solution; leave out {}",
                                 arguments.solution));
  }
  if (options.illuminance && options.measure == Measure::unshot) {
    throw InputError(
        fmt::format("'--false-colour unshot' is for a scene without a solution; leave out {}",
                    arguments.solution));
  }
  SolvedScene solved = read_solution_step(arguments.solution, scene, console, report);
  if (options.interpolation_error && solved.solution.interpolation_error.size() == 0) {
    throw InputError(fmt::format(
        "{}: the solution was not refined, so it has no estimate of the interpolation error; solve "
        "without '--refine off'",
        arguments.solution));
  }
  if (!arguments.channels.empty()) {
    relight(solved, channel_scales(solved.solution, arguments.channels, arguments.solution));
  }
  if (!cues.empty()) options.cues = cues_of(solved.solution, cues, arguments.solution);
  if (arguments.offscreen.empty()) {
    const InterruptEndsAtOnce interrupt;
    show_window(solved, options);
    return exit_done;
  }
  const Stopwatch watch;
  if (is_film) {
    const FilmOptions film{.path = arguments.path,
                           .frames = std::max(arguments.frames, arguments.turntable),
                           .turntable = arguments.turntable > 0};
    for (const fs::path& file :
         write_film(solved, options, film, arguments.offscreen, console.progress())) {
      report.add_file(file);
    }
    console.finish_phase();
  } else {
    write_snapshot(solved, options, arguments.offscreen);
    report.add_file(arguments.offscreen);
  }
  report.add_phase("draw", watch.seconds());
  report.print();
  return exit_done;
}
#else
int view(const ViewArguments&, Console&) {
  throw std::runtime_error(
      "this lightwell was built without its viewer; build it with -DLIGHTWELL_VIEWER=ON, or use "
      "'lightwell render'");
}
#endif

// Pixels in `text`, X,Y,X,Y, at most `most` of them.
std::vector<Eigen::Vector2d> pixels(const std::string& text, const char* option, std::size_t most,
                                    const char* form) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const last = at + text.size();
  for (bool has_more = true; has_more;) {
    const auto [end, bad] = std::from_chars(at, last, numbers.emplace_back());
    has_more = bad == std::errc() && end != last && *end == ',';
    at = bad == std::errc() ? end + (has_more ? 1 : 0) : nullptr;
  }
  if (at != last || numbers.size() % 2 != 0 || numbers.size() > 2 * most) {
    throw CLI::ValidationError(option,
                               fmt::format("'{}' is not a pixel; write {} in pixels", text, form));
  }
  std::vector<Eigen::Vector2d> places;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    places.emplace_back(numbers[i], numbers[i + 1]);
  }
  return places;
}

void add_start(CLI::App& command, ViewArguments& arguments) {
  command
      .add_option("--camera", arguments.camera,
                  "start at a camera, by name, or at the view of a digit key (default: the first "
                  "camera)")
      ->type_name("NAME");
  add_size(command, arguments.size);
  add_exposure(command, arguments.exposure_ev);
  add_white_balance(command, arguments.white,
                    "light that shows white, as in 'render': as-lit (default), auto, or a "
                    "temperature such as 2700K (key F2)");
  command
      .add_option("--overlay", arguments.overlay,
                  "begin with the outlines of the elements: mesh (key M); or off screen with the "
                  "list of keys: keys (H)")
      ->type_name("WHAT")
      ->check(one_of("overlay", {"mesh", "keys"}));
  command.add_flag("--look-through", arguments.look_through,
                   "begin looking through surfaces that get no light (key X)");
  command.add_flag("--from-outside", arguments.from_outside,
                   "begin with all of the scene in the picture (key F)");
  auto* const false_colour =
      command
          .add_option(
              "--false-colour,--false-color", arguments.false_colour,
              "begin in false colours: lux (key V), classes (100 ... 750 lx, F7), luminance (U), "
              "unshot (light still to come, U) or error (estimated interpolation error)")
          ->type_name("WHAT")
          ->check(one_of("quantity", {"lux", "classes", "luminance", "unshot", "error"}));
  add_lux_range(command, arguments.range)->needs(false_colour);
  command
      .add_option("--text-scale", arguments.text_scale,
                  "size of text, such as 2 (default: by the resolution of the screen)")
      ->type_name("FACTOR")
      ->check(positive());
  command
      .add_option("--isolux", arguments.isolux,
                  "begin with isolux lines at these illuminances, such as 100,300,500 (key I)")
      ->type_name("LUX")
      ->delimiter(',')
      ->check(positive());
  command.add_flag("--walk", arguments.walk, "begin on foot (key G)");
  command
      .add_option("--eye-height", arguments.eye_height,
                  "eye height on foot (default: 1.6 m, less in a model smaller than a room)")
      ->type_name("LENGTH")
      ->check(positive());
}

void add_pictures(CLI::App& command, ViewArguments& arguments) {
  CLI::Option* const offscreen = command.get_option("--offscreen");
  command
      .add_option_function<std::string>(
          "--pointer",
          [&arguments](const std::string& text) {
            arguments.pointer = pixels(text, "--pointer", 1, "X,Y");
          },
          "with --offscreen: label the point at this pixel (key T)")
      ->type_name("X,Y")
      ->needs(offscreen);
  command
      .add_option_function<std::string>(
          "--click",
          [&arguments](const std::string& text) {
            arguments.clicks = pixels(text, "--click", 2, "X,Y or X,Y,X,Y");
          },
          "with --offscreen: describe the point at this pixel; two: measure their distance (key L)")
      ->type_name("X,Y[,X,Y]")
      ->needs(offscreen);
  auto* const path =
      command.add_option("--path", arguments.path, "a path recorded with the key J, for --frames")
          ->type_name("FILE");
  auto* const frames =
      command
          .add_option("--frames", arguments.frames,
                      "with --offscreen out-%04d.png: number of pictures along path or cues")
          ->type_name("N")
          ->check(whole_number(1, 1000000));
  path->needs(frames);
  frames->needs(offscreen);
  command
      .add_option("--turntable", arguments.turntable,
                  "with --offscreen out-%04d.png: number of pictures around the scene")
      ->type_name("N")
      ->check(whole_number(1, 1000000))
      ->needs(offscreen)
      ->excludes(path);
}

void add_live(CLI::App& command, ViewArguments& arguments) {
  const char* const live = "Without a solution";
  command
      .add_option(
          "--shots", arguments.shots,
          "with --offscreen: draw after this many shots, or when all light is shot; several, "
          "such as 1,10,100, side by side")
      ->type_name("N")
      ->delimiter(',')
      ->check(whole_number(0, 1 << 24))
      ->needs(command.get_option("--offscreen"))
      ->group(live);
  command
      .add_flag("--no-ambient", arguments.no_ambient,
                "with --shots: without the ambient term for unshot light")
      ->group(live);
  arguments.kept_apart.add_to(command, live);
  command.get_option("--channels")
      ->description(
          "light channels that keys dim: per-luminaire (default for up to 8), kinds (sky, sun and "
          "electric light), off, or NAME=PATTERN of emitters, which may be repeated");
  arguments.mesh.add_to(command, live);
  // Left out of --help, which has to fit a screen.
  for (const char* const rare :
       {"--max-element-size", "--elements-per-patch-edge", "--no-ambient"}) {
    command.get_option(rare)->group("");
  }
}

}  // namespace

Action add_view(CLI::App& command) {
  const auto arguments = std::make_shared<ViewArguments>();
  command.description(
      "Shows a solved scene in a window: W A S D or arrows to walk, the mouse to look around, H "
      "for\n"
      "all keys, Escape to leave. Without a solution the scene is solved while you walk.");
  command
      .add_option("scene", arguments->scene,
                  "the scene file; a solution alone finds its scene where it was, or beside itself")
      ->required()
      ->type_name("SCENE");
  command
      .add_option("solution", arguments->solution,
                  "the scene's solution, .vtp (default: solve in the window)")
      ->type_name("SOLUTION");
  command
      .add_option("--offscreen", arguments->offscreen, "draw into this .png instead of a window")
      ->type_name("FILE")
      ->check(with_extension({".png"}));
  add_start(command, *arguments);
  add_pictures(command, *arguments);
  add_channel_settings(command, arguments->channels);
  add_cues(command, arguments->cues, "lighting cues that keys step through, .toml (keys . , ;)");
  command
      .add_option("-o,--output", arguments->output,
                  "where Ctrl+S and Enter save the solution (default: a free name here), .vtp")
      ->type_name("FILE")
      ->check(with_extension({".vtp"}));
  add_live(command, *arguments);
  command.callback([arguments] {
    if (arguments->frames == 0 || !arguments->path.empty() || !arguments->cues.empty()) return;
    throw CLI::ValidationError(
        "--frames", "needs what the film shows: the path of a camera, --path, or cues, --cues");
  });
  command.footer("Example: lightwell view cornell/cornell.toml cornell.vtp");
  return [arguments](Console& console) { return view(*arguments, console); };
}

}  // namespace lightwell
