// Smooth and rough plastics of Mitsuba.
#include <algorithm>

#include "scene/io/glossy.h"
#include "scene/io/mitsuba/mitsuba_materials.h"
#include "scene/io/mitsuba/rough_coat.h"

namespace lightwell {

Material MitsubaMaterials::plastic(const MitsubaNode& bsdf, Pixels pixels) {
  constexpr double polypropylene = 1.49;  // Mitsuba's default
  Material material = diffuse(bsdf, "diffuse_reflectance", pixels);
  const Spectrum specular = colors_.share_or(bsdf, "specular_reflectance", 1.0f, pixels);
  const double alpha = bsdf.type == "roughplastic" ? roughness(bsdf) : 0.0;
  const double index = std::max(index_ratio(bsdf, polypropylene), double{lowest_coat_index});
  // Without `nonlinear`, Mitsuba's base reflects as if it were white below the coat.
  const bool saturating = bsdf.boolean_or("nonlinear", false);
  if (roughness_of(alpha) > 0.0f) {
    const bool is_ggx = bsdf.string_or("distribution", "beckmann") == "ggx";
    const LossyCoat coat(index, alpha,
                         is_ggx ? LossyCoat::Facets::ggx : LossyCoat::Facets::beckmann, saturating);
    lay_coat(material, index, alpha, specular,
             [&](const Spectrum& base) { return coat.reflectance(base); });
  } else {
    lay_coat(material, index, alpha, specular, saturating);
  }
  vary_gloss(bsdf, material);
  return material;
}

}  // namespace lightwell
