#include <fmt/format.h>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
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

Eigen::Vector3d vector_of(const char* what, const std::vector<double>& values) {
  if (values.size() == 3) return {values[0], values[1], values[2]};
  throw InputError(fmt::format("{} has {} coordinates; three are needed", what, values.size()));
}

/// A camera from a place towards a target, whose picture has `up` upwards.
struct View {
  std::string name{};
  std::vector<double> position{}, target{}, up{};
  std::optional<double> fov_degrees{};
  int width = 512, height = 512;
  std::string projection = "perspective";
  std::vector<double> shift{0.0, 0.0};
  std::vector<double> distortion{0.0, 0.0, 0.0, 0.0, 0.0};  ///< k1, k2, k3, p1, p2
};

Projection projection_of(const View& view) {
  if (const auto known = projection_named(view.projection)) return *known;
  std::string names;
  for (const NamedProjection& each : named_projections) names += fmt::format(" {}", each.name);
  throw InputError(fmt::format("camera '{}': there is no projection '{}'; choose from:{}",
                               view.name, view.projection, names));
}

void set_lens(const View& view, Camera& camera) {
  if (view.shift.size() != 2) {
    throw InputError(fmt::format(
        "camera '{}': shift has {} numbers; give two, shares of the width and of the height",
        view.name, view.shift.size()));
  }
  if (view.distortion.size() != 5) {
    throw InputError(
        fmt::format("camera '{}': distortion has {} numbers; give five, k1, k2, k3, p1 and p2",
                    view.name, view.distortion.size()));
  }
  camera.shift = {view.shift[0], view.shift[1]};
  camera.distortion = {.k1 = view.distortion[0],
                       .k2 = view.distortion[1],
                       .k3 = view.distortion[2],
                       .p1 = view.distortion[3],
                       .p2 = view.distortion[4]};
}

Camera camera_of(const View& view) {
  Camera camera{.name = view.name, .position = vector_of("position", view.position)};
  const Eigen::Vector3d ahead = vector_of("target", view.target) - camera.position;
  const Eigen::Vector3d up = vector_of("up", view.up);
  const Eigen::Vector3d upwards = up - ahead * (ahead.dot(up) / ahead.squaredNorm());
  if (!(ahead.norm() > 0.0) || !(upwards.norm() > parallel_sine * up.norm())) {
    throw InputError(
        fmt::format("camera '{}': it looks along its direction upwards, or nowhere; "
                    "give another target, or another direction upwards",
                    view.name));
  }
  camera.direction = ahead.normalized();
  camera.up = upwards.normalized();
  camera.projection = projection_of(view);
  camera.fov_degrees = view.fov_degrees.value_or(named(camera.projection).usual);
  camera.width = whole_number("width", view.width, 1, max_picture_edge);
  camera.height = whole_number("height", view.height, 1, max_picture_edge);
  set_lens(view, camera);
  validate(camera);
  return camera;
}

std::vector<double> coordinates(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

void add_camera(nb::module_& module) {
  nb::class_<View>(module, "View")
      .def(nb::init<>())
      .def_rw("name", &View::name)
      .def_rw("position", &View::position)
      .def_rw("target", &View::target)
      .def_rw("up", &View::up)
      .def_rw("fov_degrees", &View::fov_degrees)
      .def_rw("width", &View::width)
      .def_rw("height", &View::height)
      .def_rw("projection", &View::projection)
      .def_rw("shift", &View::shift)
      .def_rw("distortion", &View::distortion);
  module.def("camera_of", camera_of, nb::arg("view"));
  nb::class_<Camera>(module, "Camera")
      .def_prop_ro("name", [](const Camera& c) { return c.name; })
      .def_prop_ro("position", [](const Camera& c) { return coordinates(c.position); })
      .def_prop_ro("direction", [](const Camera& c) { return coordinates(c.direction); })
      .def_prop_ro("up", [](const Camera& c) { return coordinates(c.up); })
      .def_ro("fov_degrees", &Camera::fov_degrees)
      .def_ro("width", &Camera::width)
      .def_ro("height", &Camera::height)
      .def_prop_ro("projection",
                   [](const Camera& c) { return std::string(named(c.projection).name); })
      .def_prop_ro("shift",
                   [](const Camera& c) {
                     return std::vector{c.shift.x(), c.shift.y()};
                   })
      .def_prop_ro("distortion", [](const Camera& c) {
        const LensDistortion& d = c.distortion;
        return std::vector{d.k1, d.k2, d.k3, d.p1, d.p2};
      });
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

/// A scene without its faces: a name and a material for each surface.
struct SceneParts {
  std::string title{};
  std::vector<std::string> names{};
  std::vector<Material> materials{};
  std::vector<Camera> cameras{};
};

Scene scene_without_faces(const SceneParts& parts) {
  Scene scene{.title = parts.title, .materials = parts.materials, .cameras = parts.cameras};
  for (const std::string& name : parts.names) {
    scene.surfaces.push_back({.name = name, .material = static_cast<int>(scene.surfaces.size())});
  }
  return scene;
}

template <class Scalar>
auto entries(const ListIn<Scalar>& list) {
  return std::span<const Scalar>(list.data(), list.size());
}

SharedScene from_arrays(const SceneParts& parts, const PointsIn& vertices,
                        const ListIn<std::int32_t>& corners, const ListIn<std::int64_t>& first,
                        const ListIn<std::int32_t>& surface) {
  PolygonArrays polygons{.vertices = points_from(vertices)};
  polygons.corners.assign(entries(corners).begin(), entries(corners).end());
  polygons.first.assign(entries(first).begin(), entries(first).end());
  polygons.surface.assign(entries(surface).begin(), entries(surface).end());
  return result_of_long(nb::none(), [&](const Progress&) {
    NumberedScene faces = scene_of_polygons(scene_without_faces(parts), polygons);
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
      .def_prop_ro("cameras", [](const SceneData& s) { return s.given.cameras; })
      .def_prop_ro("notes", [](const SceneData& s) { return s.given.notes; })
      .def_prop_ro("losses", [](const SceneData& s) { return s.given.losses; })
      .def_prop_ro("gives_light", [](const SceneData& s) { return gives_light(s.given); })
      .def_prop_ro("hash", [](const SceneData& s) { return scene_hash(s.clean); })
      .def("triangles", triangles);
}

}  // namespace

void add_scene(nb::module_& module) {
  add_material(module);
  add_camera(module);
  add_scene_data(module);
  module.def("read", read, nb::arg("path"), nb::arg("inside_folder"), nb::arg("progress").none());
  nb::class_<SceneParts>(module, "SceneParts")
      .def(nb::init<>())
      .def_rw("title", &SceneParts::title)
      .def_rw("names", &SceneParts::names)
      .def_rw("materials", &SceneParts::materials)
      .def_rw("cameras", &SceneParts::cameras);
  module.def("from_arrays", from_arrays, nb::arg("parts"), nb::arg("vertices"), nb::arg("corners"),
             nb::arg("first"), nb::arg("surface"));
}

}  // namespace lightwell::python
