#include "scene/io/mgf/mgf_state.h"

#include "scene/io/default_material.h"
#include "scene/io/glossy.h"
#include "scene/io/sheets.h"

namespace lightwell {
namespace {

Spectrum cut(const Spectrum& share, const std::string& name, Remarks& remarks) {
  if ((share > 1.0f).any()) remarks.add("Colours beyond 1 were cut off in", name);
  return share.min(1.0f);
}

}  // namespace

Material mgf_material(const MgfMaterial& from, const std::string& name, Remarks& remarks) {
  Material material = default_material(rgb_bands());
  material.name = name;
  material.reflectance = cut(from.diffuse, name, remarks);
  material.one_sided = !from.is_two_sided;
  const Spectrum straight = cut(from.straight.share, name, remarks);
  const bool passes = (straight > 0.0f).any();
  const bool shines = (from.exitance > 0.0f).any();
  // A body of one side and an index is filled with its material.
  if (passes && !from.is_two_sided && from.index > 1.0 && from.index <= highest_index && !shines) {
    material.reflectance.setZero();
    material.one_sided = false;
    material.dielectric = Dielectric{.index_of_refraction = static_cast<float>(from.index),
                                     .tint = straight,
                                     .roughness = roughness_of(from.straight.alpha)};
    return material;
  }
  if ((from.mirror.share > 0.0f).any()) {
    add_highlight(material, cut(from.mirror.share, name, remarks), from.mirror.alpha);
  }
  if ((from.passed > 0.0f).any()) {
    add_diffuse_transmittance(material, cut(from.passed, name, remarks));
  }
  if (passes) add_transmittance(material, straight, from.straight.alpha);
  limit_shares(material);
  material.emission = from.exitance;
  material.emits_both_sides = shines && !material.one_sided;
  if (close_lamp(material)) {
    remarks.add("Light passes a lamp nowhere straight on, so ts was left out in", name);
  }
  return material;
}

}  // namespace lightwell
