#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/binding/arrays.h"
#include "python/binding/checked.h"
#include "python/binding/long_work.h"
#include "python/binding/module.h"
#include "python/binding/solution_data.h"
#include "raytrace/cameras/choose_camera.h"
#include "raytrace/pictures/image.h"
#include "raytrace/scene_renderer.h"
#include "raytrace/shading/picture_quality.h"
#include "scene/errors.h"
#include "scene/limits.h"
#include "viewer/export/baked_model.h"
#include "viewer/export/export.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

using PictureIn = nb::ndarray<const float, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;

/// Options of a picture, by their names.
struct PictureSettings {
  std::string pass = "auto", quality = "good";
  std::optional<int> shadow_rays{}, photons{}, gather_samples{}, virtual_lights{}, depth{};
  std::optional<int> samples{};
  std::optional<double> noise{};
  std::optional<int> width{}, height{};  ///< the width alone keeps the camera's shape

  RenderOptions options() const {
    PictureQuality numbers = picture_quality(quality);
    numbers.shadow_rays = shadow_rays.value_or(numbers.shadow_rays);
    numbers.photons = photons.value_or(numbers.photons);
    numbers.noise = noise.value_or(numbers.noise);
    RenderOptions options = picture_options(pass, quality, numbers);
    options.gather_rays = gather_samples.value_or(options.gather_rays);
    options.virtual_lights = virtual_lights.value_or(options.virtual_lights);
    options.max_depth = depth.value_or(options.max_depth);
    options.sampling.most = samples.value_or(options.sampling.most);
    validate(options);
    return options;
  }
};

// Linear sRGB of a picture in any bands, rows x columns x 3.
BandArray rgb_of(Image image, const Bands& bands) {
  if (bands.wavelengths_nm.empty()) return std::move(image.radiance);
  BandArray rgb(image.radiance.rows(), 3);
  for (Eigen::Index i = 0; i < rgb.rows(); ++i) {
    const Eigen::Array3f colour = linear_rgb(bands, image.radiance.row(i).transpose());
    for (int c = 0; c < 3; ++c) rgb(i, c) = colour[c];
  }
  return rgb;
}

Camera sized(Camera camera, const PictureSettings& settings) {
  if (!settings.width) return camera;
  const int width = whole_number("width", *settings.width, 1, max_picture_edge);
  if (!settings.height) return resized(camera, width);
  set_picture_size(width, whole_number("height", *settings.height, 1, max_picture_edge), camera);
  return camera;
}

ArrayOut render_camera(const SharedSolution& solution, const Camera& asked,
                       const PictureSettings& settings, const nb::object& progress) {
  const SceneData& scene = solution->its_scene("a picture");
  const Camera camera = sized(asked, settings);
  RenderOptions options = settings.options();
  BandArray rgb = result_of_long(progress, [&](const Progress& run) {
    const SolvedScene& solved = solution->solved;
    options.run.progress = run;
    SceneRenderer renderer(scene.clean, solved.mesh, solved.solution);
    return rgb_of(renderer.render(camera, options), solved.solution.bands);
  });
  return owned(std::move(rgb), {static_cast<std::size_t>(camera.height),
                                static_cast<std::size_t>(camera.width), 3});
}

Camera camera_named(const SharedSolution& solution, const std::string& name) {
  return choose_camera(solution->its_scene("a picture").clean, name);
}

Image image_from(const PictureIn& picture) {
  Image image{.width = static_cast<int>(picture.shape(1)),
              .height = static_cast<int>(picture.shape(0))};
  image.radiance = Eigen::Map<const BandArray>(
      picture.data(), static_cast<Eigen::Index>(picture.shape(0) * picture.shape(1)), 3);
  return image;
}

std::vector<std::uint8_t> tones(const PictureIn& picture, double exposure_ev) {
  return tone_map(image_from(picture), rgb_bands(), {.exposure_ev = exposure_ev});
}

ArrayOut tone_mapped(const PictureIn& picture, double exposure_ev) {
  return owned(tones(picture, exposure_ev), {picture.shape(0), picture.shape(1), 3});
}

void write_picture(const std::filesystem::path& path, const PictureIn& picture,
                   double exposure_ev) {
  const std::string kind = path.extension().string();
  if (kind == ".exr") {
    write_exr(path, image_from(picture), rgb_bands());
  } else if (kind == ".hdr") {
    write_hdr(path, image_from(picture), rgb_bands());
  } else if (kind == ".png") {
    write_png(path, static_cast<int>(picture.shape(1)), static_cast<int>(picture.shape(0)),
              tones(picture, exposure_ev));
  } else {
    throw InputError("'" + path.string() + "' must end in .exr, .hdr or .png");
  }
}

void export_model(const SharedSolution& solution, const std::filesystem::path& path,
                  double exposure_ev, bool both_sides) {
  run_long(nb::none(), [&](const Progress&) {
    const std::string kind = path.extension().string();
    if (kind != ".glb" && kind != ".ply" && kind != ".obj" && kind != ".html") {
      throw InputError("'" + path.string() + "' must end in .glb, .ply, .obj or .html");
    }
    const SceneData nothing;
    const SceneData& scene = solution->scene ? *solution->scene : nothing;
    const Sides sides = kind == ".html" ? Sides::lit : both_sides ? Sides::both : Sides::front;
    const BakedModel model =
        bake_model(solution->solved, scene.clean, exposure_ev, scene.clean_up.names.get(), sides);
    if (kind == ".glb") write_gltf(path, model);
    if (kind == ".ply") write_ply(path, model);
    if (kind == ".obj") write_obj(path, model);
    if (kind == ".html") write_walkthrough(path, model);
  });
}

}  // namespace

void add_pictures(nb::module_& module) {
  nb::class_<PictureSettings>(module, "RenderOptions")
      .def(nb::init<>())
      .def_rw("pass_", &PictureSettings::pass)
      .def_rw("quality", &PictureSettings::quality)
      .def_rw("shadow_rays", &PictureSettings::shadow_rays)
      .def_rw("photons", &PictureSettings::photons)
      .def_rw("gather_samples", &PictureSettings::gather_samples)
      .def_rw("virtual_lights", &PictureSettings::virtual_lights)
      .def_rw("depth", &PictureSettings::depth)
      .def_rw("samples", &PictureSettings::samples)
      .def_rw("width", &PictureSettings::width)
      .def_rw("height", &PictureSettings::height)
      .def_prop_rw(
          "noise", [](const PictureSettings& s) { return s.noise; },
          [](PictureSettings& s, const std::string& text) { s.noise = share("noise", text); });
  module.def("camera_named", camera_named, nb::arg("solution"), nb::arg("name"));
  module.def("render", render_camera, nb::arg("solution"), nb::arg("camera"), nb::arg("options"),
             nb::arg("progress").none());
  module.def("tone_map", tone_mapped, nb::arg("picture"), nb::arg("exposure_ev"));
  module.def("write_picture", write_picture, nb::arg("path"), nb::arg("picture"),
             nb::arg("exposure_ev"));
  module.def("export_model", export_model, nb::arg("solution"), nb::arg("path"),
             nb::arg("exposure_ev"), nb::arg("both_sides"));
}

}  // namespace lightwell::python
