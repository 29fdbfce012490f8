#include "radiosity/solve.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "python/binding/checked.h"
#include "python/binding/long_work.h"
#include "python/binding/module.h"
#include "python/binding/solution_data.h"
#include "radiosity/solve_words.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

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
};

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

SharedSolution solve(const SharedScene& scene, const SolveSettings& settings,
                     const nb::object& progress) {
  return result_of_long(progress, [&](const Progress& run) -> SharedSolution {
    SolveOptions options = settings.solve;
    choose_solver(settings.solver, options);
    options.channels = channels_of(settings, scene->clean);
    options.form_factors.memory = std::make_shared<MemoryBudget>(settings.memory);
    options.run = {.progress = run, .seconds_left = seconds_left(settings.seconds)};
    if (settings.start) options.start = &settings.start->solved;
    SolveReport report;
    auto made = std::make_shared<SolutionData>();
    made->solved = solve_scene(scene->clean, options, &report);
    made->solved.solution.provenance.version = LIGHTWELL_VERSION;
    made->solved.solution.provenance.options = settings.text;
    made->scene = scene;
    made->refinement = sentence(report.refinement);
    return made;
  });
}

using Class = nb::class_<SolveSettings>;

void add_mesh_options(Class& settings) {
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

void add_effort_options(Class& settings) {
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

void add_method_options(Class& settings) {
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
  Class settings(module, "SolveOptions");
  settings.def(nb::init<>());
  add_mesh_options(settings);
  add_effort_options(settings);
  add_method_options(settings);
  module.def("solver_names", &solver_names);
  module.def("solve", solve, nb::arg("scene"), nb::arg("options"), nb::arg("progress").none());
}

}  // namespace lightwell::python
