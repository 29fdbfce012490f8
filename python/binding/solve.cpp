#include "radiosity/solve.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <chrono>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/binding/arrays.h"
#include "python/binding/checked.h"
#include "python/binding/long_work.h"
#include "python/binding/module.h"
#include "python/binding/solution_data.h"
#include "radiosity/journal/journal.h"
#include "radiosity/solve_words.h"
#include "raytrace/cameras/choose_camera.h"
#include "raytrace/readings/view_rays.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

/// Somebody or something that looks at the scene, and whose errors matter.
struct Onlooker {
  std::string name{};
  std::optional<Camera> camera{};
  std::vector<Probe> places{};
};

/// Options of a solve that do not depend on the scene.
struct SolveSettings {
  SolveOptions solve{};
  std::string solver = "auto";
  std::string channels = "kinds";  ///< "kinds", "per-luminaire" or "off"; unless there are patterns
  std::vector<ChannelPattern> patterns{};
  double seconds = std::numeric_limits<double>::infinity();
  SharedSolution start{};
  MemoryOptions memory{};
  std::string text{};  ///< provenance of the solution
  std::vector<Onlooker> look_from{};
  std::filesystem::path checkpoint{}, reuse{};  ///< empty: none
  bool resume = false, keep_checkpoint = false;
  double every = 10.0;  ///< s, after which finished work is safe on the disk
};

// Rays of SolveOptions::view_rays; none for those who look from everywhere.
std::vector<Ray> view_rays(const SolveSettings& settings, const Scene& scene) {
  std::vector<Ray> rays;
  for (const Onlooker& onlooker : settings.look_from) {
    if (onlooker.name == "everywhere") return {};
    if (onlooker.camera) add_view_rays(*onlooker.camera, rays);
    add_view_rays(onlooker.places, scene_bounds(scene).diagonal(), rays);
  }
  return rays;
}

EmitterChannels channels_of(const SolveSettings& settings, const Scene& scene) {
  if (!settings.patterns.empty()) return channels_by_pattern(scene, settings.patterns);
  if (settings.channels == "off") return {};
  return settings.channels == "per-luminaire" ? channels_per_luminaire(scene)
                                              : channels_by_kind(scene);
}

std::function<double()> seconds_left(double seconds) {
  if (seconds == std::numeric_limits<double>::infinity()) return {};
  using Clock = std::chrono::steady_clock;
  return [seconds, start = Clock::now()] {
    return seconds - std::chrono::duration<double>(Clock::now() - start).count();
  };
}

/// The checkpoint of a solve, from its opening to its removal.
class KeptWork {
 public:
  /// Opens nothing without a checkpoint. Throws as Journal::open() does.
  KeptWork(const SolveSettings& settings, const Scene& scene) : settings_(settings) {
    if (!settings.reuse.empty()) {
      journal_ = Journal::of_another_solve(settings.reuse, LIGHTWELL_VERSION);
    }
    if (settings.checkpoint.empty()) return;
    journal_ = Journal::open(settings.checkpoint,
                             {.version = LIGHTWELL_VERSION,
                              .scene_file = scene.file.string(),
                              .scene_hash = scene_hash(scene),
                              .options = settings.text},
                             settings.every, settings.resume);
  }

  void join(SolveOptions& options) const {
    const bool is_of_another = journal_ && journal_->is_read_only();
    (is_of_another ? options.form_factors.run.journal : options.run.journal) = journal_.get();
  }
  /// Keeps finished work of a solve that was stopped.
  void stop() {
    if (!journal_ || journal_->is_read_only()) return;
    journal_->close();
    if (!Journal::holds_work(settings_.checkpoint)) journal_->remove();
  }
  /// Removes the checkpoint of a finished solve, unless it is to be kept. Returns why it is not
  /// complete; empty: it is.
  std::string finish() {
    if (!journal_ || journal_->is_read_only()) return {};
    journal_->close();
    const std::string failure = journal_->failure();
    if (!settings_.keep_checkpoint) journal_->remove();
    return failure;
  }

