#include "scene/io/toml/toml_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>

#include "scene/coat.h"
#include "scene/errors.h"
#include "scene/io/glossy.h"
#include "scene/io/toml/toml_pictures.h"
#include "scene/picture_cells.h"
#include "scene/specular.h"
#include "scene/stated_power.h"

namespace lightwell {
namespace {

float read_roughness(const TomlTable& table) {
  const auto value = table.find("roughness");
  return value ? static_cast<float>(value->number_within(0.0, 1.0)) : 0.0f;
}

void read_glass(const TomlTable& table, const TomlBands& bands, Material& material) {
  const auto glass = table.find("glass");
  if (!glass) return;
  const TomlTable t =
      glass->table({"ior", "tint", "roughness", "absorption", "thin", "transmissivity"});
  const TomlValue ior = t.require("ior");
  const auto index = static_cast<float>(ior.positive());
  if (!(index >= lowest_index && index <= highest_index)) {
    ior.fail(
        fmt::format("is {:g}, but the index behind a surface over that before it must lie "
                    "between {} and {} (glass: 1.5)",
                    ior.number(), lowest_index, highest_index));
  }
  Dielectric dielectric{.index_of_refraction = index,
                        .tint = read_toml_share_or(t, "tint", bands, 1.0f)};
  dielectric.roughness = read_roughness(t);
  if (const auto thin = t.find("thin")) dielectric.thin = thin->boolean();
  if (const auto absorption = t.find("absorption")) {
    dielectric.absorption = read_toml_emission(*absorption, bands);
    if (!(dielectric.absorption <= highest_absorption).all()) {
      absorption->fail(
          fmt::format("is above {:g} per metre, which nothing passes", highest_absorption));
    }
    if (dielectric.thin) {
      absorption->fail(
          "does not go with thin = true: light goes no distance in a thin pane; give it a "
          "'transmissivity' or a 'tint'");
    }
  }
  if (const auto transmissivity = t.find("transmissivity")) {
    if (!dielectric.thin) {
      transmissivity->fail(
          "goes with thin = true alone: it is the share of light that crosses a pane's body; "
          "without thin give an 'absorption'");
    }
    dielectric.transmissivity = read_toml_share(*transmissivity, bands);
  }
  material.dielectric = dielectric;
  for (const char* other :
       {"reflectance", "specular", "roughness", "radiance", "exitance", "power", "luminance",
        "luminous_exitance", "lumens", "translucent", "transparent"}) {
    if (const auto value = table.find(other)) {
      value->fail(
          "contradicts 'glass': a clear surface reflects by Fresnel's law alone and emits "
          "nothing (and its roughness is a key of 'glass'); remove one of the two keys");
    }
  }
}

// A metal mirrors by Fresnel's equations alone; `specular` is a factor.
void read_metal(const TomlTable& table, const TomlBands& bands, Material& material) {
  const auto metal = table.find("metal");
  if (!metal) return;
  for (const char* other :
       {"reflectance", "texture", "glass", "coat", "translucent", "transparent"}) {
    if (const auto value = table.find(other)) {
      value->fail("contradicts 'metal', which mirrors alone; remove one of the two keys");
    }
  }
  const TomlTable t = metal->table({"eta", "k"});
  const auto part = [&](const char* key) {
    const TomlValue value = t.require(key);
    const Spectrum result = read_toml_emission(value, bands);
    if (!(result <= highest_metal_index).all()) {
      value.fail(fmt::format("is above {}, which no metal has", highest_metal_index));
    }
    return result;
  };
  material.metal = Conductor{.eta = part("eta"), .k = part("k")};
  if (!table.has("specular")) material.specular.setOnes();
}

// A coat: its index of refraction alone, or { ior = ..., roughness = ..., share = ..., base = ...
// }.
struct GivenCoat {
  double index = 1.5;
  Spectrum share{};
  float roughness = 0.0f;
  bool has_base = false;  // Material::reflectance and texture are those of the base so far
};

std::optional<GivenCoat> read_coat(const TomlTable& table, const TomlBands& bands,
                                   Material& material) {
  const auto coat = table.find("coat");
  if (!coat) return std::nullopt;
  for (const char* other : {"specular", "roughness", "glass"}) {
    if (const auto value = table.find(other)) {
      value->fail(
          "contradicts 'coat', which mirrors by Fresnel's law alone and has a roughness of its "
          "own; "
          "remove one of the two keys");
    }
  }
  std::optional<TomlTable> t;
  if (coat->is_table()) t = coat->table({"ior", "roughness", "share", "base"});
  const TomlValue ior = t ? t->require("ior") : *coat;
  GivenCoat given{.index = ior.positive(), .share = constant_spectrum(bands.bands, 1.0f)};
  if (!(given.index >= double{lowest_coat_index} && given.index <= double{highest_index})) {
    ior.fail(
        fmt::format("is {:g}, but the index of refraction of a coat must lie between {} and {} "
                    "(lacquer: 1.5)",
                    given.index, lowest_coat_index, highest_index));
  }
  if (!t) return given;
  given.share = read_toml_share_or(*t, "share", bands, 1.0f);
  given.roughness = read_roughness(*t);
  if (const auto base = t->find("base")) {
    if (table.has("reflectance")) {
      base->fail(
          "is a second statement of the diffuse reflectance, after 'reflectance', which is that of "
          "base and coat together; keep one");
    }
    material.reflectance = read_toml_share(*base, bands);
    given.has_base = true;
  }
  return given;
}

// Lays the coat over the material, whose pictures have been read.
void lay_given_coat(const TomlTable& table, const GivenCoat& given, Material& material) {
  if (given.has_base) return lay_coat(material, given.index, given.roughness, given.share);
  set_coat(material, given.index, given.roughness, given.share);
  const Spectrum mirrored = mean_mirrored(material);
  if (!table.has("reflectance") && material.texture) {
    material.texture->factor -= mirrored;
    material.reflectance *= 1.0f - mirrored;
  }
  constexpr float rounding = 1e-5f;
  if (((material.reflectance + mirrored) > 1.0f + rounding).any()) {
    table.require("coat").fail(fmt::format(
        "mirrors {:.4f} of even light, and the reflectance {:.4f} besides makes more than 1; "
        "under this coat the reflectance is at most {:.4f}",
        mirrored.maxCoeff(), material.reflectance.maxCoeff(), 1.0f - mirrored.maxCoeff()));
  }
}

// A texture without a factor of its own reflects what the other shares leave.
void make_room(const Spectrum& share, Material& material) {
  if (!material.texture) return;
  Spectrum& factor = material.texture->factor;
  const Spectrum left = (factor - share).max(0.0f);
  material.reflectance *= (factor > 0.0f).select(left / factor, 0.0f);
  factor = left;
}

// Reads the light that passes a thin sheet, diffusely or straight on.
void read_sheet(const TomlTable& table, const TomlBands& bands, bool has_reflectance,
                Material& material) {
  const auto read = [&](const char* key, Spectrum& share) {
    const auto value = table.find(key);
    if (!value) return;
    if (material.one_sided) {
      value->fail(
          "needs both sides of the surface, but sides is 'one'; remove one of the two keys");
    }
    share = read_toml_share(*value, bands);
    if (!has_reflectance) make_room(share, material);
    const Spectrum all = mean_sent_on(material);
    constexpr float rounding = 1e-5f;
    if ((all > 1.0f + rounding).any()) {
      value->fail(
          fmt::format("({:.4g}) and what the material reflects and passes besides add up to "
                      "{:.4g}; more light would "
                      "leave than arrives, lower one so that they add up to at most 1",
                      share.maxCoeff(), all.maxCoeff()));
    }
  };
  read("translucent", material.transmittance);
  read("transparent", material.regular_transmittance);
}

bool is_photometric(std::string_view key) {
  return key == "luminance" || key == "luminous_exitance" || key == "lumens";
}

// The number of an emission's key: W of every band, or lumens in the hue of `colour`.
Spectrum read_emitted(const TomlTable& table, const std::string& key, const TomlBands& bands) {
  const TomlValue value = table.require(key);
  const auto colour = table.find("colour");
  if (!is_photometric(key)) {
    if (colour) {
      colour->fail(
          fmt::format("goes with 'luminance', 'luminous_exitance' or 'lumens'; '{}' has a "
                      "number for each band",
                      key));
    }
    return read_toml_emission(value, bands);
  }
  if (!value.is_number()) {
    value.fail(
        "must be one number, as people see the light; give its hue by 'colour', or watts of each "
        "band by 'radiance', 'exitance' or 'power'");
  }
  const Spectrum hue = read_toml_colour(table, bands);
  return hue * static_cast<float>(value.number_at_least(0.0) / luminous(bands.bands, hue));
}

void read_emission(const TomlTable& table, const TomlBands& bands, TomlMaterial& result) {
  if (const auto watts = table.find("watts")) {
    watts->fail(
        "is the electric power of a lamp; for a surface that shines give 'lumens', or 'power', the "
        "watts of light in each band");
  }
  const auto given =
      table.present({"radiance", "exitance", "power", "luminance", "luminous_exitance", "lumens"});
  if (given.size() > 1) {
    table.require(given[1]).fail(
        fmt::format("is a second statement of the emission, after '{}'; keep one", given[0]));
  }
  Material& material = result.material;
  material.emission = constant_spectrum(bands.bands, 0.0f);
  if (!given.empty()) {
    const std::string& key = given[0];
    const Spectrum x = read_emitted(table, key, bands);
    const bool is_per_angle = key == "radiance" || key == "luminance";
    if (is_per_angle) material.emission = static_cast<float>(std::numbers::pi) * x;
    if (key == "exitance" || key == "luminous_exitance") material.emission = x;
    if (key == "power" || key == "lumens") result.power = x;
    if (key == "power") material.stated_power = StatedPower::watts;
    if (key == "lumens") material.stated_power = StatedPower::lumens;
    if (!material.emission.isFinite().all() || !x.isFinite().all()) {
      table.require(key).fail("is too large a number");
    }
    if (result.power && table.has("emission_texture")) material.emission = x;
  } else if (const auto texture = table.find("emission_texture")) {
    texture->fail(
        "multiplies an emission; give that too, such as 'luminance' or 'exitance', or remove it");
  } else if (const auto colour = table.find("colour")) {
    colour->fail(
        "is the hue of light; with it give 'luminance', 'luminous_exitance' or 'lumens', or, for "
        "the hue of the surface, 'reflectance' alone");
  }
  if (const auto emits = table.find("emits")) {
    material.emits_both_sides = emits->one_of({"front", "both"}) == "both";
    if (given.empty()) {
      emits->fail("needs an emission, such as 'lumens' or 'exitance'; give one, or remove it");
    }
    if (material.emits_both_sides && material.one_sided) {
      emits->fail("is 'both', but sides is 'one': the back cannot shine and be black");
    }
  }
}

}  // namespace

TomlMaterial read_toml_material(const TomlValue& value, const std::string& name,
                                const TomlBands& bands, PictureFiles& pictures) {
  const TomlTable table = value.table({"reflectance",
                                       "specular",
                                       "roughness",
                                       "glass",
                                       "sides",
                                       "radiance",
                                       "exitance",
                                       "power",
                                       "luminance",
                                       "luminous_exitance",
                                       "lumens",
                                       "colour",
                                       "watts",
                                       "emits",
                                       "texture",
                                       "mask",
                                       "relief",
                                       "metal",
                                       "coat",
                                       "translucent",
                                       "transparent",
                                       "emission_texture",
                                       "roughness_texture",
                                       "metal_texture",
                                       "coat_texture",
                                       "opacity_texture",
                                       "translucent_texture"});
  TomlMaterial result{.material = {.name = name}};
  Material& material = result.material;
  material.reflectance = read_toml_share_or(table, "reflectance", bands, 0.0f);
  material.specular = read_toml_share_or(table, "specular", bands, 0.0f);
  for (int k = 0; k < bands.bands.count(); ++k) {
    constexpr float rounding = 1e-5f;  // tolerance for decimals that should add up to 1
    if (material.reflectance[k] + material.specular[k] > 1.0f + rounding) {
      table.require("specular")
          .fail(fmt::format(
              "({}) and reflectance ({}) exceed 1 in band {}; more light would leave than arrives",
              material.specular[k], material.reflectance[k],
              bands.bands.names[static_cast<std::size_t>(k)]));
    }
  }
  if (table.has("roughness") && !table.has("specular") && !table.has("glass") &&
      !table.has("metal") && !table.has("metal_texture")) {
    table.require("roughness").fail("spreads what 'specular' mirrors; give that too, or remove it");
  }
  material.specular_roughness = read_roughness(table);
  if (const auto sides = table.find("sides")) {
    material.one_sided = sides->one_of({"one", "two"}) == "one";
  }
  read_metal(table, bands, material);
  const std::optional<GivenCoat> coat = read_coat(table, bands, material);
  read_glass(table, bands, material);
  const bool has_reflectance = table.has("reflectance") || (coat && coat->has_base);
  read_toml_pictures(table, bands, pictures, has_reflectance, material);
  if (coat) lay_given_coat(table, *coat, material);
  read_sheet(table, bands, has_reflectance, material);
  read_toml_pattern(table, bands, pictures, material);
  read_emission(table, bands, result);
  read_toml_emission_texture(table, bands, pictures, material);
  return result;
}

namespace {

// Power of a surface's front at the material's emission, W.
Eigen::ArrayXd emitted_by_front(const Scene& scene, const Surface& surface) {
  return surface_area(surface) * mean_exitance(scene, surface);
}

// Scales a picture of emission, laid over surfaces that send the power `sent`, W, to the sum of the
// power or the lumens that the file gives. The picture keeps its colours.
void scale_picture(const TomlMaterial& given, const Bands& bands, const Eigen::ArrayXd& sent,
                   Material& material) {
  const Spectrum spectrum = sent.cast<float>();
  const StatedPower unit = material.stated_power;
  const double all = stated_amount(bands, unit, spectrum);
  const double wanted = stated_amount(bands, unit, *given.power);
  scale_emission(material, all > 0.0 ? static_cast<float>(wanted / all) : 0.0f);
}

}  // namespace

void spread_power(const std::vector<TomlMaterial>& materials, std::span<const int> others,
                  Scene& scene) {
  std::vector<double> areas(scene.materials.size(), 0.0);
  std::vector<Eigen::ArrayXd> sent(scene.materials.size());  // W, of pictures at a factor of 1
  std::vector<char> used(scene.materials.size(), 0);
  for (const Surface& surface : scene.surfaces) {
    const auto i = static_cast<std::size_t>(surface.material);
    used[i] = 1;
    areas[i] += surface_area(surface);
    if (i >= materials.size() || !materials[i].power || !scene.materials[i].emission_texture) {
      continue;
    }
    const Eigen::ArrayXd by_front = emitted_by_front(scene, surface);
    sent[i] = sent[i].size() == 0 ? by_front : Eigen::ArrayXd(sent[i] + by_front);
  }
  for (std::size_t i = 0; i < materials.size(); ++i) {
    Material& material = scene.materials[i];
    const bool is_other = std::ranges::find(others, static_cast<int>(i)) != others.end();
    if (!used[i] && !is_other) {
      scene.notes.push_back(fmt::format("No surface uses material '{}'.", material.name));
    }
    if (!used[i] || !materials[i].power) continue;
    const double sides = material.emits_both_sides ? 2.0 : 1.0;
    if (material.emission_texture) {
      scale_picture(materials[i], scene.bands, sides * sent[i], material);
    } else {
      material.emission = *materials[i].power / static_cast<float>(sides * areas[i]);
    }
  }
}

}  // namespace lightwell
