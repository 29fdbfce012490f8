// Conversion of RADIANCE's material types. Sources: Ward & Shakespeare, Rendering with Radiance,
// 1998, and the reference manual.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "scene/io/glossy.h"
#include "scene/io/radiance/radiance_materials.h"
#include "scene/io/sheets.h"
#include "scene/io/text_file.h"
#include "scene/optics.h"

namespace lightwell {
namespace {

using Maybe = std::optional<Material>;

constexpr double window_glass = 1.52;

struct Given {
  const RadiancePrimitive& p;
  const RadiancePattern& pattern;
  Remarks& remarks;

  void remark(const char* what) const { remarks.add(what, p.name); }

  // Three real arguments, each at least 0.
  Spectrum rgb(std::size_t first) const {
    Spectrum result(3);
    for (int k = 0; k < 3; ++k) {
      const double value = p.reals[first + static_cast<std::size_t>(k)];
      result[k] = static_cast<float>(value);
      if (!(value >= 0.0 && std::isfinite(result[k]))) {
        p.fail(fmt::format("has the colour component {}; it must be at least 0", value));
      }
    }
    return result;
  }
  // A reflectance: three arguments times the pattern, at most 1.
  Spectrum color(std::size_t first) const {
    const Spectrum result = rgb(first) * pattern.factor;
    if ((result > 1.0f).any()) remark("Colours beyond 1, which would make light, were cut off");
    return result.min(1.0f);
  }
  float share(std::size_t i, const char* what) const {
    const double value = p.reals[i];
    if (!(value >= 0.0 && value <= 1.0)) {
      p.fail(fmt::format("has the {} {}; it must lie in 0 to 1", what, value));
    }
    return static_cast<float>(value);
  }
  double roughness(std::size_t i) const {
    const double value = p.reals[i];
    if (!(value >= 0.0)) p.fail(fmt::format("has the roughness {}; it must be positive", value));
    return value;
  }
};

Spectrum zero() {
  return Spectrum::Zero(3);
}

Material opaque(const Spectrum& reflectance) {
  return {.reflectance = reflectance, .specular = zero(), .emission = zero()};
}

Material clear(double index, const Spectrum& tint) {
  Material material = opaque(zero());
  material.dielectric = Dielectric{.index_of_refraction = static_cast<float>(index), .tint = tint};
  return material;
}

// A diffuse material with a highlight. Ward's roughness (1992), the width of a Gaussian of slopes,
// is used as GGX alpha; both lobes agree in the middle.
Material glossy(const Given& given, const Spectrum& diffuse, const Spectrum& specular,
                double roughness) {
  Material material = opaque(diffuse);
  if (!(specular > 0.0f).any()) return material;
  if (roughness > glossy_alpha) {
    given.remark("Highlights of a roughness above 0.5 were read as diffuse light");
  }
  add_highlight(material, specular, roughness);
  // Rounding could make the sum exceed 1.
  material.reflectance = material.reflectance.min(1.0f - material.specular);
  return material;
}

// Specularity from which RADIANCE mirrors more light at grazing angles, by exp(-5.85 cos), as do
// the surfaces of polished materials; and the highest one that a coat's index is read from.
constexpr float least_coat = 0.018f, highest_coat = 0.5f;

// Index of refraction of a surface that mirrors this share along its normal (Fresnel 1823).
double index_of(float specularity) {
  const double root = std::sqrt(static_cast<double>(specularity));
  return (1.0 + root) / (1.0 - root);
}

// plastic and metal. Arguments: red green blue specularity roughness [roughness of the other
// direction].
Material reflecting(const Given& given, bool is_metal, double roughness) {
  const Spectrum color = given.color(0);
  const float specular = given.share(3, "specularity");
  if (!is_metal && roughness <= smooth_alpha && specular >= least_coat &&
      specular <= highest_coat) {
    Material coated = opaque(color);
    lay_simple_coat(coated, index_of(specular), 0.0, Spectrum::Ones(3));
    return coated;
  }
  const Spectrum highlight = specular * (is_metal ? color : Spectrum(Spectrum::Ones(3)));
  return glossy(given, (1.0f - specular) * color, highlight, roughness);
}

Maybe plastic_or_metal(const Given& given) {
  const bool is_metal = given.p.type.starts_with("metal");
  if (!given.p.type.ends_with('2')) {
    given.p.require_reals(5);
    return reflecting(given, is_metal, given.roughness(4));
  }
  given.p.require_reals(6);
  return reflecting(given, is_metal, std::max(given.roughness(4), given.roughness(5)));
}

// plasfunc, metfunc, plasdata and metdata: the highlight is a function that is not evaluated here;
// a wide lobe replaces the function.
Maybe with_function(const Given& given) {
  if (given.p.reals.size() < 4) given.p.fail("needs a colour and a specularity");
  constexpr double wide = 1.0;
  return reflecting(given, given.p.type.starts_with("met"), wide);
}

// trans. Arguments: red green blue specularity roughness transmissivity transmitted-specularity.
Material translucent(const Given& given, std::size_t transmissivity, double roughness) {
  const float specular = given.share(3, "specularity");
  const float passing = given.share(transmissivity, "transmissivity");
  const float straight = given.share(transmissivity + 1, "transmitted specularity");
  const Spectrum inside = (1.0f - specular) * given.color(0);
  const Spectrum through = passing * straight * inside;
  if (roughness > straight_alpha && (through > 0.0f).any()) {
    given.remark("Light that passes with a roughness above 0.1 was read as diffuse");
  }
  Material material =
      glossy(given, (1.0f - passing) * inside, Spectrum::Constant(3, specular), roughness);
  add_diffuse_transmittance(material, passing * (1.0f - straight) * inside);
  add_transmittance(material, through, roughness);
  return material;
}

Maybe trans(const Given& given) {
  if (given.p.type == "trans") {
    given.p.require_reals(7);
    return translucent(given, 5, given.roughness(4));
  }
  given.p.require_reals(8);
  return translucent(given, 6, std::max(given.roughness(4), given.roughness(5)));
}

Maybe transfunc(const Given& given) {
  if (given.p.reals.size() < 6) given.p.fail("needs a colour, a specularity and what passes");
  constexpr double wide = 1.0;
  return translucent(given, 4, wide);
}

// ashik2 (Ashikhmin & Shirley 2000): diffuse and specular colours and the exponents of the
// highlight.
Maybe ashik2(const Given& given) {
  given.p.require_reals(8);
  const double exponent = std::min(given.p.reals[6], given.p.reals[7]);
  if (!(exponent >= 0.0)) given.p.fail("has a negative exponent");
  Spectrum diffuse = given.color(0), specular = given.color(3);
  const Spectrum excess = (diffuse + specular).max(1.0f);
  return glossy(given, diffuse / excess, specular / excess, std::sqrt(2.0 / (exponent + 2.0)));
}

double refractive_index(const Given& given, std::size_t i) {
  const double index = given.p.reals[i];
  if (!(index >= lowest_index && index <= highest_index)) {
    given.p.fail(fmt::format("has the index of refraction {}; glass has 1.52", index));
  }
  return index;
}

// A pane of transmissivity t, the share of light that crosses the glass once inside, along the
// normal.
Maybe glass(const Given& given) {
  if (given.p.reals.size() != 4) given.p.require_reals(3);
  const double index = given.p.reals.size() == 4 ? refractive_index(given, 3) : window_glass;
  const Spectrum t = given.color(0);
  Material material = opaque(zero());
  material.dielectric = thin_pane(index, Spectrum::Ones(3));
  if ((t < 1.0f).any()) material.dielectric->transmissivity = t;
  return material;
}

// Absorption, 1/m, of a body of which a metre passes these shares.
Spectrum absorption_of(const Spectrum& transmissivity) {
  return (-transmissivity.min(1.0f).log()).min(highest_absorption);
}

Maybe dielectric(const Given& given) {
  const bool is_interface = given.p.type == "interface";
  given.p.require_reals(is_interface ? 8 : 5);
  const double outside = is_interface ? refractive_index(given, 7) : 1.0;
  Material material = clear(refractive_index(given, 3) / outside, Spectrum::Ones(3));
  if (const Spectrum inside = given.rgb(0); (inside < 1.0f).any()) {
    material.dielectric->absorption = absorption_of(inside);
  }
  if (is_interface && (given.rgb(4) != 1.0f).any()) {
    given.remark("What the outer side of interfaces absorbs was left out");
  }
  return material;
}

Maybe mirror(const Given& given) {
  given.p.require_reals(3);
  Material material = opaque(zero());
  material.specular = given.color(0);
  material.one_sided = true;
  return material;
}

void require_light(const RadiancePrimitive& p) {
  p.require_reals(p.type == "spotlight" ? 7 : p.type == "glow" ? 4 : 3);
}

Material shining(const Given& given, float scale) {
  Material material = opaque(zero());
  const Spectrum radiance = radiance_color(given.p, given.remarks);
  material.emission =
      scale * static_cast<float>(std::numbers::pi) * radiance * given.pattern.factor;
  if (!material.emission.isFinite().all()) given.p.fail("has a radiance that is too large");
  material.one_sided = true;
  if (!given.pattern.is_known) {
    given.remark("Lights whose pattern is not known shine as without it, so their light is wrong");
  }
  return material;
}

Maybe light(const Given& given) {
  require_light(given.p);
  if (given.p.type == "illum") {
    given.remark("Illums were read as opaque lights, so what lies behind them is not seen");
  }
  return shining(given, 1.0f);
}

// A Lambertian emitter sends the share sin^2(a) of its power into the cone of half angle a.
Maybe spotlight(const Given& given) {
  require_light(given.p);
  const double angle = given.p.reals[3];
  if (!(angle > 0.0)) given.p.fail(fmt::format("has a beam of {} degrees", angle));
  given.remark("Spotlights shine to all sides, with the power of their beam");
  const double half = std::min(angle, 180.0) * std::numbers::pi / 360.0;
  return shining(given, static_cast<float>(std::sin(half) * std::sin(half)));
}

// Three string arguments that are shares; empty if one is a formula.
std::optional<Spectrum> constant_shares(const Given& given, std::size_t first) {
  Spectrum shares(3);
  for (std::size_t k = 0; k < 3; ++k) {
    if (first + k >= given.p.strings.size()) return std::nullopt;
    const auto value = parse_finite(given.p.strings[first + k]);
    if (!value || !(*value >= 0.0 && *value <= 1.0)) return std::nullopt;
    shares[static_cast<Eigen::Index>(k)] = static_cast<float>(*value);
  }
  return shares;
}

// Keeps the diffuse reflectance of the front, the diffuse transmittance, and of a BRTDfunc what it
// mirrors and passes straight on if that is constant. Real arguments: reflectance of the front, of
// the back, transmittance.
Maybe by_diffuse_part(const Given& given) {
  if (given.p.reals.size() < 3) {
    given.remark("Materials whose data stand in other files got a diffuse reflectance of 0.5");
    return opaque(Spectrum::Constant(3, 0.5f));
  }
  given.remark("Materials of measured or programmed scattering kept their diffuse part alone");
  Material material = opaque(given.color(0));
  if (given.p.reals.size() >= 9) add_diffuse_transmittance(material, given.color(6));
  if (given.p.type == "BRTDfunc") {
    material.specular = constant_shares(given, 0).value_or(zero());
    add_regular_transmittance(material, constant_shares(given, 3).value_or(zero()));
  }
  limit_shares(material);
  return material;
}

Maybe prism(const Given& given) {
  given.remark("Prisms let light straight through");
  Material material = opaque(zero());
  add_regular_transmittance(material, Spectrum::Ones(3));
  return material;
}

Maybe unseen(const Given&) {
  return std::nullopt;
}

using Reader = Maybe (*)(const Given&);

const std::map<std::string, Reader>& readers() {
  static const std::map<std::string, Reader> table = {{"plastic", plastic_or_metal},
                                                      {"metal", plastic_or_metal},
                                                      {"plastic2", plastic_or_metal},
                                                      {"metal2", plastic_or_metal},
                                                      {"plasfunc", with_function},
                                                      {"metfunc", with_function},
                                                      {"plasdata", with_function},
                                                      {"metdata", with_function},
                                                      {"trans", trans},
                                                      {"trans2", trans},
                                                      {"transfunc", transfunc},
                                                      {"transdata", transfunc},
                                                      {"ashik2", ashik2},
                                                      {"glass", glass},
                                                      {"dielectric", dielectric},
                                                      {"interface", dielectric},
                                                      {"mirror", mirror},
                                                      {"light", light},
                                                      {"glow", light},
                                                      {"illum", light},
                                                      {"spotlight", spotlight},
                                                      {"BRTDfunc", by_diffuse_part},
                                                      {"WGMDfunc", by_diffuse_part},
                                                      {"BSDF", by_diffuse_part},
                                                      {"aBSDF", by_diffuse_part},
                                                      {"prism1", prism},
                                                      {"prism2", prism},
                                                      {"mist", unseen},
                                                      {"antimatter", unseen}};
  return table;
}

}  // namespace

bool is_only_seen(const RadiancePrimitive& light) {
  require_light(light);
  return light.type == "glow" && light.reals[3] < 0.0;
}

Spectrum radiance_color(const RadiancePrimitive& light, Remarks& remarks) {
  require_light(light);
  const Given given{light, {}, remarks};
  const Spectrum color = given.rgb(0);
  if (!is_only_seen(light)) return color;
  given.remark("Glows of a negative radius, which are seen but light nothing, were read as black");
  return zero();
}

std::optional<Material> read_radiance_material(const RadiancePrimitive& material,
                                               const RadiancePattern& pattern, Remarks& remarks) {
  return readers().at(material.type)({material, pattern, remarks});
}

}  // namespace lightwell