 private:
  const SolveSettings& settings_;
  std::unique_ptr<Journal> journal_{};
};

SolvedScene solve_with(const SolveSettings& settings, const Scene& scene, const Progress& run,
                       SolutionData& made) {
  SolveOptions options = settings.solve;
  choose_solver(settings.solver, options);
  options.channels = channels_of(settings, scene);
  options.view_rays = view_rays(settings, scene);
  options.form_factors.memory = std::make_shared<MemoryBudget>(settings.memory);
  options.run = {.progress = run, .seconds_left = seconds_left(settings.seconds)};
  if (settings.start) options.start = &settings.start->solved;
  KeptWork kept(settings, scene);
  kept.join(options);
  SolveReport report;
  SolvedScene solved;
  try {
    solved = solve_scene(scene, options, &report);
  } catch (...) {
    kept.stop();
    throw;
  }
  made.unkept = kept.finish();
  made.refinement = sentence(report.refinement);
  if (!options.view_rays.empty()) {
    for (const Onlooker& onlooker : settings.look_from) {
      solved.solution.provenance.looked_from.push_back(onlooker.name);
    }
  }
  return solved;
}

SharedSolution solve(const SharedScene& scene, const SolveSettings& settings,
                     const nb::object& progress) {
  return result_of_long(progress, [&](const Progress& run) -> SharedSolution {
    auto made = std::make_shared<SolutionData>();
    made->solved = solve_with(settings, scene->clean, run, *made);
    made->solved.solution.provenance.version = LIGHTWELL_VERSION;
    made->solved.solution.provenance.options = settings.text;
    made->scene = scene;
    return made;
  });
}

using SettingsClass = nb::class_<SolveSettings>;

void add_mesh_options(SettingsClass& settings) {
  settings
      .def_prop_rw(
          "max_patch_size", [](const SolveSettings& s) { return s.solve.mesh.max_patch_size; },
          [](SolveSettings& s, double v) {
            s.solve.mesh.max_patch_size = positive("max_patch_size", v);
          })
      .def_prop_rw(
          "max_element_size", [](const SolveSettings& s) { return s.solve.mesh.max_element_size; },
          [](SolveSettings& s, double v) {
            s.solve.mesh.max_element_size = positive("max_element_size", v);
          })
      .def_prop_rw(
          "elements_per_patch_edge",
          [](const SolveSettings& s) { return s.solve.mesh.elements_per_patch_edge; },
          [](SolveSettings& s, int v) {
            s.solve.mesh.elements_per_patch_edge =
                whole_number("elements_per_patch_edge", v, 1, 64);
          })
      .def_prop_rw(
          "discontinuity", [](const SolveSettings& s) { return s.solve.mesh.discontinuity; },
          [](SolveSettings& s, bool v) { s.solve.mesh.discontinuity = v; });
}

void add_effort_options(SettingsClass& settings) {
  settings
      .def_prop_rw(
          "accuracy",
          [](const SolveSettings& s) { return s.solve.accuracy ? s.solve.accuracy->share : 0.0; },
          [](SolveSettings& s, const std::string& v) { s.solve.accuracy = parse_accuracy(v); })
      .def_prop_rw(
          "refine", [](const SolveSettings& s) { return s.solve.refine.tolerance; },
          [](SolveSettings& s, const std::string& v) {
            s.solve.refine.tolerance = v == "off" ? 0.0 : share("refine", v);
          })
      .def_prop_rw(
          "max_elements", [](const SolveSettings& s) { return s.solve.refine.max_elements; },
          [](SolveSettings& s, int v) {
            s.solve.refine.max_elements = whole_number("max_elements", v, 1, 20000000);
          })
      .def_prop_rw(
          "rays", [](const SolveSettings& s) { return s.solve.form_factors.rays_per_patch; },
          [](SolveSettings& s, int v) {
            s.solve.form_factors.rays_per_patch = power_of_two("rays", v);
          })
      .def_prop_rw(
          "gather_rays", [](const SolveSettings& s) { return s.solve.gather.rays; },
          [](SolveSettings& s, int v) { s.solve.gather.rays = power_of_two("gather_rays", v); })
      .def_prop_rw(
          "seconds", [](const SolveSettings& s) { return s.seconds; },
          [](SolveSettings& s, double v) { s.seconds = positive("seconds", v); });
}

