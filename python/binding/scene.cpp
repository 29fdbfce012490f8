#include <fmt/format.h>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "python/binding/arrays.h"
#include "python/binding/long_work.h"
#include "python/binding/module.h"
#include "python/binding/scene_data.h"
#include "scene/errors.h"
#include "scene/io/polygon_arrays.h"
#include "scene/io/scene_text.h"
#include "scene/place_at_rest.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

using Numbers = std::vector<float>;

// Values of bands: one for all bands, or one for each.
Spectrum spectrum(const char* what, const Numbers& values) {
  const Bands bands = rgb_bands();
  if (values.size() == 1) return constant_spectrum(bands, values.front());
  if (static_cast<int>(values.size()) != bands.count()) {
    throw InputError(fmt::format("{} has {} values; give one, or one each for red, green and blue",
                                 what, values.size()));
  }
  return Eigen::Map<const Spectrum>(values.data(), bands.count());
}

Numbers numbers(const Spectrum& values) {
  return {values.begin(), values.end()};
}

void add_material(nb::module_& module) {
  nb::class_<Material>(module, "Material")
      .def(nb::init<>())
      .def_rw("name", &Material::name)
      .def_prop_rw(
          "reflectance", [](const Material& m) { return numbers(m.reflectance); },
          [](Material& m, const Numbers& v) { m.reflectance = spectrum("reflectance", v); })
      .def_prop_rw(
          "emission", [](const Material& m) { return numbers(m.emission); },
          [](Material& m, const Numbers& v) { m.emission = spectrum("emission", v); })
      .def_prop_rw(
          "specular", [](const Material& m) { return numbers(m.specular); },
          [](Material& m, const Numbers& v) { m.specular = spectrum("specular", v); })
      .def_prop_rw(
          "transmittance", [](const Material& m) { return numbers(m.transmittance); },
          [](Material& m, const Numbers& v) {
            const Spectrum passed = spectrum("transmittance", v);
            m.transmittance = (passed != 0.0f).any() ? passed : Spectrum();
          })
      .def_prop_rw("roughness", &Material::gloss_roughness,
                   [](Material& m, float v) { m.specular_roughness = v; })
      .def_rw("one_sided", &Material::one_sided)
      .def_rw("emits_both_sides", &Material::emits_both_sides);
}

SharedScene read(const std::filesystem::path& path, bool inside_folder,
                 const nb::object& progress) {
  const References references = inside_folder ? References::inside_folder : References::anywhere;
  return result_of_long(progress, [&](const Progress& run) {
    report(run, "reading", 0.0);
    Scene scene = read_scene(path, references);
    report(run, "clean-up", 0.0);
    SharedScene data = scene_data(std::move(scene), references);
    report(run, "clean-up", 1.0);
    return data;
  });
}

/// The surfaces of a scene without their faces: a name and a material for each.
struct SurfaceList {
  std::vector<std::string> names{};
  std::vector<Material> materials{};
  /// Number of a material of the scene's text, by its name, in place of the one above; empty: none.
  std::vector<std::string> named_materials{};
};

int material_named(const Scene& scene, const std::string& name) {
  const auto found = std::ranges::find(scene.materials, name, &Material::name);
  if (found == scene.materials.end()) {
    throw InputError(fmt::format("there is no material '{}'", name));
  }
  return static_cast<int>(found - scene.materials.begin());
}

void add_surfaces(const SurfaceList& list, Scene& scene) {
  for (std::size_t s = 0; s < list.names.size(); ++s) {
    int material = static_cast<int>(scene.materials.size());
    if (!list.named_materials[s].empty()) {
      material = material_named(scene, list.named_materials[s]);
    } else {
      scene.materials.push_back(list.materials[s]);
    }
    scene.surfaces.push_back({.name = list.names[s], .material = material});
  }
}

using PairsIn = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;

template <class Scalar>
auto entries(const ListIn<Scalar>& list) {
  return std::span<const Scalar>(list.data(), list.size());
}

SharedScene from_arrays(const SurfaceList& list, const SceneText& text, const PointsIn& vertices,
                        const ListIn<std::int32_t>& corners, const ListIn<std::int64_t>& first,
                        const ListIn<std::int32_t>& surface, const PairsIn& uv,
                        const PointsIn& normals) {
  PolygonArrays polygons{.vertices = points_from(vertices)};
  polygons.corners.assign(entries(corners).begin(), entries(corners).end());
  polygons.first.assign(entries(first).begin(), entries(first).end());
  polygons.surface.assign(entries(surface).begin(), entries(surface).end());
  polygons.normals = points_from(normals);
  polygons.uv.resize(uv.shape(0));
  for (std::size_t v = 0; v < polygons.uv.size(); ++v) polygons.uv[v] = {uv(v, 0), uv(v, 1)};
  return result_of_long(nb::none(), [&](const Progress&) {
    NumberedScene faces;
    Scene given = read_scene_text(text, [&](Scene& scene) {
      add_surfaces(list, scene);
      faces = scene_of_polygons(std::move(scene), polygons);
      scene = faces.scene;
    });
    faces.scene = given;
    SharedScene data = scene_data(std::move(given), text.references, std::move(faces), text);
    return data;
  });
}

