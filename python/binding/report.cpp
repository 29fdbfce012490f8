#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <vector>

#include "python/binding/checked.h"
#include "python/binding/long_work.h"
#include "python/binding/module.h"
#include "python/binding/solution_data.h"
#include "scene/errors.h"
#include "scene/io/scene_text.h"
#include "viewer/report/make_report.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

// Measures, writes the files, and returns the figures as JSON.
std::string made_report(const SharedSolution& solution, const ReportRequest& asked,
                        const std::vector<std::filesystem::path>& files, const std::string& code,
                        const nb::object& progress) {
  const std::optional<Language> language = language_of(code);
  if (!language) throw InputError("the language is '" + code + "'; it can be en, de, fr or es");
  for (const std::filesystem::path& file : files) require_report_file(file);
  const SceneData& scene = solution->its_scene("a report");
  return result_of_long(progress, [&](const Progress& run) {
    ReportRequest request = asked;
    if (scene.text) request.design = read_lighting_text(*scene.text, scene.clean);
    const ReportPlan plan = plan_report(scene.clean, request);
    if (plan.is_empty()) {
      throw InputError(
          "there is nothing to report; name surfaces, planes above surfaces, or observers");
    }
    SolvedScene solved = solution->solved;
    const LightingReport made =
        make_report(plan, {scene.clean, scene.clean_up.names.get()}, solved, run);
    for (const std::filesystem::path& file : files) write_report(file, made, {}, *language);
    return report_json(made);
  });
}

}  // namespace

void add_report(nb::module_& module) {
  nb::class_<ReportRequest>(module, "ReportRequest")
      .def(nb::init<>())
      .def_prop_rw(
          "surfaces", [](const ReportRequest& r) { return r.grids.surfaces; },
          [](ReportRequest& r, std::vector<std::string> names) {
            r.grids.surfaces = std::move(names);
          })
      .def_rw("observers", &ReportRequest::observers)
      .def("add_plane",
           [](ReportRequest& r, const std::string& name, double height) {
             r.grids.planes.push_back({name, height});
           })
      .def("add_watts",
           [](ReportRequest& r, const std::string& name, double watts) {
             r.watts.push_back({name, positive("watts", watts)});
           })
      .def_prop_rw(
          "margin", [](const ReportRequest& r) { return r.grids.margin; },
          [](ReportRequest& r, std::optional<double> v) { r.grids.margin = v; })
      .def_prop_rw(
          "spacing", [](const ReportRequest& r) { return r.grids.spacing; },
          [](ReportRequest& r, double v) { r.grids.spacing = positive("spacing", v); })
      .def_rw("maintenance", &ReportRequest::maintenance_factor)
      .def_rw("areas", &ReportRequest::areas)
      .def_rw("activity", &ReportRequest::activity)
      .def_rw("activities", &ReportRequest::activities)
      .def_rw("sports", &ReportRequest::sports)
      .def_rw("colour_samples", &ReportRequest::colours)
      .def_prop_rw(
          "rays", [](const ReportRequest& r) { return r.rays; },
          [](ReportRequest& r, int v) { r.rays = power_of_two("rays", v); })
      .def_rw("has_picture", &ReportRequest::has_picture)
      .def_rw("camera", &ReportRequest::camera);
  module.def("report", made_report, nb::arg("solution"), nb::arg("request"), nb::arg("files"),
             nb::arg("language"), nb::arg("progress").none());
}

}  // namespace lightwell::python
