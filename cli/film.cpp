#include "cli/film.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "cli/arguments.h"
#include "cli/lux_range.h"
#include "cli/white_balance.h"
#include "scene/errors.h"
#include "scene/io/nearest_name.h"
#include "scene/io/radiance/radiance_view.h"
#include "scene/io/text_file.h"
#ifdef LIGHTWELL_VIEWER
#include "viewer/window/legend.h"
#endif

namespace lightwell {
namespace fs = std::filesystem;
namespace {

constexpr std::array<std::pair<const char*, ToneCurve>, 5> tone_curves = {
    {{"auto", ToneCurve::shoulder},
     {"linear", ToneCurve::linear},
     {"reinhard", ToneCurve::reinhard},
     {"filmic", ToneCurve::filmic},
     {"aces", ToneCurve::aces}}};
constexpr std::array<std::pair<const char*, ExrCompression>, 5> compressions = {
    {{"none", ExrCompression::none},
     {"rle", ExrCompression::rle},
     {"zips", ExrCompression::zips},
     {"zip", ExrCompression::zip},
     {"piz", ExrCompression::piz}}};

template <class Table>
std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  for (const auto& [name, value] : table) names.emplace_back(name);
  return names;
}

bool is_photometric(Layer layer) {
  return layer == Layer::luminance || layer == Layer::illuminance;
}

bool holds(const std::vector<Layer>& layers, Layer layer) {
  return std::find(layers.begin(), layers.end(), layer) != layers.end();
}

// Adds the layers named by `words` ("albedo,normal") to `film`.
void add_layers(const std::string& words, FilmArguments& film) {
  std::vector<std::string> known = {"all"};
  for (const NamedLayer& layer : named_layers) known.emplace_back(layer.name);
  for (std::size_t begin = 0; begin <= words.size();) {
    const std::size_t end = std::min(words.find(',', begin), words.size());
    const std::string word = words.substr(begin, end - begin);
    begin = end + 1;
    const auto layer = layer_named(word);
    if (layer) {
      film.layers.push_back(*layer);
    } else if (word == "all") {
      film.all_layers = true;
    } else {
      throw CLI::ValidationError("--layers",
                                 fmt::format("there is no layer '{}'; there are: {}.{}", word,
                                             fmt::join(known, ", "), did_you_mean(word, known)));
    }
  }
}

ImageMetadata metadata(const Picture& picture, const FilmArguments& film, bool is_png) {
  const RadiositySolution& solution = picture.solution;
  const Camera& camera = picture.camera;
  const Provenance& made = solution.provenance;
  const ToneMapping tones = film.tones(picture);
  const double scale = exposure_scale(picture.image, solution.bands, tones);
  ImageMetadata all = {
      {"software", fmt::format("lightwell {}", LIGHTWELL_VERSION)},
      {"scene", made.scene_file},
      {"sceneHash", fmt::format("{:016x}", made.scene_hash)},
      {"camera", camera.name},
      {"cameraPosition", Eigen::Vector3d(camera.position / solution.metres_per_unit)},
      {"cameraDirection", camera.direction},
      {"cameraUp", camera.up},
      {"cameraProjection", std::string(named(camera.projection).name)},
      {"lengthUnit", solution.unit_name},
      {"renderOptions", picture.render_options},
      {"solveOptions", made.options},
      {"unit", solution.relative_units ? "relative radiance per band" : "W/(m^2 sr) per band"},
      {"toneMap", film.tones_text(picture.exposure_ev)},
      {"exposureScale", scale}};
  if (camera.projection == Projection::orthographic) {
    all.emplace_back("cameraViewWidth", camera.view_width / solution.metres_per_unit);
  } else {
    all.emplace_back("cameraFov", camera.fov_degrees);
  }
  if (const auto view = radiance_view_options(camera, solution.metres_per_unit); !view.empty()) {
    all.emplace_back("VIEW", view);
  }
  if (!solution.relative_units) {
    // Luminance of the pixel value 1, in a PNG white, cd/m^2.
    const double white = solution.bands.lumens_per_watt;
    all.emplace_back("whiteLuminance", is_png ? white / scale : white);
    all.emplace_back("ev100", ev100_of_scale(scale, solution.bands));
  }
  if (!picture.image.layers.is_empty() && !is_png) {
    std::vector<std::string> units;
    for (const NamedLayer& layer : named_layers) {
      const auto& names = picture.image.layers.names;
      if (std::find(names.begin(), names.end(), channel_names(layer.layer).front()) ==
          names.end()) {
        continue;
      }
      const bool is_light = layer.unit.starts_with("W/");
      units.push_back(
          fmt::format("{}: {}", layer.name,
                      is_light && solution.relative_units ? "relative radiance" : layer.unit));
    }
    all.emplace_back("layerUnits", fmt::format("{}", fmt::join(units, "; ")));
  }
  return all;
}

// Lines of the header of a RADIANCE picture.
std::vector<std::string> radiance_header(const Picture& picture) {
  const RadiositySolution& solution = picture.solution;
  std::vector<std::string> lines = {fmt::format("SOFTWARE= lightwell {}", LIGHTWELL_VERSION)};
  const std::string view = radiance_view_options(picture.camera, solution.metres_per_unit);
  if (!view.empty()) lines.push_back("VIEW= " + view);
  return lines;
}

#ifdef LIGHTWELL_VIEWER
void write_false_colour(const fs::path& file, const Picture& picture, const FilmArguments& film) {
  const Layer layer = *film.false_colour;
  const LayerColumns& columns = picture.image.layers;
  const auto found =
      std::find(columns.names.begin(), columns.names.end(), channel_names(layer).front());
  const Eigen::ArrayXf values = columns.values.col(found - columns.names.begin());
  const std::vector<float> list(values.begin(), values.end());
  const LuxRange range = film.range ? *film.range : lux_range(list);
  const std::string unit = layer == Layer::illuminance ? "lx" : "cd/m\u00b2";
  const LegendPicture shown =
      with_legend(list, picture.image.width, picture.image.height, range, unit);
  ImageMetadata facts = metadata(picture, film, true);
  std::erase_if(facts, [](const auto& fact) {
    return fact.first == "toneMap" || fact.first == "exposureScale" || fact.first == "ev100" ||
           fact.first == "whiteLuminance";
  });
  facts.emplace_back("falseColour", fmt::format("{} in {}, {:g} to {:g}", named(layer).name,
                                                named(layer).unit, range.low, range.high));
  write_png(file, shown.width, shown.height, shown.rgb, facts);
}
#else
void write_false_colour(const fs::path& file, const Picture&, const FilmArguments&) {
  throw std::logic_error(file.string() + ": refused by FilmArguments::check");
}
#endif

}  // namespace

