#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "python/binding/arrays.h"
#include "python/binding/checked.h"
#include "python/binding/found_form_factors.h"
#include "python/binding/long_work.h"
#include "python/binding/module.h"
#include "python/binding/scene_data.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

// The facets of a scene: those given, or those of its file, which is read as the command line does,
// with materials and texture left aside.
NumberedScene faces_of(const SceneData& scene) {
  return scene.faces ? *scene.faces : read_numbered_scene(scene.given.file, scene.references);
}

FoundFormFactors form_factors(const SharedScene& scene, const FacetViewFactorOptions& asked,
                              const nb::object& progress) {
  return result_of_long(progress, [&](const Progress& run) {
    const NumberedScene numbered = faces_of(*scene);
    const FacetCheck check = check_facets(numbered.scene);
    FacetViewFactorOptions options = asked;
    options.progress = run;
    return FoundFormFactors{.factors = facet_view_factors(numbered, check, options),
                            .notes = findings(numbered, check),
                            .facets = numbered.rows.size()};
  });
}

/// Rows of sparse factors: the arrays of scipy.sparse.csr_array.
nb::tuple csr(const FoundFormFactors& found) {
  const ViewFactors& F = found.factors.factors;
  std::vector<float> values;
  std::vector<std::int32_t> columns;
  std::vector<std::int64_t> first = {0};
  values.reserve(static_cast<std::size_t>(F.entry_count()));
  columns.reserve(values.capacity());
  for (int i = 0; i < F.row_count(); ++i) {
    for (const FormFactor& f : F.row(i)) {
      values.push_back(f.value);
      columns.push_back(f.patch);
    }
    first.push_back(static_cast<std::int64_t>(values.size()));
  }
  const std::size_t entries = values.size(), rows = first.size();
  return nb::make_tuple(owned(std::move(values), {entries}), owned(std::move(columns), {entries}),
                        owned(std::move(first), {rows}));
}

template <class Scalar>
auto list_of(const std::vector<Scalar>& values) {
  return owned(std::vector<Scalar>(values), {values.size()});
}

void add_form_factor_options(nb::module_& module) {
  using Options = FacetViewFactorOptions;
  nb::class_<Options>(module, "FormFactorOptions")
      .def(nb::init<>())
      .def_prop_rw(
          "method", [](const Options&) {},
          [](Options& o, const std::string& name) { o.method = form_factor_method(name); })
      .def_prop_rw(
          "target_error", [](const Options& o) { return o.target_error; },
          [](Options& o, double error) { o.target_error = positive("target_error", error); })
      .def_prop_rw(
          "max_patch_size", [](const Options& o) { return o.max_patch_size; },
          [](Options& o, double size) { o.max_patch_size = positive("max_patch_size", size); })
      .def_prop_rw(
          "hemicube_resolution", [](const Options& o) { return o.hemicube_resolution; },
          [](Options& o, int cells) {
            o.hemicube_resolution = even_number("hemicube_resolution", cells);
          })
      .def_rw("two_sided", &Options::two_sided)
      .def_prop_rw(
          "memory", [](const Options& o) { return o.memory.limit; },
          [](Options& o, double bytes) { o.memory.limit = bytes_of_memory(bytes); });
}

}  // namespace

void add_form_factors(nb::module_& module) {
  add_form_factor_options(module);
  nb::class_<FoundFormFactors>(module, "FoundFormFactors")
      .def("csr", csr)
      .def_prop_ro("area",
                   [](const FoundFormFactors& f) { return list_of(f.factors.factors.area); })
      .def_prop_ro("open",
                   [](const FoundFormFactors& f) { return list_of(f.factors.factors.open); })
      .def_prop_ro("blocked",
                   [](const FoundFormFactors& f) { return list_of(f.factors.factors.blocked); })
      .def_prop_ro("facet", [](const FoundFormFactors& f) { return list_of(f.factors.rows.facet); })
      .def_prop_ro("emittance",
                   [](const FoundFormFactors& f) { return list_of(f.factors.rows.emittance); })
      .def_prop_ro("name", [](const FoundFormFactors& f) { return f.factors.rows.name; })
      .def_prop_ro("is_back",
                   [](const FoundFormFactors& f) { return list_of(f.factors.rows.is_back); })
      .def_prop_ro("notes", [](const FoundFormFactors& f) { return f.notes; })
      .def_prop_ro("error", [](const FoundFormFactors& f) { return f.factors.error; })
      .def_prop_ro("has_rays_alone",
                   [](const FoundFormFactors& f) { return f.factors.has_rays_alone; })
      .def_prop_ro("facets", [](const FoundFormFactors& f) { return f.facets; })
      .def_prop_ro("patches",
                   [](const FoundFormFactors& f) { return f.factors.mesh.patch_count(); })
      .def_prop_ro("rays", [](const FoundFormFactors& f) { return f.factors.report.rays; })
      .def_prop_ro("closure_max_error",
                   [](const FoundFormFactors& f) { return closure_error(f.factors.factors); })
      .def_prop_ro("reciprocity_max_error",
                   [](const FoundFormFactors& f) { return reciprocity_error(f.factors.factors); });
  module.def("form_factors", form_factors, nb::arg("scene"), nb::arg("options"),
             nb::arg("progress").none());
}

}  // namespace lightwell::python
