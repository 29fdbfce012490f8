#include "radiosity/solution/solution.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <utility>
#include <vector>

#include "mesh/patches/patch_textures.h"
#include "python/binding/arrays.h"
#include "python/binding/checked.h"
#include "python/binding/long_work.h"
#include "python/binding/module.h"
#include "python/binding/solution_data.h"
#include "radiosity/solution/channel_settings.h"
#include "radiosity/solution/solution_file.h"
#include "raytrace/readings/probe.h"
#include "scene/errors.h"

namespace nb = nanobind;

namespace lightwell::python {

const SceneData& SolutionData::its_scene(const char* what) const {
  if (scene) return *scene;
  throw InputError(std::string(what) +
                   " needs the scene of the solution; give it to lightwell.load(path, scene)");
}

namespace {

using Handle = nb::handle_t<SolutionData>;

const SolutionData& data_of(const Handle& self) {
  return nb::cast<const SolutionData&>(self);
}

ArrayOut view_of_bands(const BandArray& values, const Handle& self) {
  return view_of(values.data(),
                 {static_cast<std::size_t>(values.rows()), static_cast<std::size_t>(values.cols())},
                 self);
}

template <class Scalar>
ArrayOut view_of_list(const Scalar* data, std::size_t count, const Handle& self) {
  return view_of(data, {count}, self);
}

// Values per vertex as lx.
ArrayOut lux_of(const Bands& bands, const BandArray& E) {
  std::vector<double> lux = luminous_values(bands, E);
  const std::size_t count = lux.size();
  return owned(std::move(lux), {count});
}

nb::dict energy_of(const SolutionData& s) {
  const EnergyBalance& energy = s.solved.solution.energy;
  nb::dict values;
  values["emitted"] = energy.emitted;
  values["absorbed"] = energy.absorbed;
  values["escaped"] = energy.escaped;
  values["unshot"] = energy.unshot;
  values["from_lamps"] = energy.from_lamps;
  values["missed"] = energy.missed;
  return values;
}

std::string outcome_of(const SolutionData& s) {
  switch (s.solved.solution.outcome) {
    case Outcome::converged:
      return "converged";
    case Outcome::max_sweeps_reached:
      return "max_sweeps_reached";
    case Outcome::accuracy_missed:
      return "accuracy_missed";
    case Outcome::cut_short:
      break;
  }
  return "cut_short";
}

ArrayOut probe(const SharedSolution& solution, const PointsIn& points, const PointsIn& normals,
               int rays, const nb::object& progress) {
  const std::vector<Probe> probes = probes_from(points, normals);
  power_of_two("rays", rays);
  const SceneData& scene = solution->its_scene("a gather at points");
  return owned_bands(result_of_long(progress, [&](const Progress& run) {
    const SolvedScene& solved = solution->solved;
    const ElementCaster caster(solved.mesh);
    return probe_irradiance(scene.clean, caster, DirectLight(scene.clean, caster), solved.solution,
                            probes, {.rays = rays, .run = {.progress = run}});
  }));
}

nb::tuple probe_with_bounds(const SharedSolution& solution, const PointsIn& points,
                            const PointsIn& normals, double accuracy, int rays,
                            const nb::object& progress) {
  const std::vector<Probe> probes = probes_from(points, normals);
  power_of_two("rays", rays);
  const SceneData& scene = solution->its_scene("a gather at points");
  ProbeBounds bounds{.accuracy = accuracy};
  BandArray E = result_of_long(progress, [&](const Progress& run) {
    const SolvedScene& solved = solution->solved;
    const ElementCaster caster(solved.mesh);
    return probe_irradiance(scene.clean, caster, DirectLight(scene.clean, caster), solved.solution,
                            probes, {.rays = rays, .run = {.progress = run}}, &bounds);
  });
  const ArrayOut lux = lux_of(solution->solved.solution.bands, E);
  const std::size_t count = probes.size();
  return nb::make_tuple(owned_bands(std::move(E)), lux,
                        owned(std::move(bounds.lux_within), {count}));
}

ArrayOut interpolate(const SharedSolution& solution, const PointsIn& points,
                     const PointsIn& normals) {
  const std::vector<Probe> probes = probes_from(points, normals);
  return owned_bands(result_of_long(nb::none(), [&](const Progress&) {
    const SolvedScene& solved = solution->solved;
    return interpolate_irradiance(ElementCaster(solved.mesh), solved.solution, probes);
  }));
}

using Words = std::pair<std::string, std::string>;

SharedSolution relit(const SharedSolution& solution, const std::vector<Words>& words) {
  return result_of_long(nb::none(), [&](const Progress&) -> SharedSolution {
    const RadiositySolution& from = solution->solved.solution;
    require_channels(from);
    std::vector<NamedSetting> settings;
    for (const auto& [name, value] : words) {
      settings.push_back({.channels = name, .setting = channel_setting(value), .place = "relight"});
    }
    const std::vector<Spectrum> scales = apply_settings(from, settings, effective_scales(from));
    auto made = std::make_shared<SolutionData>(*solution);
    relight(made->solved, scales);
    return made;
  });
}

SharedSolution load(const std::filesystem::path& path, const SharedScene& scene) {
  return result_of_long(nb::none(), [&](const Progress&) -> SharedSolution {
    auto made = std::make_shared<SolutionData>();
    made->solved = read_solution(path);
    if (!scene) return made;
    made->scene = scene;
    check_matches(scene->clean, made->solved.solution);
    attach_textures(scene->clean, made->solved.mesh);
    made->solved.solution.relative_units = scene->clean.relative_units;
    return made;
  });
}

void save(const SharedSolution& solution, const std::filesystem::path& path) {
  run_long(nb::none(), [&](const Progress&) { write_solution(path, solution->solved); });
}

using SolutionClass = nb::class_<SolutionData>;

void add_mesh_arrays(SolutionClass& solution) {
  solution
      .def_prop_ro(
          "vertices",
          [](Handle self) {
            const PatchMesh& mesh = data_of(self).solved.mesh;
            const auto* const first =
                mesh.vertex_count() > 0 ? mesh.elements->points()->data() : nullptr;
            return view_of(first, {static_cast<std::size_t>(mesh.vertex_count()), 3}, self);
          })
      .def_prop_ro("normals",
                   [](Handle self) {
                     const PatchMesh& mesh = data_of(self).solved.mesh;
                     const auto count = static_cast<std::size_t>(mesh.vertex_count());
                     return view_of(count > 0 ? mesh.vertex_normal.front().data() : nullptr,
                                    {count, 3}, self);
                   })
      .def_prop_ro(
          "elements",
          [](Handle self) {
            const PatchMesh& mesh = data_of(self).solved.mesh;
            const auto count = static_cast<std::size_t>(mesh.element_count());
            return view_of(count > 0 ? mesh.corners.front().data() : nullptr, {count, 4}, self);
          })
      .def_prop_ro("element_patch",
                   [](Handle self) {
                     const auto& list = data_of(self).solved.mesh.patch;
                     return view_of_list(list.data(), list.size(), self);
                   })
      .def_prop_ro("element_area",
                   [](Handle self) {
                     const auto& list = data_of(self).solved.mesh.element_area;
                     return view_of_list(list.data(), static_cast<std::size_t>(list.size()), self);
                   })
      .def_prop_ro("patch_area",
                   [](Handle self) {
                     const auto& list = data_of(self).solved.mesh.area;
                     return view_of_list(list.data(), static_cast<std::size_t>(list.size()), self);
                   })
      .def_prop_ro("patch_surface", [](Handle self) {
        const auto& list = data_of(self).solved.mesh.surface;
        return view_of_list(list.data(), list.size(), self);
      });
}

void add_light_arrays(SolutionClass& solution) {
  solution
      .def_prop_ro("direct_irradiance",
                   [](Handle self) {
                     return view_of_bands(data_of(self).solved.solution.direct_irradiance, self);
                   })
      .def_prop_ro("indirect_irradiance",
                   [](Handle self) {
                     return view_of_bands(data_of(self).solved.solution.indirect_irradiance, self);
                   })
      .def_prop_ro("caustic_irradiance",
                   [](Handle self) {
                     return view_of_bands(data_of(self).solved.solution.caustic_irradiance, self);
                   })
      .def_prop_ro("patch_radiosity",
                   [](Handle self) {
                     return view_of_bands(data_of(self).solved.solution.patch_radiosity, self);
                   })
      .def_prop_ro(
          "patch_reflectance",
          [](Handle self) { return view_of_bands(data_of(self).solved.mesh.reflectance, self); })
      .def_prop_ro(
          "patch_emission",
          [](Handle self) { return view_of_bands(data_of(self).solved.mesh.emission, self); })
      .def_prop_ro(
          "irradiance",
          [](const SolutionData& s) { return owned_bands(s.solved.solution.irradiance()); })
      .def_prop_ro("radiosity",
                   [](const SolutionData& s) {
                     return owned_bands(vertex_radiosity(s.solved.mesh, s.solved.solution));
                   })
      .def_prop_ro("lux",
                   [](const SolutionData& s) {
                     const RadiositySolution& solved = s.solved.solution;
                     return lux_of(solved.bands, solved.irradiance());
                   })
      .def_prop_ro("element_error", [](const SolutionData& s) {
        Eigen::ArrayXf bound = error_bound(s.solved.solution);
        const auto count = static_cast<std::size_t>(bound.size());
        return owned(std::move(bound), {count});
      });
}

void add_figures(SolutionClass& solution) {
  solution.def_prop_ro("energy", energy_of)
      .def_prop_ro("outcome", outcome_of)
      .def_prop_ro("error", [](const SolutionData& s) { return s.solved.solution.error_estimate; })
      .def_prop_ro("residual", [](const SolutionData& s) { return s.solved.solution.residual; })
      .def_prop_ro("sweeps", [](const SolutionData& s) { return s.solved.solution.history.size(); })
      .def_prop_ro("solver", [](const SolutionData& s) { return s.solved.solution.solver; })
      .def_prop_ro("refinement", [](const SolutionData& s) { return s.refinement; })
      .def_ro("unkept", &SolutionData::unkept)
      .def_prop_ro("looked_from",
                   [](const SolutionData& s) { return s.solved.solution.provenance.looked_from; })
      .def_prop_ro("notes", [](const SolutionData& s) { return s.solved.mesh.notes; })
      .def_prop_ro("bands", [](const SolutionData& s) { return s.solved.solution.bands.names; })
      .def_prop_ro("relative_units",
                   [](const SolutionData& s) { return s.solved.solution.relative_units; })
      .def_prop_ro("options",
                   [](const SolutionData& s) { return s.solved.solution.provenance.options; })
      .def_prop_ro("scene", [](const SolutionData& s) { return s.scene; })
      .def_prop_ro("seconds",
                   [](const SolutionData& s) {
                     nb::dict seconds;
                     for (const auto& [phase, time] : s.solved.solution.seconds) {
                       seconds[phase.c_str()] = time;
                     }
                     return seconds;
                   })
      .def_prop_ro("channels", [](const SolutionData& s) {
        nb::dict fluxes;
        const RadiositySolution& solved = s.solved.solution;
        for (const LightChannel& channel : solved.channels) {
          fluxes[channel.name.c_str()] = luminous(solved.bands, emitted_flux(channel));
        }
        return fluxes;
      });
}

}  // namespace

void add_solution(nb::module_& module) {
  SolutionClass solution(module, "SolutionData");
  add_mesh_arrays(solution);
  add_light_arrays(solution);
  add_figures(solution);
  module.def("probe", probe, nb::arg("solution"), nb::arg("points"), nb::arg("normals"),
             nb::arg("rays"), nb::arg("progress").none());
  module.def("probe_with_bounds", probe_with_bounds, nb::arg("solution"), nb::arg("points"),
             nb::arg("normals"), nb::arg("accuracy"), nb::arg("rays"), nb::arg("progress").none());
  module.def("interpolate", interpolate, nb::arg("solution"), nb::arg("points"),
             nb::arg("normals"));
  module.def("relight", relit, nb::arg("solution"), nb::arg("settings"));
  module.def("share", [](const std::string& option, const std::string& text) {
    return share(option.c_str(), text);
  });
  module.def("load", load, nb::arg("path"), nb::arg("scene").none());
  module.def("save", save, nb::arg("solution"), nb::arg("path"));
}

}  // namespace lightwell::python