SharedScene from_tables(const SceneText& text) {
  return result_of_long(nb::none(), [&](const Progress&) {
    Scene given = read_scene_text(text);
    NumberedScene faces = numbered_by_facets(given);
    return scene_data(std::move(given), text.references, std::move(faces), text);
  });
}

nb::tuple triangles(const SceneData& scene) {
  const PolygonArrays found = scene_triangles(scene.given);
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> points(
      static_cast<Eigen::Index>(found.vertices.size()), 3);
  for (std::size_t v = 0; v < found.vertices.size(); ++v) {
    points.row(static_cast<Eigen::Index>(v)) = found.vertices[v].transpose();
  }
  const std::size_t count = found.surface.size();
  return nb::make_tuple(owned(std::move(points), {found.vertices.size(), 3}),
                        owned(std::vector<int>(found.corners), {count, 3}),
                        owned(std::vector<int>(found.surface), {count}));
}

// Cameras with the coordinates of the file, which moving ones leave at the instant of the light.
std::vector<Camera> cameras_as_given(const SceneData& data) {
  std::vector<Camera> cameras;
  for (const Camera& camera : data.given.cameras) {
    cameras.push_back(placed_as_in_file(data.given, camera));
  }
  return cameras;
}

template <class Items, class Text>
std::vector<std::string> texts_of(const Items& items, const Text& text) {
  std::vector<std::string> texts;
  for (const auto& item : items) texts.push_back(text(item));
  return texts;
}

void add_scene_data(nb::module_& module) {
  nb::class_<SceneData>(module, "SceneData")
      .def_prop_ro("file", [](const SceneData& s) { return s.given.file.string(); })
      .def_prop_ro("title", [](const SceneData& s) { return s.given.title; })
      .def_prop_ro("metres_per_unit", [](const SceneData& s) { return s.given.metres_per_unit; })
      .def_prop_ro("unit_name", [](const SceneData& s) { return s.given.unit_name; })
      .def_prop_ro("relative_units", [](const SceneData& s) { return s.given.relative_units; })
      .def_prop_ro("bands", [](const SceneData& s) { return s.given.bands.names; })
      .def_prop_ro("names",
                   [](const SceneData& s) {
                     return texts_of(s.given.surfaces, [](const Surface& x) { return x.name; });
                   })
      .def_prop_ro("lamps",
                   [](const SceneData& s) {
                     return texts_of(s.given.lamps, [](const Lamp& x) { return x.name; });
                   })
      .def_prop_ro(
          "materials",
          [](const SceneData& s) {
            std::vector<Material> of_surfaces;
            for (const Surface& surface : s.given.surfaces) {
              of_surfaces.push_back(s.given.materials[static_cast<std::size_t>(surface.material)]);
            }
            return of_surfaces;
          })
      .def_prop_ro("areas",
                   [](const SceneData& s) {
                     std::vector<double> areas;
                     for (const Surface& surface : s.given.surfaces)
                       areas.push_back(surface_area(surface));
                     return areas;
                   })
      .def_prop_ro("cameras", cameras_as_given)
      .def_prop_ro("motions",
                   [](const SceneData& s) {
                     return texts_of(s.given.motions, [](const RigidMotion& x) { return x.name; });
                   })
      .def_prop_ro("notes", [](const SceneData& s) { return s.given.notes; })
      .def_prop_ro("losses", [](const SceneData& s) { return s.given.losses; })
      .def_prop_ro("gives_light", [](const SceneData& s) { return gives_light(s.given); })
      .def_prop_ro("hash", [](const SceneData& s) { return scene_hash(s.clean); })
      .def("triangles", triangles);
}

}  // namespace

void add_scene(nb::module_& module) {
  add_material(module);
  add_scene_data(module);
  module.def("read", read, nb::arg("path"), nb::arg("inside_folder"), nb::arg("progress").none());
  nb::class_<SurfaceList>(module, "SurfaceList")
      .def(nb::init<>())
      .def_rw("names", &SurfaceList::names)
      .def_rw("materials", &SurfaceList::materials)
      .def_rw("named_materials", &SurfaceList::named_materials);
  nb::class_<SceneText>(module, "SceneText")
      .def(
          "__init__",
          [](SceneText* made, std::string text, const std::filesystem::path& folder,
             bool inside_folder) {
            new (made) SceneText{
                .text = std::move(text),
                .folder = folder,
                .references = inside_folder ? References::inside_folder : References::anywhere};
          },
          nb::arg("text"), nb::arg("folder"), nb::arg("inside_folder"))
      .def_ro("text", &SceneText::text);
  module.def("from_arrays", from_arrays, nb::arg("surfaces"), nb::arg("text"), nb::arg("vertices"),
             nb::arg("corners"), nb::arg("first"), nb::arg("surface"), nb::arg("uv"),
             nb::arg("normals"));
  module.def("from_tables", from_tables, nb::arg("text"));
}

}  // namespace lightwell::python
