#include "scene/facet_textures.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "scene/material_at.h"
#include "scene/sampling.h"

namespace lightwell {

FacetTextures::FacetTextures(const Scene& scene) : basis_(scene.bands) {
  std::vector<int> pictures_of_material;
  for (const Material& material : scene.materials) {
    const bool varies =
        material.texture || material.emission_texture || material.mask || material.pattern;
    pictures_of_material.push_back(varies ? static_cast<int>(pictures_.size()) : -1);
    if (varies) {
      pictures_.push_back({.texture = material.texture,
                           .emission = material.emission_texture,
                           .mask = material.mask});
      if (material.pattern) {
        pictures_.back().patterned = std::make_shared<const Material>(material);
      }
    }
  }
  if (pictures_.empty()) return;
  bool any = false;
  for (const Surface& surface : scene.surfaces) {
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    const int pictures = pictures_of_material[static_cast<std::size_t>(surface.material)];
    if (!mesh || pictures < 0) {
      entry_of_.insert(entry_of_.end(), mesh ? mesh->facets.size() : 1, -1);
      continue;
    }
    const int first = static_cast<int>(entries_.size());
    for (const UvMap& uv : mesh->uv_maps) entries_.push_back({.pictures = pictures, .uv = uv});
    for (const Facet& facet : mesh->facets) {
      const bool has_uv = facet.uv_map >= 0;
      entry_of_.push_back(has_uv ? first + facet.uv_map : -1);
      any = any || has_uv;
      const Pictures& shown = pictures_[static_cast<std::size_t>(pictures)];
      has_holes_ = has_holes_ || (has_uv && shown.mask.has_value());
      has_emission_ = has_emission_ || (has_uv && shown.emission.has_value());
      has_patterns_ = has_patterns_ || (has_uv && shown.patterned);
    }
  }
  if (!any) entry_of_.clear();
  for (std::size_t f = 0; f < entry_of_.size(); ++f) {
    const int facet = static_cast<int>(f);
    if (has_holes(facet)) add_to_hash(facet);
  }
}

void FacetTextures::add_to_hash(int facet) {
  const auto add = [&](std::uint64_t bits) { hash_of_holes_ = random_key(hash_of_holes_, bits); };
  const auto add_numbers = [&](const auto& numbers) {
    for (const double x : numbers.reshaped()) add(std::bit_cast<std::uint64_t>(x));
  };
  const Mask& mask = *materials_of(facet).mask;
  add(static_cast<std::uint64_t>(facet));
  add(mask.image.picture->hash());
  add(std::bit_cast<std::uint32_t>(mask.cutoff));
  for (const TextureWrap wrap : mask.image.wrap) add(static_cast<std::uint64_t>(wrap));
  add(static_cast<std::uint64_t>(mask.image.is_smooth));
  add_numbers(mask.image.placement);
  add_numbers(entry(facet).uv.gradient);
  add_numbers(entry(facet).uv.offset);
}

Material FacetTextures::material(int facet, const Eigen::Vector3d& point) const {
  const Material& patterned = *materials_of(facet).patterned;
  return material_at(patterned, values_at(patterned, entry(facet).uv.at(point), basis_));
}

Material FacetTextures::material(int facet, const Eigen::Vector3d& point,
                                 const Eigen::Matrix<double, 3, 2>& footprint) const {
  const Material& patterned = *materials_of(facet).patterned;
  const UvMap& uv = entry(facet).uv;
  return material_at(patterned,
                     values_over(patterned, uv.at(point), uv.gradient * footprint, basis_));
}

float FacetTextures::roughness(int facet, const Eigen::Vector3d& point) const {
  return roughness_at(*materials_of(facet).patterned, entry(facet).uv.at(point));
}

Spectrum FacetTextures::reflectance(int facet, const Eigen::Vector3d& point) const {
  if (has_pattern(facet)) return material(facet, point).reflectance;
  const ReflectanceTexture& texture = *materials_of(facet).texture;
  return texture.factor * basis_.reflectance(texture.image.at(entry(facet).uv.at(point)));
}

Spectrum FacetTextures::reflectance(int facet, const Eigen::Vector3d& point,
                                    const Eigen::Matrix<double, 3, 2>& footprint) const {
  if (has_pattern(facet)) return material(facet, point, footprint).reflectance;
  const ReflectanceTexture& texture = *materials_of(facet).texture;
  const UvMap& uv = entry(facet).uv;
  return texture.factor *
         basis_.reflectance(texture.image.over(uv.at(point), uv.gradient * footprint));
}

Spectrum FacetTextures::emission(int facet, const Eigen::Vector3d& point) const {
  const EmissionTexture& texture = emission_texture(facet);
  return texture.factor * texture.image.at(uv_map(facet).at(point));
}

Spectrum FacetTextures::emission(int facet, const Eigen::Vector3d& point,
                                 const Eigen::Matrix<double, 3, 2>& footprint) const {
  const EmissionTexture& texture = emission_texture(facet);
  const UvMap& uv = uv_map(facet);
  return texture.factor * texture.image.over(uv.at(point), uv.gradient * footprint);
}

double FacetTextures::texels_along(int facet, const Eigen::Vector3d& vector) const {
  const Pictures& shown = materials_of(facet);
  const Eigen::Vector2d in_uv = uv_map(facet).gradient * vector;
  double texels = 0.0;
  const auto count = [&](const SurfaceTexture& image) {
    const Eigen::Vector2d along = image.placement.leftCols<2>() * in_uv;
    texels = std::max(texels, std::hypot(along.x() * image.picture->width(),
                                         along.y() * image.picture->height()));
  };
  if (shown.texture) count(shown.texture->image);
  if (shown.emission) count(shown.emission->image);
  if (!shown.patterned) return texels;
  for (const auto& share : pictures_of(*shown.patterned->pattern)) count(share->image);
  return texels;
}

bool FacetTextures::is_hole(int facet, const Eigen::Vector3d& point) const {
  const Mask& mask = *materials_of(facet).mask;
  return !(mask.image.at(entry(facet).uv.at(point))[0] >= mask.cutoff);
}

}  // namespace lightwell
