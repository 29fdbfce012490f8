#include "scene/io/mitsuba/mitsuba_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numbers>

#include "scene/coat.h"
#include "scene/io/default_material.h"
#include "scene/io/glossy.h"
#include "scene/io/mitsuba/mitsuba_presets.h"
#include "scene/io/nearest_name.h"
#include "scene/io/sheets.h"

namespace lightwell {
namespace {

constexpr double bk7 = 1.5046, air = 1.000277;  // Mitsuba's defaults

Spectrum black() {
  return Spectrum::Zero(3);
}

Material opaque_bsdf(const Spectrum& reflectance) {
  return {.reflectance = reflectance, .specular = black(), .emission = black(), .one_sided = true};
}

Material clear_bsdf(double index, const Spectrum& tint) {
  Material material = opaque_bsdf(black());
  material.one_sided = false;
  material.dielectric = Dielectric{.index_of_refraction = static_cast<float>(index), .tint = tint};
  return material;
}

Material pane(double index, const Spectrum& tint, double alpha) {
  Material material = clear_bsdf(index, tint);
  material.dielectric = thin_pane(index, tint, alpha);
  return material;
}

const char* const rough_metal = "Metals of alpha above 0.5 were read as diffuse";

}  // namespace

int MitsubaMaterials::of_shape(const MitsubaNode& shape, const std::string& shape_name) {
  const auto bsdfs = tree_.children(shape, "bsdf");
  const MitsubaNode* bsdf = bsdfs.empty() ? nullptr : bsdfs.front();
  const MitsubaNode* emitter = nullptr;
  for (const char* tag : {"emitter", "luminaire"}) {
    for (const MitsubaNode* node : tree_.children(shape, tag)) {
      if (node->type == "area") {
        emitter = node;
      } else {
        remarks_.add(fmt::format("Emitters of the plugin '{}' give no light here", node->type),
                     shape_name);
      }
    }
  }
  const auto [entry, is_new] =
      index_of_.emplace(std::pair(bsdf, emitter), static_cast<int>(scene_.materials.size()));
  if (!is_new) return entry->second;
  Material material = default_material(scene_.bands);
  if (bsdf) {
    material = read_or_default(*bsdf);
    material.name = bsdf->id.empty() ? fmt::format("material of {}", shape_name) : bsdf->id;
  } else {
    remarks_.mention("Shapes without a BSDF got a diffuse reflectance of 0.5", shape_name);
    material.name = emitter ? fmt::format("material of {}", shape_name) : "default";
  }
  if (emitter) {
    if (bsdf && !bsdf->id.empty()) material.name = fmt::format("{} ({})", bsdf->id, shape_name);
    const Spectrum dark = material.emission;
    if (!remarks_.attempt("Emitters that cannot be used were left out", shape_name,
                          [&] { add_emission(*emitter, shape_name, material); })) {
      material.emission = dark;
      material.emission_texture.reset();
    }
  }
  scene_.materials.push_back(std::move(material));
  return entry->second;
}

Material MitsubaMaterials::read_or_default(const MitsubaNode& bsdf) {
  Material material = default_material(scene_.bands);
  if (!remarks_.attempt("BSDFs that cannot be read got a diffuse reflectance of 0.5", bsdf.label(),
                        [&] { material = read(bsdf, Pixels::all); })) {
    open_.clear();
  }
  return material;
}

void MitsubaMaterials::add_emission(const MitsubaNode& emitter, const std::string& name,
                                    Material& material) {
  // "intensity" is the property's name in Mitsuba 0.3.
  const char* const property = emitter.property("intensity") ? "intensity" : "radiance";
  constexpr auto pi = std::numbers::pi_v<float>;
  if (const auto light = colors_.light(emitter, property)) {
    material.emission = pi * light->mean;
    if (material.is_emitter()) {
      material.emission_texture = light->texture;
      material.emission_texture->factor *= pi;
    }
  } else {
    material.emission = pi * colors_.positive_or(emitter, property, 1.0f);
  }
  if (!material.emission.isFinite().all()) emitter.fail("has a radiance that is too large");
  if (material.dielectric && material.is_emitter()) {
    remarks_.add("Clear materials that shine were read as black ones that shine", name);
    material.dielectric.reset();
  }
  if (close_lamp(material)) {
    remarks_.add("Lamps let no light straight through, so this part was left out", name);
  }
  if (material.mask && material.is_emitter()) {
    remarks_.add("Lamps have no holes, so their masks were left out", name);
    material.mask.reset();
  }
}

Material MitsubaMaterials::read(const MitsubaNode& bsdf, Pixels pixels) {
  const auto known = known_.find({&bsdf, pixels});
  if (known != known_.end()) return known->second;
  if (!open_.insert(&bsdf).second) bsdf.fail("refers to itself");
  constexpr std::size_t deepest = 64;
  if (open_.size() > deepest) bsdf.fail("is nested beyond all measure");
  const Material material = read_new(bsdf, pixels);
  open_.erase(&bsdf);
  return known_.emplace(std::pair(&bsdf, pixels), material).first->second;
}

Material MitsubaMaterials::read_new(const MitsubaNode& bsdf, Pixels pixels) {
  const std::string& type = bsdf.type;
  const auto is = [&](std::initializer_list<const char*> types) {
    return std::ranges::find(types, type) != types.end();
  };
  if (is({"diffuse", "lambertian", "roughdiffuse"})) return diffuse(bsdf, "reflectance", pixels);
  if (is({"conductor", "roughconductor", "mirror"})) return conductor(bsdf, pixels);
  if (is({"dielectric", "roughdielectric", "thindielectric"})) return dielectric(bsdf, pixels);
  if (is({"plastic", "roughplastic"})) return plastic(bsdf, pixels);
  if (is({"principled", "principledthin", "disney"})) return principled(bsdf, pixels);
  if (type == "twosided") return two_sided(bsdf, pixels);
  if (is({"mask", "bumpmap", "bump", "normalmap", "coating", "roughcoating"}))
    return wrapped(bsdf, pixels);
  if (is({"blendbsdf", "mixturebsdf"})) return blend(bsdf, pixels);
  if (is({"difftrans", "diffuse_transmitter"})) return transmitter(bsdf, pixels);
  if (type == "null") {
    Material material = opaque_bsdf(black());
    add_regular_transmittance(material, Spectrum::Ones(3));
    return material;
  }
  if (is({"phong", "ward", "modified_phong"})) return highlighted(bsdf, pixels);
  remarks_.add(
      fmt::format("BSDF plugin '{}' is not known and got a diffuse reflectance of 0.5", type),
      bsdf.label());
  Material material = opaque_bsdf(Spectrum::Constant(3, 0.5f));
  material.one_sided = false;
  return material;
}

Material MitsubaMaterials::diffuse(const MitsubaNode& bsdf, std::string_view property,
                                   Pixels pixels) {
  if (const auto picture = colors_.texture(bsdf, property, pixels)) {
    Material material = opaque_bsdf(picture->mean);
    material.texture = picture->texture;
    return material;
  }
  return opaque_bsdf(colors_.share_or(bsdf, property, 0.5f, pixels));
}

Material MitsubaMaterials::transmitter(const MitsubaNode& bsdf, Pixels pixels) {
  Material material = opaque_bsdf(black());
  material.one_sided = false;
  add_diffuse_transmittance(material, colors_.share_or(bsdf, "transmittance", 0.5f, pixels));
  return material;
}

Material MitsubaMaterials::conductor(const MitsubaNode& bsdf, Pixels pixels) {
  Spectrum reflectance = Spectrum::Ones(3);
  std::optional<Conductor> metal;
  const auto eta = colors_.positive(bsdf, "eta"), k = colors_.positive(bsdf, "k");
  if (eta && k) {
    metal = Conductor{.eta = *eta, .k = *k};
    reflectance = mean_reflectance(*metal);
  } else if (bsdf.type != "mirror") {
    const std::string name = bsdf.string_or("material", eta || k ? "none" : "Cu");
    if (const auto known = metal_preset(name)) {
      reflectance = *known;
    } else {
      // Iron, nickel, platinum and titanium reflect 0.5 to 0.65.
      remarks_.add(fmt::format("Metal '{}' is not known and got a reflectance of 0.6", name),
                   bsdf.label());
      reflectance.setConstant(0.6f);
    }
  }
  const Spectrum share = colors_.share_or(bsdf, "specular_reflectance", 1.0f, pixels);
  reflectance *= share;
  const double alpha = bsdf.type == "roughconductor" ? roughness(bsdf) : 0.0;
  if (bsdf.type == "roughconductor") {
    if (alpha > glossy_alpha) remarks_.add(rough_metal, bsdf.label());
  }
  Material material = opaque_bsdf(black());
  set_metallic(material, reflectance, 1.0, alpha);
  if (metal && (material.specular > 0.0f).any()) {
    material.metal = metal;
    material.specular = share;
  }
  vary_gloss(bsdf, material);
  return material;
}

// GGX alpha; the larger of two anisotropic values. Beckmann's alpha is used unchanged, since both
// lobes agree in the middle.
double MitsubaMaterials::roughness(const MitsubaNode& bsdf) {
  const double alpha =
      std::max(colors_.number_or(bsdf, "alpha_u", 0.0), colors_.number_or(bsdf, "alpha_v", 0.0));
  return mean_or(bsdf, "alpha", alpha > 0.0 ? alpha : 0.1);
}

// Refractive index given as a number or as the name of a material.
double MitsubaMaterials::index(const MitsubaNode& bsdf, std::string_view property,
                               double otherwise) {
  const MitsubaNode* node = bsdf.property(property);
  if (!node || node->tag != "string") return bsdf.number_or(property, otherwise);
  const std::string name = bsdf.string_or(property, "");
  if (const auto known = index_preset(name)) return *known;
  node->fail(
      fmt::format("is '{}', a material whose index of refraction is not known; give a "
                  "number.{}",
                  name, did_you_mean(name, index_preset_names())));
}

// Relative refractive index, inside over outside.
double MitsubaMaterials::index_ratio(const MitsubaNode& bsdf, double inside) {
  const double ratio = index(bsdf, "int_ior", inside) / index(bsdf, "ext_ior", air);
  if (!(ratio >= lowest_index && ratio <= highest_index)) {
    bsdf.fail(fmt::format("has a ratio of refractive indices of {}; glass has 1.5", ratio));
  }
  return ratio;
}

Material MitsubaMaterials::dielectric(const MitsubaNode& bsdf, Pixels pixels) {
  const double ratio = index_ratio(bsdf, bk7);
  const Spectrum tint = colors_.share_or(bsdf, "specular_transmittance", 1.0f, pixels);
  if (bsdf.type == "thindielectric") {
    return pane(ratio, tint, 0.0);
  }
  Material glass = clear_bsdf(ratio, tint);
  if (bsdf.type == "roughdielectric") {
    glass.dielectric->roughness = roughness_of(roughness(bsdf));
    vary_gloss(bsdf, glass);
  }
  return glass;
}

// A smooth or rough coating over another BSDF. Light passes the coating's absorption twice.
Material MitsubaMaterials::coated(const MitsubaNode& bsdf, Material material, Pixels pixels) {
  if (material.dielectric || (material.specular > 0.0f).any()) {
    remarks_.add("Coatings over mirrors and glass were left out", bsdf.label());
    return material;
  }
  Spectrum passed = Spectrum::Ones(3);
  if (const auto sigma = colors_.positive(bsdf, "sigma_a")) {
    passed = (-2.0f * static_cast<float>(bsdf.number_or("thickness", 1.0)) * *sigma).exp();
  }
  material.reflectance *= passed;
  if (material.is_translucent()) material.transmittance *= passed;
  if (material.texture) material.texture->factor *= passed;
  const double alpha = bsdf.type == "roughcoating" ? roughness(bsdf) : 0.0;
  const double index = std::max(index_ratio(bsdf, bk7), double{lowest_coat_index});
  lay_coat(material, index, alpha, colors_.share_or(bsdf, "specular_reflectance", 1.0f, pixels));
  vary_gloss(bsdf, material);
  return material;
}

// Phong's and Ward's highlights: a share of the light, at every angle alike.
Material MitsubaMaterials::highlighted(const MitsubaNode& bsdf, Pixels pixels) {
  Material material = diffuse(bsdf, "diffuse_reflectance", pixels);
  const Spectrum share = colors_.share_or(bsdf, "specular_reflectance", 0.2f, pixels);
  const double alpha = bsdf.type == "ward"
                           ? roughness(bsdf)
                           : alpha_of_exponent(colors_.number_or(bsdf, "exponent", 30.0));
  const Spectrum brightest =
      material.texture
          ? Spectrum(material.texture->factor * material.texture->image.picture->largest())
          : material.reflectance;
  add_highlight(material, share.min(1.0f - brightest).max(0.0f), alpha);
  return material;
}

Material MitsubaMaterials::principled(const MitsubaNode& bsdf, Pixels pixels) {
  const auto picture = colors_.texture(bsdf, "base_color", pixels);
  const Spectrum color =
      picture ? picture->mean : colors_.share_or(bsdf, "base_color", 0.5f, pixels);
  const auto share = [&](const char* property, double otherwise) {
    return std::clamp(mean_or(bsdf, property, otherwise), 0.0, 1.0);
  };
  const double alpha = share("roughness", 0.5) * share("roughness", 0.5);
  const bool is_thin = bsdf.type == "principledthin";
  if (share("spec_trans", 0.0) >= (is_thin ? nearly_clear : mostly_clear)) {
    return clear_principled(bsdf, color, alpha);
  }
  remarks_.add("Principled BSDFs were read by their base colour, metallic and roughness",
               bsdf.label());
  Material material = opaque_bsdf(black());
  const double metallic = is_thin ? 0.0 : share("metallic", 0.0);  // sheets are no metal
  set_metallic(material, color, metallic, alpha);
  if (picture && (material.reflectance > 0.0f).any()) {
    material.texture = picture->texture;
    material.texture->factor *= (color > 0.0f).select(material.reflectance / color, 0.0f);
  }
  if (is_thin) pass_thin(bsdf, color, alpha, material);
  // The reflectance 0.08 specular at normal incidence, as an index of refraction.
  const double root = std::sqrt(0.08 * share("specular", 0.5));
  const double given =
      bsdf.property("eta") ? this->index(bsdf, "eta", 1.5) : (1.0 + root) / (1.0 - root);
  const double index = std::clamp(given, double{lowest_coat_index}, double{highest_index});
  if (metallic < least_metallic && alpha <= glossy_alpha) {
    lay_simple_coat(material, index, alpha, Spectrum::Ones(3));
  }
  if (!is_thin) vary_principled(bsdf, picture ? picture->texture.factor : color, index, material);
  return material;
}

// Glass, or a pane without thickness.
Material MitsubaMaterials::clear_principled(const MitsubaNode& bsdf, const Spectrum& color,
                                            double alpha) {
  const double eta = index(bsdf, "eta", 1.5);
  if (!(eta >= lowest_index && eta <= highest_index))
    bsdf.fail("has no index of refraction that glass has");
  if (bsdf.type == "principledthin") return pane(eta, color, alpha);
  remarks_.add("Principled BSDFs that are mostly clear were read as glass", bsdf.label());
  Material glass = clear_bsdf(eta, color);
  glass.dielectric->roughness = roughness_of(alpha);
  return glass;
}

// principledthin: `spec_trans` of the light passes the sheet without being scattered, and of the
// rest half of `diff_trans` diffusely.
void MitsubaMaterials::pass_thin(const MitsubaNode& bsdf, const Spectrum& color, double alpha,
                                 Material& material) {
  const double straight = std::clamp(colors_.number_or(bsdf, "spec_trans", 0.0), 0.0, 1.0);
  const double diffuse = std::clamp(0.5 * colors_.number_or(bsdf, "diff_trans", 0.0), 0.0, 1.0);
  const auto kept = static_cast<float>(1.0 - straight);
  const auto reflected = static_cast<float>(1.0 - diffuse);
  add_diffuse_transmittance(material, kept * (1.0f - reflected) * material.reflectance);
  material.reflectance *= kept * reflected;
  if (material.texture) material.texture->factor *= kept * reflected;
  if (material.texture && (straight > 0.0 || diffuse > 0.0)) {
    remarks_.add("What passes sheets with a picture has its mean colour", bsdf.label());
  }
  add_transmittance(material, static_cast<float>(straight) * color, alpha);
}

// The share `opacity` of a BSDF; the rest of the light passes straight on.
Material MitsubaMaterials::masked(const MitsubaNode& bsdf, const MitsubaNode& inner) {
  const bool is_picture = colors_.is_bitmap(bsdf, "opacity");
  Material material = read(inner, is_picture ? Pixels::by_opacity : Pixels::all);
  Spectrum opacity = Spectrum::Ones(3);
  if (is_picture) {
    const auto mask = colors_.mask(bsdf, "opacity");
    const auto even = mask ? even_opacity(*mask->image.picture) : std::nullopt;
    if (even && !material.dielectric) {
      let_through(material, ShareTexture{.image = mask->image});
      return material;
    }
    if (even) opacity.setConstant(*even);
    if (mask && !even) material.mask = mask;
  } else {
    opacity = colors_.share_or(bsdf, "opacity", 0.5f, Pixels::all);
  }
  if (material.dielectric && (opacity < 1.0f).any()) {
    remarks_.add("Masks of glass that cut no holes were left out", bsdf.label());
    return material;
  }
  let_through(material, opacity);
  return material;
}

Material MitsubaMaterials::wrapped(const MitsubaNode& bsdf, Pixels pixels) {
  const auto inner = tree_.children(bsdf, "bsdf");
  if (inner.empty()) bsdf.fail("holds no BSDF");
  if (bsdf.type == "coating" || bsdf.type == "roughcoating") {
    return coated(bsdf, read(*inner.front(), pixels), pixels);
  }
  if (bsdf.type == "mask") return masked(bsdf, *inner.front());
  Material material = read(*inner.front(), pixels);
  remarks_.attempt("Relief that cannot be used was left out", bsdf.label(), [&] {
    if (auto relief = colors_.relief(bsdf)) material.relief = std::move(relief);
  });
  return material;
}

Material MitsubaMaterials::two_sided(const MitsubaNode& bsdf, Pixels pixels) {
  const auto inner = tree_.children(bsdf, "bsdf");
  if (inner.empty()) bsdf.fail("holds no BSDF");
  if (inner.size() > 1) {
    remarks_.add("Surfaces whose sides differ got the front's BSDF on both", bsdf.label());
  }
  Material material = read(*inner.front(), pixels);
  material.one_sided = false;
  return material;
}

// Adds what a part of a blend mirrors. Of a coat and a mirror, or of two coats that differ, the one
// that mirrors more stays.
void MitsubaMaterials::add_gloss(const Material& part, float weight, const MitsubaNode& bsdf,
                                 Material& sum) {
  const auto mirrors = [](const Material& m) { return (m.specular > 0.0f).any(); };
  if (!mirrors(part)) return;
  const auto index = [](const Material& m) { return m.coat ? m.coat->index_of_refraction : 0.0f; };
  const bool is_alike = !mirrors(sum) || index(sum) == index(part);
  if (!is_alike) {
    remarks_.add("Blends of different coats, or of coats and mirrors, kept the brighter one",
                 bsdf.label());
    const float added = weight * mean_mirrored(part).mean();
    if (added <= mean_mirrored(sum).mean()) return;
    sum.specular.setZero();
    sum.specular_roughness = 0.0f;
  }
  sum.coat = part.coat;
  // Metals by angle count by their mean.
  sum.specular += weight * (part.metal ? mean_mirrored(part) : part.specular);
  sum.specular_roughness = std::max(sum.specular_roughness, part.specular_roughness);
}

Material MitsubaMaterials::blend(const MitsubaNode& bsdf, Pixels pixels) {
  const auto inner = tree_.children(bsdf, "bsdf");
  if (inner.empty()) bsdf.fail("holds no BSDF");
  std::vector<float> weights;
  if (bsdf.type == "blendbsdf" && inner.size() == 2) {
    const float second = colors_.share_or(bsdf, "weight", 0.5f, pixels).mean();
    weights = {1.0f - second, second};
  } else if (const MitsubaNode* given = bsdf.property("weights")) {
    for (const double weight : parse_numbers(*given, bsdf.string_or("weights", ""))) {
      if (!(weight >= 0.0 && weight <= 1.0)) given->fail("has a weight outside [0, 1]");
      weights.push_back(static_cast<float>(weight));
    }
  }
  if (weights.size() != inner.size()) bsdf.fail("needs one weight for each BSDF it blends");
  remarks_.add("Blended BSDFs were read as the mean of their parts", bsdf.label());
  if (std::ranges::any_of(inner,
                          [&](const auto* b) { return read(*b, pixels).texture.has_value(); })) {
    remarks_.add("Pictures in blended BSDFs were read as their mean colour", bsdf.label());
  }
  if (std::ranges::any_of(inner,
                          [&](const auto* b) { return read(*b, pixels).relief.has_value(); })) {
    remarks_.add("Relief in blended BSDFs was left out", bsdf.label());
  }
  Material sum = opaque_bsdf(black());
  sum.one_sided =
      std::ranges::all_of(inner, [&](const auto* b) { return read(*b, pixels).one_sided; });
  for (std::size_t i = 0; i < inner.size(); ++i) {
    const Material part = read(*inner[i], pixels);
    if (part.dielectric) {
      if (weights[i] >= 0.5f) return part;
      continue;
    }
    sum.reflectance += weights[i] * part.reflectance;
    add_gloss(part, weights[i], bsdf, sum);
    add_passed(part, weights[i], sum);
  }
  // The weights of a mixture may add up to more than 1; the shares of light must not.
  limit_shares(sum);
  return sum;
}

}  // namespace lightwell
