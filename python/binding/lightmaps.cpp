#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "python/binding/arrays.h"
#include "python/binding/checked.h"
#include "python/binding/long_work.h"
#include "python/binding/module.h"
#include "python/binding/solution_data.h"
#include "scene/errors.h"
#include "viewer/export/baked_model.h"
#include "viewer/export/export.h"
#include "viewer/export/lightmap.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

/// Lightmaps as Python holds them: triangles of charts, and the light of each atlas. Never changed
/// once made, so that arrays may be views.
struct LightmapData {
  int size = 0, padding = 0;
  std::size_t charts = 0;
  double texels_per_metre = 0.0;
  Bands bands{};
  std::vector<double> vertices{};  ///< m, three for each vertex
  std::vector<float>
      coordinates{};             ///< (0, 0) is an atlas's upper left corner, two for each vertex
  std::vector<int> triangles{};  ///< three vertices each
  std::vector<int> atlas{}, surface{}, chart{}, is_back{};  ///< of each triangle
  std::vector<LightmapAtlas> atlases{};
};
using SharedLightmaps = std::shared_ptr<const LightmapData>;

/// The model and the layout that all charts share.
struct Charted {
  const BakedModel& model;
  const LightmapLayout& layout;
};

// Appends the triangles of a chart of a part.
void add_chart(const Charted& of, int number, const BakedPart& part, LightmapData& made) {
  const auto c = static_cast<std::size_t>(number);
  const LightmapChart& chart = of.layout.charts[c];
  const auto base = static_cast<int>(made.coordinates.size() / 2);
  for (std::size_t v = 0; v < chart.vertices.size(); ++v) {
    const Eigen::Vector3d& p = of.model.position[static_cast<std::size_t>(chart.vertices[v])];
    const Eigen::Vector2d at = of.layout.texel(number, chart.place[v]) / of.layout.size;
    made.vertices.insert(made.vertices.end(), p.begin(), p.end());
    for (const double x : at) made.coordinates.push_back(static_cast<float>(x));
  }
  const auto add = [&](int i, int j, int k) {
    made.triangles.insert(made.triangles.end(), {base + i, base + j, base + k});
    made.atlas.push_back(of.layout.place[c].atlas);
    made.surface.push_back(part.surface);
    made.chart.push_back(number);
    made.is_back.push_back(part.is_back ? 1 : 0);
  };
  for (const auto& corners : chart.corners) {
    add(corners[0], corners[1], corners[2]);
    if (corners[3] >= 0) add(corners[0], corners[2], corners[3]);
  }
}

void add_charts(const Charted& of, LightmapData& made) {
  std::size_t part = 0;
  for (std::size_t c = 0; c < of.layout.charts.size(); ++c) {
    const int face = of.layout.charts[c].faces.front();
    // Charts come in the order of parts.
    while (face >= of.model.parts[part].first_face + of.model.parts[part].face_count) ++part;
    add_chart(of, static_cast<int>(c), of.model.parts[part], made);
  }
}

Sides sides_of(bool both) {
  return both ? Sides::both : Sides::front;
}

const SceneData& scene_or_nothing(const SolutionData& solution, const LightmapOptions& options) {
  static const SceneData nothing;
  if (options.pass != Pass::interpolate) return solution.its_scene("a lightmap of rays");
  return solution.scene ? *solution.scene : nothing;
}

SharedLightmaps lightmaps(const SharedSolution& solution, const LightmapOptions& asked,
                          bool both_sides, const nb::object& progress) {
  const SceneData& scene = scene_or_nothing(*solution, asked);
  return result_of_long(progress, [&](const Progress& run) -> SharedLightmaps {
    LightmapOptions options = asked;
    options.run.progress = run;
    const BakedModel model = bake_model(solution->solved, scene.clean, 0.0,
                                        scene.clean_up.names.get(), sides_of(both_sides));
    const LightmapLayout layout = lay_out_lightmap(model, solution->solved.mesh, options);
    auto made = std::make_shared<LightmapData>();
    made->size = layout.size;
    made->padding = layout.padding;
    made->charts = layout.charts.size();
    made->texels_per_metre = layout.texels_per_metre;
    made->bands = model.bands;
    add_charts({model, layout}, *made);
    for (int i = 0; i < layout.atlas_count; ++i) {
      report(run, "lightmap", static_cast<double>(i) / layout.atlas_count);
      made->atlases.push_back(
          paint_atlas(layout, i, model, solution->solved, scene.clean, options));
    }
    return made;
  });
}

void export_lightmaps(const SharedSolution& solution, const std::filesystem::path& path,
                      const LightmapOptions& asked, std::pair<double, bool> exposure_and_sides,
                      const nb::object& progress) {
  if (path.extension() != ".glb") {
    throw InputError("'" + path.string() + "' must end in .glb, the models with lightmaps");
  }
  const SceneData& scene = scene_or_nothing(*solution, asked);
  run_long(progress, [&](const Progress& run) {
    LightmapOptions options = asked;
    options.run.progress = run;
    const auto [exposure_ev, both_sides] = exposure_and_sides;
    const BakedModel model = bake_model(solution->solved, scene.clean, exposure_ev,
                                        scene.clean_up.names.get(), sides_of(both_sides));
    write_lightmapped_gltf(path, model, solution->solved, scene.clean, options);
  });
}

