#include "viewer/window/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "radiosity/solution/relight.h"
#include "raytrace/pictures/image.h"
#include "scene/errors.h"
#include "viewer/window/camera_path.h"
#include "viewer/window/live_solve.h"
#include "viewer/window/marks.h"
#include "viewer/window/overlay.h"
#include "viewer/window/pointer_tools.h"
#include "viewer/window/preparation.h"
#include "viewer/window/preview.h"
#include "viewer/window/solution_view.h"
#include "viewer/window/vtk_messages.h"
#include "viewer/window/waiting_window.h"
#include "viewer/window/walk_window.h"
#include "viewer/window/x_display.h"

namespace lightwell {

namespace {

/// The options with a size of text for the screen.
ViewOptions for_the_screen(ViewOptions options) {
  if (!(options.text_scale > 0.0)) options.text_scale = screen_text_scale();
  return options;
}

/// The options with a size of text for pictures: pictures higher than 800 pixels are shown on
/// screens of more dots, or smaller.
ViewOptions for_pictures(ViewOptions options) {
  constexpr double height = 800.0;
  if (!(options.text_scale > 0.0)) options.text_scale = std::max(1.0, options.height / height);
  return options;
}

}  // namespace

void show_window(const SolvedScene& solved, const ViewOptions& options) {
  const DisplayConnection display;
  WalkWindow(solved, for_the_screen(options)).run();
}

namespace {

void require_size(const ViewOptions& options) {
  constexpr int largest = 8192;
  for (const int side : {options.width, options.height}) {
    if (side < 1 || side > largest) {
      throw std::invalid_argument(
          fmt::format("a snapshot of {} x {} pixels is not possible; each side may have 1 to {}",
                      options.width, options.height, largest));
    }
  }
}

void require_within(const ViewOptions& options, const Eigen::Vector2d& place) {
  const bool is_within = place.x() >= 0.0 && place.y() >= 0.0 && place.x() < options.width &&
                         place.y() < options.height;
  if (is_within) return;
  throw InputError(fmt::format("pixel {:g},{:g} is outside of the picture, which has {} x {}",
                               place.x(), place.y(), options.width, options.height));
}

/// Draws pictures with the options' annotations, as a window shows them after these keys and
/// clicks.
class AnnotatedPictures {
 public:
  /// Keeps references to the view and the options.
  AnnotatedPictures(SolutionView& view, const ViewOptions& options)
      : view_(view), options_(options), overlay_(text_scale_of(options)) {
    overlay_.add_to(view.renderer());
    marks_.add_to(view.renderer());
  }

  /// Returns the picture from the view's camera, 8-bit sRGB. Throws InputError for an annotation
  /// outside of the picture.
  std::vector<std::uint8_t> draw() {
    const Annotations& asked = options_.annotations;
    const int width = options_.width, height = options_.height;
    Look look = view_.look();
    std::tie(look.camera.width, look.camera.height) = std::pair(width, height);
    view_.set_look(look);
    PointerTools pointer(options_.scene, options_.names);
    const auto click = [&](const Eigen::Vector2d& place) {
      require_within(options_, place);
      pointer.click(view_, place.x(), place.y());
    };
    if (asked.click) click(*asked.click);
    if (asked.measured) {
      pointer.switch_measuring();
      for (const Eigen::Vector2d& place : *asked.measured) click(place);
    }
    marks_.set(pointer.marks());
    overlay_.set_panel(pointer.panel(view_), width, height);
    if (asked.pointer) {
      const double x = asked.pointer->x(), y = asked.pointer->y();
      require_within(options_, *asked.pointer);
      pointer.switch_probe();
      pointer.hover(view_, x, y);
      overlay_.set_cursor(pointer.beside_pointer(view_), static_cast<int>(x), static_cast<int>(y),
                          width, height);
    }
    if (asked.keys) overlay_.set_help(walk_help(), width, height);
    const VtkMessages messages;  // VTK warns of text that does not fit in a tiny picture
    return draw_offscreen(view_, width, height);
  }

 private:
  SolutionView& view_;
  const ViewOptions& options_;
  Overlay overlay_;
  Marks marks_;
};

}  // namespace

void write_snapshot(const SolvedScene& solved, const ViewOptions& asked,
                    const std::filesystem::path& png) {
  require_size(asked);
  const ViewOptions options = for_pictures(asked);
  const DisplayConnection display;
  SolutionView view(solved, options);
  write_png(png, options.width, options.height, AnnotatedPictures(view, options).draw());
}

namespace {

std::vector<Camera> film_cameras(const FilmOptions& film, const ViewOptions& options,
                                 const SolutionView& view) {
  if (!film.path.empty()) {
    const CameraPath path = read_views(film.path).path;
    if (path.empty()) {
      throw InputError(
          fmt::format("{}: there is no path in it; record one in the window with the key J",
                      film.path.string()));
    }
    std::vector<Camera> cameras = frames_along(path, film.frames);
    for (Camera& camera : cameras) camera = fit_to_window(camera, options.width, options.height);
    return cameras;
  }
  if (!film.turntable) return std::vector<Camera>(film.frames, view.start_camera());
  const Eigen::Vector3d center = 0.5 * (view.bounds().low + view.bounds().high);
  return turntable(view.start_camera(), center, view.up_axis(), film.frames);
}

/// The light of a film's pictures: that of the solution, or of its cues.
class FilmLight {
 public:
  FilmLight(SolutionView& view, const SolvedScene& solved, const std::vector<Cue>& cues)
      : view_(view), cues_(cues), sequence_(solved.solution, cues) {
    if (cues.empty()) return;
    if (!(sequence_.seconds() > 0.0)) {
      throw InputError("the cues take no time; give them a 'fade' or a 'hold' for a film");
    }
    own_ = std::make_unique<SolvedScene>(solved);
    view_.follow(*own_);
  }
  /// `look` with the exposure of the brightest light, of the first picture or a cue, on what
  /// `camera` sees.
  Look metered(const Look& look, const Camera& camera) {
    show_share(0.0);
    Look metered = view_.metered(look, camera);
    for (const Cue& cue : cues_) {
      show(cue.scales);
      const Look by_cue = view_.metered(look, camera);
      const bool is_brighter =
          by_cue.incident &&
          (!metered.incident || by_cue.incident->exposure < metered.incident->exposure);
      if (is_brighter) metered = by_cue;
    }
    return metered;
  }
  /// Shows the light at a share, in [0,1], of the cues' duration.
  void show_share(double share) {
    if (!cues_.empty()) show(sequence_.at(share * sequence_.seconds()));
  }

