#include <fmt/format.h>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <vector>

#include "python/binding/arrays.h"
#include "python/binding/checked.h"
#include "python/binding/long_work.h"
#include "python/binding/module.h"
#include "python/binding/scene_data.h"
#include "scene/errors.h"
#include "scene/io/polygon_arrays.h"
#include "scene/limits.h"

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

void make_material(Material& material, const std::string& name, const Numbers& reflectance,
                   const Numbers& emission, const Numbers& specular, float roughness,
                   const Numbers& transmittance, bool one_sided, bool emits_both_sides) {
  Material made{.name = name,
                .reflectance = spectrum("reflectance", reflectance),
                .specular = spectrum("specular", specular),
                .specular_roughness = roughness,
                .emission = spectrum("emission", emission),
                .one_sided = one_sided,
                .emits_both_sides = emits_both_sides};
  const Spectrum passed = spectrum("transmittance", transmittance);
  if ((passed != 0.0f).any()) made.transmittance = passed;
  new (&material) Material(std::move(made));
}

void add_material(nb::module_& module) {
  nb::class_<Material>(module, "Material")
      .def("__init__", make_material, nb::arg("name"), nb::arg("reflectance"), nb::arg("emission"),
           nb::arg("specular"), nb::arg("roughness"), nb::arg("transmittance"),
           nb::arg("one_sided"), nb::arg("emits_both_sides"))
      .def_prop_ro("name", [](const Material& m) { return m.name; })
      .def_prop_ro("reflectance", [](const Material& m) { return numbers(m.reflectance); })
      .def_prop_ro("emission", [](const Material& m) { return numbers(m.emission); })
      .def_prop_ro("specular", [](const Material& m) { return numbers(m.specular); })
      .def_prop_ro("roughness", &Material::gloss_roughness)
      .def_prop_ro("transmittance", [](const Material& m) { return numbers(m.transmittance); })
      .def_prop_ro("one_sided", [](const Material& m) { return m.one_sided; })
      .def_prop_ro("emits_both_sides", [](const Material& m) { return m.emits_both_sides; });
}

Eigen::Vector3d vector_of(const char* what, const std::vector<double>& values) {
  if (values.size() == 3) return {values[0], values[1], values[2]};
  throw InputError(fmt::format("{} has {} coordinates; three are needed", what, values.size()));
}

// A camera from `position` towards `target`, whose picture has `up` upwards.
void make_camera(Camera& camera, const std::string& name, const std::vector<double>& position,
                 const std::vector<double>& target, const std::vector<double>& up,
                 std::optional<double> fov_degrees, int width, int height,
                 const std::string& projection) {
  Camera made{.name = name, .position = vector_of("position", position)};
  const Eigen::Vector3d ahead = vector_of("target", target) - made.position;
  const Eigen::Vector3d given_up = vector_of("up", up);
  const Eigen::Vector3d upwards = given_up - ahead * (ahead.dot(given_up) / ahead.squaredNorm());
  if (!(ahead.norm() > 0.0) || !(upwards.norm() > parallel_sine * given_up.norm())) {
    throw InputError(
        fmt::format("camera '{}': it looks along its direction upwards, or nowhere; "
                    "give another target, or another direction upwards",
                    name));
  }
  made.direction = ahead.normalized();
  made.up = upwards.normalized();
  const auto known = projection_named(projection);
  if (!known) {
    std::string names;
    for (const NamedProjection& each : named_projections) names += fmt::format(" {}", each.name);
    throw InputError(fmt::format("camera '{}': there is no projection '{}'; choose from:{}", name,
                                 projection, names));
  }
  made.projection = *known;
  made.fov_degrees = fov_degrees.value_or(named(*known).usual);
  made.width = whole_number("width", width, 1, max_picture_edge);
  made.height = whole_number("height", height, 1, max_picture_edge);
  validate(made);
  new (&camera) Camera(std::move(made));
}

std::vector<double> coordinates(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

void add_camera(nb::module_& module) {
  nb::class_<Camera>(module, "Camera")
      .def("__init__", make_camera, nb::arg("name"), nb::arg("position"), nb::arg("target"),
           nb::arg("up"), nb::arg("fov_degrees").none(), nb::arg("width"), nb::arg("height"),
           nb::arg("projection"))
      .def_prop_ro("name", [](const Camera& c) { return c.name; })
      .def_prop_ro("position", [](const Camera& c) { return coordinates(c.position); })
      .def_prop_ro("direction", [](const Camera& c) { return coordinates(c.direction); })
      .def_prop_ro("up", [](const Camera& c) { return coordinates(c.up); })
      .def_ro("fov_degrees", &Camera::fov_degrees)
      .def_ro("width", &Camera::width)
      .def_ro("height", &Camera::height)
      .def_prop_ro("projection",
                   [](const Camera& c) { return std::string(named(c.projection).name); });
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

/// The faces of a scene as Python's arrays.
struct Faces {
  PointsIn vertices;
  ListIn<std::int32_t> corners;
  ListIn<std::int64_t> first;
  ListIn<std::int32_t> surface;

  PolygonArrays polygons() const {
    PolygonArrays made{.vertices = points_from(vertices)};
    made.corners.assign(corners.data(), corners.data() + corners.size());
    made.first.assign(first.data(), first.data() + first.size());
    made.surface.assign(surface.data(), surface.data() + surface.size());
    return made;
  }
};

SharedScene from_arrays(const PointsIn& vertices, const ListIn<std::int32_t>& corners,
                        const ListIn<std::int64_t>& first, const ListIn<std::int32_t>& surface,
                        const std::vector<std::string>& names,
                        const std::vector<Material>& materials, const std::vector<Camera>& cameras,
                        const std::string& title) {
  Scene scene{.title = title, .materials = materials, .cameras = cameras};
  for (std::size_t s = 0; s < names.size(); ++s) {
    scene.surfaces.push_back({.name = names[s], .material = static_cast<int>(s)});
  }
  const PolygonArrays polygons = Faces{vertices, corners, first, surface}.polygons();
  return result_of_long(nb::none(), [&](const Progress&) {
    NumberedScene faces = scene_of_polygons(std::move(scene), polygons);
    Scene given = faces.scene;
    return scene_data(std::move(given), References::anywhere, std::move(faces));
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

template <class Items, class Text>
std::vector<std::string> texts_of(const Items& items, const Text& text) {
  std::vector<std::string> texts;
  for (const auto& item : items) texts.push_back(text(item));
  return texts;
}

}  // namespace

void add_scene(nb::module_& module) {
  add_material(module);
  add_camera(module);
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
      .def_prop_ro("cameras", [](const SceneData& s) { return s.given.cameras; })
      .def_prop_ro("notes", [](const SceneData& s) { return s.given.notes; })
      .def_prop_ro("losses", [](const SceneData& s) { return s.given.losses; })
      .def_prop_ro("gives_light", [](const SceneData& s) { return gives_light(s.given); })
      .def_prop_ro("hash", [](const SceneData& s) { return scene_hash(s.clean); })
      .def("triangles", triangles);
  module.def("read", read, nb::arg("path"), nb::arg("inside_folder"), nb::arg("progress").none());
  module.def("from_arrays", from_arrays, nb::arg("vertices"), nb::arg("corners"), nb::arg("first"),
             nb::arg("surface"), nb::arg("names"), nb::arg("materials"), nb::arg("cameras"),
             nb::arg("title"));
}

}  // namespace lightwell::python
