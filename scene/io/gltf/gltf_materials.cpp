#include "scene/io/gltf/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/io/default_material.h"
#include "scene/io/glossy.h"
#include "scene/io/gltf/gltf_values.h"
#include "scene/io/sheets.h"

namespace lightwell {
namespace {

// Transmitted colour after the attenuationDistance of KHR_materials_volume; empty without
// absorption.
std::optional<Spectrum> attenuation(const std::optional<JsonObject>& volume) {
  if (!(number_or(volume, "attenuationDistance", 0.0) > 0.0)) return std::nullopt;
  return gltf_color(volume, "attenuationColor", 3).max(0.0f).min(1.0f);
}

// Absorption coefficient in 1/m: exp(-absorption distance) is the attenuation colour.
Spectrum absorption(const std::optional<JsonObject>& volume) {
  const auto passed = attenuation(volume);
  if (!passed) return {};
  constexpr double shortest = 1e-6;  // m
  const auto distance =
      static_cast<float>(std::max(shortest, number_or(volume, "attenuationDistance", 0.0)));
  constexpr float black = 1e-6f;  // a colour of 0 would mean infinite absorption
  return (-passed->max(black).log() / distance).min(highest_absorption);
}

// Transmittance of a sheet per crossing of its two surfaces, that is of half its thickness at
// normal incidence.
Spectrum passed_by_each_face(const std::optional<JsonObject>& volume, double thickness) {
  const auto passed = attenuation(volume);
  if (!passed) return Spectrum::Ones(3);
  const double distance = number_or(volume, "attenuationDistance", 0.0);
  return passed->pow(static_cast<float>(0.5 * thickness / distance));
}

// Factor of the share of metal. A metal transmits no light: a file with transmission and no factor
// means glass or paper.
double metallic_factor(const JsonObject& from) {
  const auto pbr = from.object("pbrMetallicRoughness");
  const bool transmits = from.extension("KHR_materials_transmission") ||
                         from.extension("KHR_materials_diffuse_transmission");
  const double otherwise = transmits && !(pbr && pbr->has("metallicFactor")) ? 0.0 : 1.0;
  return share_or(pbr, "metallicFactor", otherwise);
}

}  // namespace

int GltfMaterials::of_primitive(const JsonObject& primitive, bool is_closed) {
  const auto index = primitive.index("material");
  const auto [entry, is_new] =
      index_of_.emplace(std::pair(index, is_closed), static_cast<int>(scene_.materials.size()));
  if (!is_new) return entry->second;
  Material material = default_material(scene_.bands);
  if (index) {
    remarks_.attempt("Materials that cannot be read got a diffuse reflectance of 0.5",
                     fmt::format("materials[{}]", *index),
                     [&] { material = read(file_.at("materials", *index, primitive), is_closed); });
  } else {
    remarks_.mention("Surfaces without a material got a diffuse reflectance of 0.5",
                     primitive.place());
  }
  // Closed and open bodies often get the same material, which is then stored once.
  const auto other = index_of_.find({index, !is_closed});
  if (other != index_of_.end()) {
    const Material& known = scene_.materials[static_cast<std::size_t>(other->second)];
    const auto form = [](const Material& m) {
      return std::array{m.dielectric.has_value(), m.emits_both_sides, m.is_translucent(),
                        m.passes_straight()};
    };
    if (!material.dielectric && form(material) == form(known)) {
      return entry->second = other->second;
    }
  }
  scene_.materials.push_back(std::move(material));
  return entry->second;
}

Material GltfMaterials::read(const JsonObject& from, bool is_closed) {
  Material material = default_material(scene_.bands);
  material.name = from.name();
  const bool is_double_sided = from.boolean_or("doubleSided", false);
  material.one_sided = !is_double_sided;
  set_surface(from, is_closed, material);
  set_emission(from, material);
  cut_by_alpha(from, material);
  material.emits_both_sides = material.is_emitter() && is_double_sided && !is_closed;
  if (material.dielectric && material.is_emitter()) {
    remarks_.add("Clear materials that shine were read as black ones that shine", material.name);
    material.dielectric.reset();
  }
  if (close_lamp(material)) {
    remarks_.add("Lamps let no light straight through, so this part was left out", material.name);
  }
  if (material.mask && material.is_emitter()) {
    remarks_.add("Lamps have no holes, so their transparency by alpha was left out", material.name);
    material.mask.reset();
  }
  set_relief(from, material);
  return material;
}

float GltfMaterials::metal_factor_of(const JsonObject& from) {
  return static_cast<float>(metallic_factor(from));
}

Spectrum GltfMaterials::base_color(const JsonObject& from) {
  const BaseColor color_from(from);
  Spectrum result = gltf_color(color_from.owner, color_from.factor, 4);
  if (const auto picture = base_picture(from)) {
    result *= picture->mean_shown(is_cut_by_alpha(from)).cast<float>();
  } else if (color_from.info()) {
    result *= 0.5f;
  }
  if (!((result >= 0.0f).all() && (result <= 1.0f).all())) {
    remarks_.add("Colours outside [0, 1] were cut off there", from.name());
    result = result.max(0.0f).min(1.0f);
  }
  return result;
}

void GltfMaterials::set_surface(const JsonObject& from, bool is_closed, Material& material) {
  const Spectrum base = base_color(from);
  set_shaded(from, base, is_closed, material);
  set_pattern_of(from, base, is_closed, material);
  if (!material.pattern) lay_on_picture(from, base, material);
}

void GltfMaterials::set_shaded(const JsonObject& from, const Spectrum& base, bool is_closed,
                               Material& material) {
  if (from.extension("KHR_materials_pbrSpecularGlossiness") ||
      from.extension("KHR_materials_unlit")) {
    remarks_.add("Unlit and specular-glossy materials were read as diffuse, of their base colour",
                 material.name);
    return set_metallic(material, base, 0.0, 1.0);
  }
  const auto pbr = from.object("pbrMetallicRoughness");
  const auto mean = texture_mean(pbr, "metallicRoughnessTexture", PictureCode::linear, from).color;
  const double roughness = share_or(pbr, "roughnessFactor", 1.0) * mean[1];
  const double metallic = metallic_factor(from) * mean[2];
  const double alpha = roughness * roughness;
  const double clear = clear_share(from);
  const double passed = (1.0 - metallic) * clear;
  const bool is_sheet = !is_closed && !(number_or(from.extension("KHR_materials_volume"),
                                                  "thicknessFactor", 0.0) > 0.0);
  if (passed >= (is_sheet ? nearly_clear : mostly_clear)) {
    if (passed < 1.0) {
      remarks_.add("Materials that are mostly clear were read as wholly clear", material.name);
    }
    return set_clear(from, base, alpha, is_closed, material);
  }
  if (passed > 0.0 && !is_sheet) {
    remarks_.add("Materials less than half clear were read as opaque", material.name);
  }
  if (metallic > 0.0 && alpha > glossy_alpha) {
    remarks_.add("Metals of roughness above 0.7 were read as diffuse", material.name);
  }
  set_metallic(material, base, metallic, alpha);
  const auto dielectric = static_cast<float>(1.0 - metallic);
  if (dielectric > 0.0f) {
    pass_light(from, base, dielectric, is_sheet ? clear : 0.0, alpha, material);
  }
  if (metallic < least_metallic) set_coat(from, alpha, material);
}

// Passes light of the share `dielectric` of a material that scatters back the colour `base`:
// `clear` of the light without being scattered, and a share of the rest diffusely, in a colour of
// its own.
void GltfMaterials::pass_light(const JsonObject& from, const Spectrum& base, float dielectric,
                               double clear, double alpha, Material& material) {
  const auto [scattered, hue] = diffusely_passed(from);
  const float straight = dielectric * static_cast<float>(clear);
  const float behind = dielectric * static_cast<float>(1.0 - clear) * scattered;
  material.reflectance = (material.reflectance - (straight + behind) * base).max(0.0f);
  add_diffuse_transmittance(material, behind * hue);
  if (clear > 0.0 && BaseColor(from).info()) {
    remarks_.add("What passes sheets with a picture has its mean colour", material.name);
  }
  add_transmittance(material, straight * base, alpha);
}

GltfMaterials::PassedLight GltfMaterials::diffusely_passed(const JsonObject& from) {
  const auto diffuse = from.extension("KHR_materials_diffuse_transmission");
  double scattered = share_or(diffuse, "diffuseTransmissionFactor", 0.0);
  Spectrum hue = gltf_color(diffuse, "diffuseTransmissionColorFactor", 3).max(0.0f).min(1.0f);
  if (scattered > 0.0) {
    scattered *=
        texture_mean(diffuse, "diffuseTransmissionTexture", PictureCode::linear, from).alpha;
    hue *= texture_mean(diffuse, "diffuseTransmissionColorTexture", PictureCode::srgb, from)
               .color.cast<float>();
  }
  return {.scattered = static_cast<float>(scattered), .hue = hue};
}

double GltfMaterials::clear_share(const JsonObject& from) {
  const auto transmission = from.extension("KHR_materials_transmission");
  const double clear = share_or(transmission, "transmissionFactor", 0.0);
  if (!(clear > 0.0)) return 0.0;
  return clear *
         texture_mean(transmission, "transmissionTexture", PictureCode::linear, from).color[0];
}

// Lays on the coat that a dielectric is, or its clear coat. Highlights of a roughness above 0.7 are
// nearly diffuse and left to the base.
void GltfMaterials::set_coat(const JsonObject& from, double alpha, Material& material) {
  const auto clear = from.extension("KHR_materials_clearcoat");
  const double clear_share = share_or(clear, "clearcoatFactor", 0.0);
  if (clear_share >= mostly_clear) {
    const double roughness = share_or(clear, "clearcoatRoughnessFactor", 0.0);
    constexpr double of_clear_coats = 1.5;
    return lay_simple_coat(material, of_clear_coats, roughness * roughness,
                           Spectrum::Constant(3, static_cast<float>(clear_share)));
  }
  const auto layer = coat_layer(from);
  if (layer && alpha <= glossy_alpha) {
    lay_simple_coat(material, double{layer->index}, alpha, layer->share);
  }
}

std::optional<GltfMaterials::CoatLayer> GltfMaterials::coat_layer(const JsonObject& from) {
  const auto specular = from.extension("KHR_materials_specular");
  const double index = number_or(from.extension("KHR_materials_ior"), "ior", 1.5);
  const Spectrum share = static_cast<float>(share_or(specular, "specularFactor", 1.0)) *
                         gltf_color(specular, "specularColorFactor", 3).max(0.0f).min(1.0f);
  const bool mirrors = index > 1.0 && index <= highest_index && (share > 0.0f).any();
  if (!mirrors) return std::nullopt;
  return CoatLayer{.index = static_cast<float>(index), .share = share};
}

void GltfMaterials::set_clear(const JsonObject& from, const Spectrum& base, double alpha,
                              bool is_closed, Material& material) {
  double index = number_or(from.extension("KHR_materials_ior"), "ior", 1.5);
  if (index == 0.0) index = 1.5;  // an ior of 0 selects a legacy mode without an index
  if (!(index >= 1.0 && index <= highest_index))
    from.fail("has an index of refraction below 1 or beyond all");
  const auto volume = from.extension("KHR_materials_volume");
  const double thickness = number_or(volume, "thicknessFactor", 0.0);
  Dielectric glass = thin_pane(index, base, alpha);
  if (is_closed || thickness > 0.0) {
    glass.thin = false;
    // The path length in a closed body follows from its geometry; thicknessFactor matters for open
    // sheets only.
    if (is_closed) {
      glass.absorption = absorption(volume);
    } else {
      glass.tint *= passed_by_each_face(volume, thickness);
    }
  }
  material.dielectric = glass;
  material.reflectance.setZero();
  material.specular.setZero();
  material.one_sided = false;
}

void GltfMaterials::set_emission(const JsonObject& from, Material& material) {
  if (!from.has("emissiveFactor")) {
    material.emission = Spectrum::Zero(3);
    return;
  }
  Spectrum M = static_cast<float>(std::numbers::pi) * gltf_color(from, "emissiveFactor", 3);
  M *= static_cast<float>(
      number_or(from.extension("KHR_materials_emissive_strength"), "emissiveStrength", 1.0));
  if (!((M >= 0.0f).all() && M.isFinite().all())) {
    from.fail("has an emission that is negative or too large");
  }
  material.emission = M;
  const auto info = from.object("emissiveTexture");
  if (!info || !material.is_emitter()) return;
  const auto picture = color_picture(*info, from);
  constexpr float grey = 0.5f;
  if (!picture) {
    material.emission *= grey;
    return;
  }
  material.emission.head<3>() *= picture->mean.color.cast<float>();
  const auto base = BaseColor(from).info();
  if (base && coordinates_of(*base) != coordinates_of(*info)) {
    return remarks_.add(
        "Pictures of emission with texture coordinates of their own count by their mean",
        material.name);
  }
  if (material.is_emitter()) {
    material.emission_texture = {.image = laid_on(*info, picture->color), .factor = M};
  }
}

}  // namespace lightwell