 private:
  void show(const std::vector<Spectrum>& scales) {
    relight(*own_, scales);
    view_.light_changed();
  }

  SolutionView& view_;
  const std::vector<Cue>& cues_;
  CueSequence sequence_;
  std::unique_ptr<SolvedScene> own_{};  // null without cues
};

}  // namespace

std::vector<std::filesystem::path> write_film(const SolvedScene& solved, const ViewOptions& asked,
                                              const FilmOptions& film, const std::string& pattern,
                                              const Progress& progress) {
  require_size(asked);
  const ViewOptions options = for_pictures(asked);
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < film.frames; ++i) files.push_back(frame_name(pattern, i));
  const DisplayConnection display;
  SolutionView view(solved, options);
  const std::vector<Camera> cameras = film_cameras(film, options, view);
  FilmLight light(view, solved, options.cues);
  AnnotatedPictures pictures(view, options);
  Look look = light.metered(view.look(), cameras.front());
  const double last = std::max<double>(1.0, static_cast<double>(cameras.size()) - 1.0);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    report(progress, "draw", static_cast<double>(i) / static_cast<double>(cameras.size()));
    light.show_share(static_cast<double>(i) / last);
    look.camera = cameras[i];
    view.set_look(look);
    write_png(files[i], options.width, options.height, pictures.draw());
  }
  return files;
}

namespace {

SolvedScene without_light(const LiveSolve& solve, const LiveViewOptions& live) {
  SolvedScene dark = solve.dark();
  if (live.scales) relight(dark, live.scales(dark.solution));
  return dark;
}

// `preview`: null for none. One of the two is ready.
void walk_while_solving(Preparation& preparation, Preview* preview, const ViewOptions& options,
                        const OpenWindow& opened) {
  std::optional<SolvedScene> sketched;
  if (preview) sketched = preview->take();
  if (sketched) return WalkWindow(std::move(*sketched), preparation, options, &opened).run();
  PreparedSolve prepared = preparation.take();
  WalkWindow window(*prepared.solve, std::move(prepared.dark), options, &opened);
  if (preview) window.expect(*preview);
  prepared.solve->start();
  window.run();
}

}  // namespace

void show_live_window(const Scene& scene, const LiveViewOptions& live, const ViewOptions& asked) {
  const DisplayConnection display;
  const ViewOptions options = for_the_screen(asked);
  const std::string file = std::filesystem::path(live.provenance.scene_file).filename().string();
  WaitingWindow waiting(window_title(file), options.width, options.height, text_scale_of(options));
  Preparation preparation(scene, live);
  std::optional<Preview> preview;
  const bool shows_unshot = options.illuminance && options.measure == Measure::unshot;
  if (!shows_unshot && !live.scales) preview.emplace(scene, live.provenance);
  const bool is_ready = waiting.run([&]() -> std::optional<std::string> {
    if (preparation.is_done() || (preview && preview->is_ready())) return std::nullopt;
    return preparation.status();
  });
  if (!is_ready) return;
  walk_while_solving(preparation, preview ? &*preview : nullptr, options, waiting.opened());
  if (preview) preview->cancel();
  preparation.cancel();
}

int write_live_snapshot(const Scene& scene, const LiveViewOptions& live, std::span<const int> shots,
                        const ViewOptions& asked, const std::filesystem::path& png) {
  const ViewOptions options = for_pictures(asked);
  ViewOptions strip = options;
  strip.width = options.width * static_cast<int>(shots.size());
  require_size(options);
  require_size(strip);
  const DisplayConnection display;
  LiveSolve solve(scene, live.solve, live.provenance);
  const SolvedScene dark = without_light(solve, live);
  std::vector<SolvedScene> stages;
  std::vector<Eigen::ArrayXf> unshot;
  int shot = 0;
  for (const int wanted : shots) {
    solve.shoot(wanted);
    const LiveLight light = solve.light();
    shot = light.shots;
    unshot.push_back(light.unshot);
    show_light(light, live.ambient, stages.emplace_back(dark));
  }
  const Look last = SolutionView(stages.back(), options).look();
  std::vector<std::uint8_t> picture(std::size_t{3} * strip.width * strip.height);
  for (std::size_t k = 0; k < stages.size(); ++k) {
    SolutionView view(stages[k], options);
    Look look = view.look();
    look.metered_scale = last.metered_scale;
    look.incident = last.incident;
    view.set_look(look);
    view.set_unshot(unshot[k]);
    const auto drawn = AnnotatedPictures(view, options).draw();
    const std::size_t row = std::size_t{3} * options.width;
    for (int y = 0; y < options.height; ++y) {
      std::copy_n(drawn.begin() + static_cast<std::ptrdiff_t>(row * y), row,
                  picture.begin() + static_cast<std::ptrdiff_t>(row * (stages.size() * y + k)));
    }
  }
  write_png(png, strip.width, strip.height, picture);
  return shot;
}

}  // namespace lightwell