using Handle = nb::handle_t<LightmapData>;

const LightmapData& data_of(const Handle& self) {
  return nb::cast<const LightmapData&>(self);
}

template <class Scalar>
auto rows_of(std::vector<Scalar> LightmapData::*values, std::size_t columns) {
  return [values, columns](const Handle& self) {
    const std::vector<Scalar>& all = data_of(self).*values;
    return columns == 1 ? view_of(all.data(), {all.size()}, self)
                        : view_of(all.data(), {all.size() / columns, columns}, self);
  };
}

// A view of an atlas's picture, rows x columns x bands.
auto picture_of(BandArray LightmapAtlas::*values) {
  return [values](const Handle& self, std::size_t number) -> nb::object {
    const LightmapAtlas& atlas = data_of(self).atlases.at(number);
    const BandArray& picture = atlas.*values;
    if (picture.size() == 0) return nb::none();
    const auto size = static_cast<std::size_t>(atlas.size);
    return view_of(picture.data(), {size, size, static_cast<std::size_t>(picture.cols())}, self);
  };
}

Pass pass_named(const std::string& name) {
  if (name == "interpolate") return Pass::interpolate;
  if (name == "direct") return Pass::direct;
  if (name == "gather") return Pass::gather;
  throw InputError("there is no lightmap pass '" + name +
                   "'; choose from: interpolate, direct, gather");
}

void add_lightmap_options(nb::module_& module) {
  nb::class_<LightmapOptions>(module, "LightmapOptions")
      .def(nb::init<>())
      .def_prop_rw(
          "size", [](const LightmapOptions& o) { return o.size; },
          [](LightmapOptions& o, int v) {
            o.size = whole_number("size", v, least_lightmap_size, most_lightmap_size);
          })
      .def_prop_rw(
          "texels_per_metre", [](const LightmapOptions& o) { return o.texels_per_metre; },
          [](LightmapOptions& o, double v) {
            o.texels_per_metre = positive("texels_per_metre", v);
          })
      .def_prop_rw(
          "padding", [](const LightmapOptions& o) { return o.padding; },
          [](LightmapOptions& o, int v) { o.padding = whole_number("padding", v, 1, 64); })
      .def_prop_rw(
          "pass_", [](const LightmapOptions&) {},
          [](LightmapOptions& o, const std::string& v) { o.pass = pass_named(v); })
      .def_rw("channels", &LightmapOptions::per_channel);
}

}  // namespace

void add_lightmaps(nb::module_& module) {
  add_lightmap_options(module);
  nb::class_<LightmapData>(module, "LightmapData")
      .def_ro("size", &LightmapData::size)
      .def_ro("padding", &LightmapData::padding)
      .def_ro("charts", &LightmapData::charts)
      .def_ro("texels_per_metre", &LightmapData::texels_per_metre)
      .def_prop_ro("count", [](const LightmapData& l) { return l.atlases.size(); })
      .def_prop_ro("vertices", rows_of(&LightmapData::vertices, 3))
      .def_prop_ro("uv", rows_of(&LightmapData::coordinates, 2))
      .def_prop_ro("triangles", rows_of(&LightmapData::triangles, 3))
      .def_prop_ro("picture", rows_of(&LightmapData::atlas, 1))
      .def_prop_ro("surface", rows_of(&LightmapData::surface, 1))
      .def_prop_ro("chart", rows_of(&LightmapData::chart, 1))
      .def_prop_ro("back", rows_of(&LightmapData::is_back, 1))
      .def("irradiance", picture_of(&LightmapAtlas::irradiance))
      .def("radiosity", picture_of(&LightmapAtlas::radiosity))
      .def("radiance", picture_of(&LightmapAtlas::radiance))
      .def("lux_within", picture_of(&LightmapAtlas::lux_within))
      .def("lux",
           [](const LightmapData& l, std::size_t number) {
             const LightmapAtlas& atlas = l.atlases.at(number);
             const auto size = static_cast<std::size_t>(atlas.size);
             return owned(luminous_values(l.bands, atlas.irradiance), {size, size});
           })
      .def("covered", [](const LightmapData& l, std::size_t number) {
        const LightmapAtlas& atlas = l.atlases.at(number);
        std::vector<std::uint8_t> covered(atlas.face.size());
        for (std::size_t i = 0; i < covered.size(); ++i) covered[i] = atlas.face[i] >= 0 ? 1 : 0;
        const auto size = static_cast<std::size_t>(atlas.size);
        return owned(std::move(covered), {size, size});
      });
  module.def("lightmaps", lightmaps, nb::arg("solution"), nb::arg("options"), nb::arg("both_sides"),
             nb::arg("progress").none());
  module.def("export_lightmaps", export_lightmaps, nb::arg("solution"), nb::arg("path"),
             nb::arg("options"), nb::arg("exposure_and_sides"), nb::arg("progress").none());
}

}  // namespace lightwell::python