void add_checkpoint_options(SettingsClass& settings) {
  settings.def_rw("checkpoint", &SolveSettings::checkpoint)
      .def_rw("reuse", &SolveSettings::reuse)
      .def_rw("resume", &SolveSettings::resume)
      .def_rw("keep_checkpoint", &SolveSettings::keep_checkpoint)
      .def_prop_rw(
          "every", [](const SolveSettings& s) { return s.every; },
          [](SolveSettings& s, double v) { s.every = positive("every", v); });
}

// Those who look, in their order.
void add_onlookers(SettingsClass& settings) {
  settings
      .def("look_from_camera",
           [](SolveSettings& s, const Camera& camera) {
             s.look_from.push_back({.name = camera.name, .camera = camera});
           })
      .def("look_from_name",
           [](SolveSettings& s, const SharedScene& scene, const std::string& name) {
             Onlooker onlooker{.name = name};
             if (name != "everywhere") onlooker.camera = choose_camera(scene->clean, name);
             s.look_from.push_back(std::move(onlooker));
           })
      .def("look_from_file",
           [](SolveSettings& s, const SharedScene& scene, const std::string& file) {
             s.look_from.push_back(
                 {.name = file, .places = read_probes(file, scene->clean.metres_per_unit)});
           })
      .def("look_from_points",
           [](SolveSettings& s, const PointsIn& points, const PointsIn& normals) {
             s.look_from.push_back({.name = "points", .places = probes_from(points, normals)});
           });
}

void add_method_options(SettingsClass& settings) {
  settings
      .def_prop_rw(
          "form_factors", [](const SolveSettings&) {},
          [](SolveSettings& s, const std::string& v) {
            s.solve.form_factors.method = form_factor_method(v);
          })
      .def_prop_rw(
          "hemicube_resolution",
          [](const SolveSettings& s) { return s.solve.form_factors.hemicube_resolution; },
          [](SolveSettings& s, int v) {
            s.solve.form_factors.hemicube_resolution = even_number("hemicube_resolution", v);
          })
      .def_rw("solver", &SolveSettings::solver)
      .def_prop_rw(
          "tolerance", [](const SolveSettings& s) { return s.solve.solver.tolerance; },
          [](SolveSettings& s, double v) { s.solve.solver.tolerance = positive("tolerance", v); })
      .def_prop_rw(
          "max_sweeps", [](const SolveSettings& s) { return s.solve.solver.max_sweeps; },
          [](SolveSettings& s, int v) {
            s.solve.solver.max_sweeps = whole_number("max_sweeps", v, 1, 1000000);
          })
      .def_rw("channels", &SolveSettings::channels)
      .def_rw("start", &SolveSettings::start)
      .def_prop_rw(
          "memory", [](const SolveSettings& s) { return s.memory.limit; },
          [](SolveSettings& s, double v) { s.memory.limit = bytes_of_memory(v); })
      .def_rw("text", &SolveSettings::text)
      .def("add_channel", [](SolveSettings& s, const std::string& name, const std::string& glob) {
        s.patterns.push_back({name, glob});
      });
}

}  // namespace

void add_solve(nb::module_& module) {
  SettingsClass settings(module, "SolveOptions");
  settings.def(nb::init<>());
  add_mesh_options(settings);
  add_effort_options(settings);
  add_method_options(settings);
  add_checkpoint_options(settings);
  add_onlookers(settings);
  module.def("solver_names", &solver_names);
  module.def("solve", solve, nb::arg("scene"), nb::arg("options"), nb::arg("progress").none());
}

}  // namespace lightwell::python
