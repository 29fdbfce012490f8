#include "scene/io/toml/toml_lamps.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>

#include "scene/degree.h"
#include "scene/errors.h"
#include "scene/io/luminaires/luminaire_file.h"
#include "scene/limits.h"
#include "scene/projected_picture.h"

namespace lightwell {
namespace {

Eigen::Vector3d read_direction(const TomlValue& value) {
  const Eigen::Vector3d direction = value.vector();
  if (!(direction.stableNorm() > 0.0)) value.fail("has no length; give a direction");
  return direction.stableNormalized();
}

// Axes that turn the top of a picture upwards, by the key 'up'.
Eigen::Matrix3d picture_axes(const TomlTable& table, const Eigen::Vector3d& aim) {
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  if (const auto given = table.find("up")) {
    up = read_direction(*given);
    if (!(up.cross(aim).norm() > parallel_sine)) {
      given->fail("is parallel to the direction the lamp is aimed in; it must point across it");
    }
  } else if (!(up.cross(aim).norm() > parallel_sine)) {
    up = Eigen::Vector3d::UnitY();
  }
  return lamp_axes(aim, aim.cross(up));
}

// Lamp axes from the keys 'aim' or 'look_at', and 'c0' or 'up'.
Eigen::Matrix3d read_axes(const TomlTable& table, const Eigen::Vector3d& position,
                          bool has_direction) {
  const auto given = table.present({"aim", "look_at"});
  if (!has_direction) {
    for (const auto& key : table.present({"aim", "look_at", "c0"})) {
      table.require(key).fail(
          "turns a lamp that shines alike to all sides; give a 'file', a 'cone' or a 'picture', or "
          "remove it");
    }
    return Eigen::Matrix3d::Identity();
  }
  if (given.size() != 1) {
    table.fail(
        "needs exactly one of 'aim' and 'look_at': where gamma = 0 points, for most luminaires "
        "down");
  }
  const TomlValue value = table.require(given[0]);
  Eigen::Vector3d aim = value.vector();
  if (given[0] == "look_at") aim -= position;
  if (!(aim.stableNorm() > 0.0)) {
    value.fail(given[0] == "look_at" ? "is the lamp's own position; look at another point"
                                     : "has no length; give a direction");
  }
  aim.stableNormalize();
  if (table.has("picture")) return picture_axes(table, aim);
  const auto c0 = table.find("c0");
  if (!c0) return lamp_axes(aim);
  const Eigen::Vector3d direction = read_direction(*c0);
  if (!(direction.cross(aim).norm() > parallel_sine)) {
    c0->fail("is parallel to the direction the lamp is aimed in; C0 must point across it");
  }
  return lamp_axes(aim, direction);
}

SpotCone read_toml_cone(const TomlValue& value) {
  const auto angles = value.elements("angle");
  if (angles.size() != 2) {
    value.fail("must be two angles [inner, outer] in degrees from the axis");
  }
  constexpr double widest = 180.0;
  const double inner = angles[0].number_within(0.0, widest);
  const double outer = angles[1].number_within(0.0, widest);
  if (!(inner <= outer && outer > 0.0)) {
    value.fail(fmt::format(
        "is [{:g}, {:g}]; the outer angle must be above 0, and the inner no wider", inner, outer));
  }
  return {.inner = inner * degree, .outer = outer * degree};
}

void read_opening(const TomlTable& table, double metres_per_unit, Lamp& lamp) {
  if (const auto opening = table.find("opening")) {
    const auto sizes = opening->elements("size");
    if (sizes.size() != 2) opening->fail("must be two sizes [along C0, along C90]");
    lamp.opening = {.along_c0 = metres_per_unit * sizes[0].number_at_least(0.0),
                    .along_c90 = metres_per_unit * sizes[1].number_at_least(0.0)};
  }
  if (const auto round = table.find("round")) {
    if (!table.has("opening")) round->fail("is the shape of an 'opening'; give that, or remove it");
    lamp.opening.is_round = round->boolean();
  }
}

void read_body(const TomlTable& table, double metres_per_unit, Lamp& lamp) {
  const auto body = table.find("body");
  if (!body) return;
  const auto sizes = body->elements("size");
  if (sizes.size() != 3) body->fail("must be three sizes [along C0, along C90, height]");
  lamp.body = {.along_c0 = metres_per_unit * sizes[0].positive(),
               .along_c90 = metres_per_unit * sizes[1].positive(),
               .height = metres_per_unit * sizes[2].positive(),
               .is_round = lamp.opening.is_round};
}

// The flux of a lamp of intensity 1, sr; of one with a picture, without it.
double open_flux(const Lamp& lamp) {
  const auto* picture = std::get_if<SharedPicture>(&lamp.shape);
  return picture ? (*picture)->open_flux() : relative_flux(lamp);
}

// Sets intensity, W/sr per unit of the shape, from exactly one of the four keys.
void read_strength(const TomlTable& table, const TomlBands& bands, Lamp& lamp) {
  const auto given = table.present({"intensity", "candela", "power", "lumens"});
  if (given.size() != 1) {
    table.fail(
        "needs exactly one of 'intensity' (W/sr), 'candela', 'power' (W) and 'lumens', or a "
        "'file'");
  }
  const TomlValue value = table.require(given[0]);
  const bool is_radiometric = given[0] == "intensity" || given[0] == "power";
  const bool is_flux = given[0] == "power" || given[0] == "lumens";
  if (is_radiometric) {
    if (const auto colour = table.find("colour")) {
      colour->fail(fmt::format("goes with 'candela' or 'lumens'; '{}' has a number for each band",
                               given[0]));
    }
    lamp.intensity = read_toml_emission(value, bands);
  } else {
    const Spectrum colour = read_toml_colour(table, bands);
    lamp.intensity =
        colour * static_cast<float>(value.number_at_least(0.0) / luminous(bands.bands, colour));
  }
  if (is_flux) lamp.intensity /= static_cast<float>(open_flux(lamp));
  if (!lamp.intensity.isFinite().all()) value.fail("is too large a number");
}

// Sets distribution and intensity of a lamp without a photometric file.
void read_shape(const TomlTable& table, const TomlBands& bands, double metres_per_unit,
                TomlProjectors& projectors, Lamp& lamp) {
  if (!table.has("picture")) {
    for (const auto& key : table.present({"beam", "focus", "lens", "shutters", "up"})) {
      table.require(key).fail("belongs to a 'picture'; give one, or remove it");
    }
    if (const auto cone = table.find("cone")) lamp.shape = read_toml_cone(*cone);
    read_strength(table, bands, lamp);
    return;
  }
  const TomlProjector projector = projectors.read(table, metres_per_unit);
  lamp.shape = projector.picture;
  read_strength(table, bands, lamp);
  lamp.intensity *= projector.brightest;
}

// Hue of a measured lamp: its key `colour`, or else the spectra of its file.
Spectrum colour_of(const TomlTable& table, const LuminaireFile& luminaire, const TomlBands& bands,
                   std::vector<std::string>& notes) {
  if (table.has("colour") || luminaire.spectra.empty()) return read_toml_colour(table, bands);
  if (bands.bands.wavelengths_nm.empty()) {
    notes.push_back(
        fmt::format("{}: Its spectra are for scenes of wavelengths; in RGB it is white without a "
                    "'colour'.",
                    luminaire.file.filename().string()));
    return read_toml_colour(table, bands);
  }
  return toml_colour_of_spectra(table.require("file"), luminaire.spectra, bands);
}

// Sets a lamp's distribution and intensity from a photometric file.
void read_measured(const TomlTable& table, const TomlBands& bands, Scene& scene, Lamp& lamp) {
  for (const auto& key : table.present({"intensity", "candela", "power", "cone"})) {
    table.require(key).fail("is given by the 'file' as well; keep one of them");
  }
  const TomlValue file = table.require("file");
  const auto path = (file.file().parent_path() / file.name()).lexically_normal();
  int lamp_set = 1;
  if (const auto set = table.find("lamp_set"))
    lamp_set = static_cast<int>(set->integer_within(1, 20));
  const auto of_file = [&file](auto&& use) {
    try {
      return use();
    } catch (const InputError& error) {
      file.fail(fmt::format("cannot be used: {}", error.what()));
    }
  };
  const LuminaireFile luminaire = of_file([&] { return read_luminaire(path, lamp_set); });
  std::vector<std::string> notes;
  const Spectrum colour = colour_of(table, luminaire, bands, notes);
  of_file([&] { place_luminaire(luminaire, bands.bands, colour, lamp); });
  if (luminaire.is_radiometric) scene.relative_units = true;
  if (const auto lumens = table.find("lumens")) {
    if (luminaire.is_radiometric) lumens->fail("is asked of a file that is not in candela");
    lamp.intensity *= static_cast<float>(lumens->number_at_least(0.0) / luminaire.flux());
  }
  std::ranges::copy(luminaire_notes(luminaire), std::back_inserter(notes));
  for (const std::string& note : notes) {
    if (std::ranges::find(scene.notes, note) == scene.notes.end()) scene.notes.push_back(note);
  }
}

}  // namespace

void read_toml_lamp(const TomlValue& value, std::size_t number, const TomlBands& bands,
                    TomlProjectors& projectors, Scene& scene) {
  const auto given = value.member("name");
  Lamp lamp{.name = given ? given->name() : fmt::format("lamp{}", number)};
  const TomlTable table =
      value.renamed(fmt::format("lamp '{}'", lamp.name))
          .table({"name",    "position",  "aim",      "look_at", "c0",      "file",    "lamp_set",
                  "cone",    "intensity", "candela",  "power",   "lumens",  "colour",  "factor",
                  "opening", "round",     "body",     "watts",   "visible", "picture", "beam",
                  "focus",   "lens",      "shutters", "up"});
  const Eigen::Vector3d position = table.require("position").vector();
  lamp.position = scene.metres_per_unit * position;
  const bool is_measured = table.has("file") && !table.has("picture");
  if (const auto set = table.find("lamp_set"); set && !table.has("file")) {
    set->fail("belongs to a 'file'; give one, or remove it");
  }
  if (is_measured) {
    read_measured(table, bands, scene, lamp);
  } else {
    read_shape(table, bands, scene.metres_per_unit, projectors, lamp);
  }
  lamp.axes = read_axes(table, position, is_measured || table.has("cone") || table.has("picture"));
  read_opening(table, scene.metres_per_unit, lamp);
  read_body(table, scene.metres_per_unit, lamp);
  if (const auto factor = table.find("factor")) {
    lamp.intensity *= static_cast<float>(factor->number_at_least(0.0));
  }
  if (const auto watts = table.find("watts")) watts->positive();  // for read_lighting_design
  if (const auto visible = table.find("visible")) lamp.visible = visible->boolean();
  scene.lamps.push_back(std::move(lamp));
}

}  // namespace lightwell