void FilmArguments::add_to(CLI::App& command, const std::string& group, HelpOn help_on) {
  const std::string more = help_on == HelpOn::shown ? group : std::string();  // CLI11: hidden
  command
      .add_option_function<std::vector<std::string>>(
          "--layers",
          [this](const std::vector<std::string>& given) {
            for (const std::string& words : given) add_layers(words, *this);
          },
          "more layers of the .exr, with commas: albedo, normal, depth, direct, indirect, "
          "specular, emission, luminance, illuminance, patch; or all")
      ->type_name("NAMES")
      ->type_size(1)
      ->allow_extra_args(false)
      ->group(more);
  command.add_flag("--half", exr.half, "16-bit floats in the .exr")->group(more);
  command
      .add_option_function<std::string>(
          "--compression",
          [this](const std::string& name) {
            for (const auto& [known, compression] : compressions) {
              if (name == known) exr.compression = compression;
            }
          },
          "compression of the .exr: none, rle, zips, zip (default), piz")
      ->type_name("KIND")
      ->check(one_of("compression", names_of(compressions)))
      ->group(more);
  command
      .add_option("--tone-map", tone_map,
                  "tone curve of the .png: auto (default), linear, reinhard, filmic, aces")
      ->type_name("CURVE")
      ->check(one_of("tone mapping", names_of(tone_curves)))
      ->group(more);
  command
      .add_option_function<double>(
          "--ev100",
          [this](const double& ev) {
            constexpr double least = -20.0, most = 40.0;
            if (!(ev >= least && ev <= most)) {
              throw CLI::ValidationError(
                  "--ev100", fmt::format("an exposure value from {} to {} is needed, not {}", least,
                                         most, ev));
            }
            ev100 = ev;
          },
          "exposure value at ISO 100 of the .png: white is 1.2 * 2^EV cd/m^2 (default: by the "
          "picture)")
      ->type_name("EV")
      ->group(more);
  add_white_balance(command, white,
                    "light that shows white in the .png: as-lit (default), auto, or a temperature "
                    "such as 2700K")
      ->group(more);
}

