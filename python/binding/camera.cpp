#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "python/binding/module.h"
#include "python/binding/scene_data.h"
#include "scene/io/scene_text.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

using Numbers = std::vector<double>;

Numbers coordinates(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

// Pixels of the whole picture, of which a camera may render a part.
int whole_size(int pixels, double share) {
  return static_cast<int>(std::lround(pixels / share));
}

// Degrees from left to right; none of projections that have no angle.
std::optional<double> angle(const Camera& c) {
  const bool has_angle =
      c.projection != Projection::orthographic && c.projection != Projection::cube_map;
  return has_angle ? std::optional(c.fov_degrees) : std::nullopt;
}

// A value where a condition holds.
template <class Value>
std::optional<Value> where(bool holds, const Value& value) {
  return holds ? std::optional(value) : std::nullopt;
}

void add_lens(nb::class_<Camera>& camera) {
  camera.def_prop_ro("shift",
                     [](const Camera& c) {
                       return Numbers{c.shift.x(), c.shift.y()};
                     })
      .def_prop_ro("distortion",
                   [](const Camera& c) {
                     const LensDistortion& d = c.distortion;
                     return Numbers{d.k1, d.k2, d.k3, d.p1, d.p2};
                   })
      .def_prop_ro("aperture_radius",
                   [](const Camera& c) { return where(c.lens_radius > 0.0, c.lens_radius); })
      .def_prop_ro("focus_distance",
                   [](const Camera& c) { return where(c.lens_radius > 0.0, c.focus_distance); })
      .def_prop_ro("blades", [](const Camera& c) { return where(c.blades > 0, c.blades); })
      .def_prop_ro("shutter",
                   [](const Camera& c) {
                     return where(c.shutter_open != 0.0 || c.shutter_close != 0.0,
                                  Numbers{c.shutter_open, c.shutter_close});
                   })
      .def_ro("motion", &Camera::motion);
}

void add_extent(nb::class_<Camera>& camera) {
  camera.def_prop_ro("fov_degrees", angle)
      .def_prop_ro("view_width",
                   [](const Camera& c) {
                     return where(c.projection == Projection::orthographic, c.view_width);
                   })
      .def_ro("near_distance", &Camera::near_distance)
      .def_prop_ro(
          "far_distance",
          [](const Camera& c) { return where(std::isfinite(c.far_distance), c.far_distance); })
      .def_prop_ro("width", [](const Camera& c) { return whole_size(c.width, c.window.width()); })
      .def_prop_ro("height",
                   [](const Camera& c) { return whole_size(c.height, c.window.height()); })
      .def_prop_ro("crop",
                   [](const Camera& c) {
                     const PictureWindow& w = c.window;
                     return Numbers{w.left, w.top, w.right, w.bottom};
                   })
      .def_prop_ro("circle",
                   [](const Camera& c) { return where(c.circle_degrees > 0.0, c.circle_degrees); })
      .def_prop_ro("eye_separation", [](const Camera& c) {
        return where(c.projection == Projection::stereo_panorama, c.eye_separation);
      });
}

}  // namespace

void add_camera(nb::module_& module) {
  nb::class_<Camera> camera(module, "Camera");
  camera.def_prop_ro("name", [](const Camera& c) { return c.name; })
      .def_prop_ro("position", [](const Camera& c) { return coordinates(c.position); })
      .def_prop_ro("direction", [](const Camera& c) { return coordinates(c.direction); })
      .def_prop_ro("up", [](const Camera& c) { return coordinates(c.up); })
      .def_prop_ro("projection",
                   [](const Camera& c) { return std::string(named(c.projection).name); });
  add_lens(camera);
  add_extent(camera);
  module.def(
      "camera_of",
      [](const SharedScene& scene, const std::string& text) {
        return read_camera_text(text, scene ? scene->given : Scene());
      },
      nb::arg("scene").none(), nb::arg("text"));
}

}  // namespace lightwell::python