void FilmArguments::add_false_colour_to(CLI::App& command, const std::string& group) {
  auto* const shown = command
                          .add_option_function<std::string>(
                              "--false-colour,--false-color",
                              [this](const std::string& name) { false_colour = layer_named(name); },
                              "quantity that the .png shows in false colours: luminance (cd/m^2) "
                              "or illuminance (lx)")
                          ->type_name("WHAT")
                          ->check(one_of("quantity", {"luminance", "illuminance"}))
                          ->group(group);
  add_lux_range(command, range)->needs(shown)->group(group);
}

void FilmArguments::check(const Scene& scene, const std::vector<fs::path>& files) const {
  const auto has = [&files](const char* extension) {
    return std::any_of(files.begin(), files.end(), [extension](const fs::path& file) {
      return lower_extension(file) == extension;
    });
  };
  if (false_colour && !has(".png")) {
    throw InputError("false colours go into a .png, and none is to be written; add '-o FILE.png'");
  }
  if (!has(".exr") && (all_layers || !layers.empty())) {
    throw InputError("layers go into an .exr, and none is to be written; add '-o FILE.exr'");
  }
  if (!scene.relative_units) {
#ifndef LIGHTWELL_VIEWER
    if (false_colour) {
      throw InputError(
          "this lightwell was built without its viewer, which draws the scale of false colours; "
          "build it with -DLIGHTWELL_VIEWER=ON, or write the layer with '--layers'");
    }
#endif
    return;
  }
  const std::string why = "names no unit of light";
  if (ev100) {
    throw InputError(
        fmt::format("{}: {}, so no luminance is known to expose for ('--ev100'); use "
                    "'--exposure' instead",
                    scene.file.string(), why));
  }
  for (const Layer layer : layers) {
    if (!is_photometric(layer)) continue;
    throw InputError(fmt::format("{}: {}, so there is no layer of {} in {}", scene.file.string(),
                                 why, named(layer).name, named(layer).unit));
  }
  if (false_colour) {
    throw InputError(fmt::format("{}: {}, so there is no {} in {} to show", scene.file.string(),
                                 why, named(*false_colour).name, named(*false_colour).unit));
  }
}

std::vector<Layer> FilmArguments::rendered_layers(const Scene& scene) const {
  std::vector<Layer> rendered = layers;
  for (const NamedLayer& known : named_layers) {
    const bool is_known = !scene.relative_units || !is_photometric(known.layer);
    if (all_layers && is_known && !holds(rendered, known.layer)) rendered.push_back(known.layer);
  }
  if (false_colour && !holds(rendered, *false_colour)) rendered.push_back(*false_colour);
  return rendered;
}

ToneMapping FilmArguments::tones(const Picture& picture) const {
  ToneMapping tones{.exposure_ev = picture.exposure_ev,
                    .ev100 = ev100,
                    .balance = white_balance(white, picture.incident)};
  if (picture.incident) tones.metered_scale = picture.incident->exposure;
  for (const auto& [name, curve] : tone_curves) {
    if (tone_map == name) tones.curve = curve;
  }
  return tones;
}

std::string FilmArguments::tones_text(double exposure_ev) const {
  return fmt::format("--tone-map {} --exposure {:g}{}", tone_map, exposure_ev,
                     ev100 ? fmt::format(" --ev100 {:g}", *ev100) : "") +
         white_balance_text(white);
}

void write_picture(const fs::path& file, const Picture& picture, const FilmArguments& film) {
  const Image& image = picture.image;
  const Bands& bands = picture.solution.bands;
  const std::string kind = lower_extension(file);
  if (kind == ".hdr") {
    write_hdr(file, image, bands, radiance_header(picture));
  } else if (kind != ".png") {
    write_exr(file, image, bands, metadata(picture, film, false), film.exr);
  } else if (film.false_colour) {
    write_false_colour(file, picture, film);
  } else {
    write_png(file, image.width, image.height, tone_map(image, bands, film.tones(picture)),
              metadata(picture, film, true));
  }
}

}  // namespace lightwell
