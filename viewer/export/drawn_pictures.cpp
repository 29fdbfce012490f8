#include "viewer/export/drawn_pictures.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "mesh/patches/patch_textures.h"
#include "raytrace/display/display.h"
#include "scene/facet_textures.h"

namespace lightwell {
namespace {

constexpr int opaque = 255;

int level_that_fits(const Texture& picture, int longest) {
  int level = 0;
  while (level + 1 < picture.level_count() &&
         std::max(picture.level_width(level), picture.level_height(level)) > longest) {
    ++level;
  }
  return level;
}

// Texture coordinates of a point of the picture, the inverse of image.placement.
Eigen::Vector2d uv_at(const SurfaceTexture& image, const Eigen::Vector2d& place) {
  return image.placement.leftCols<2>().inverse() * (place - image.placement.col(2));
}

bool can_be_inverted(const SurfaceTexture& image) {
  const double area = image.placement.leftCols<2>().determinant();
  return std::isfinite(area) && area != 0.0;
}

// True if the emission is the picture that surfaces of the material show.
bool shows_emission(const Material& material) {
  return material.emission_texture && material.is_emitter();
}

// The picture that is drawn, and its factor; a mask alone has none.
const SurfaceTexture& image_of(const Material& material) {
  if (shows_emission(material)) return material.emission_texture->image;
  return material.texture ? material.texture->image : material.mask->image;
}
std::optional<Spectrum> factor_of(const Material& material) {
  if (shows_emission(material)) return material.emission_texture->factor;
  if (material.texture) return material.texture->factor;
  return std::nullopt;
}

// Picture of a material's emission or else its texture, with the mask sampled at the texture's
// texels. Without a texture the picture is white with the mask's resolution.
DrawnPicture draw(const Material& material, int longest) {
  const SurfaceTexture& image = image_of(material);
  const std::optional<Spectrum> factor = factor_of(material);
  const Texture& picture = *image.picture;
  const int level = level_that_fits(picture, longest);
  DrawnPicture drawn{.width = picture.level_width(level),
                     .height = picture.level_height(level),
                     .is_smooth = image.is_smooth,
                     .wrap = image.wrap};
  constexpr float black = 1e-6f;
  Eigen::Array3f largest = Eigen::Array3f::Ones();
  if (factor) {
    largest = picture.largest().max(black);
    drawn.brightest = (factor->head<3>() * largest).max(black);
  } else {
    drawn.brightest = material.reflectance.head<3>().max(black);
  }
  drawn.has_holes = material.mask && can_be_inverted(image);
  drawn.rgba.reserve(std::size_t{4} * drawn.width * drawn.height);
  for (int y = 0; y < drawn.height; ++y) {
    for (int x = 0; x < drawn.width; ++x) {
      Eigen::Array3f share = Eigen::Array3f::Ones();
      if (factor) share = picture.texel(level, x, y) / largest;
      for (int c = 0; c < 3; ++c) {
        drawn.rgba.push_back(static_cast<std::uint8_t>(opaque * srgb_encode(share[c]) + 0.5f));
      }
      bool is_hole = false;
      if (drawn.has_holes) {
        const Eigen::Vector2d place((x + 0.5) / drawn.width, (y + 0.5) / drawn.height);
        const float cover = material.mask->image.at(uv_at(image, place))[0];
        is_hole = !(cover >= material.mask->cutoff);
      }
      drawn.rgba.push_back(is_hole ? 0 : opaque);
    }
  }
  return drawn;
}

// Means of drawn pictures of emission over each facet, W/m^2, facets x 3.
BandArray mean_emissions(const PatchMesh& mesh, const DrawnPictures& drawn) {
  if (!mesh.textures || !mesh.textures->has_emission()) return {};
  const int facets = 1 + *std::ranges::max_element(mesh.facet);
  BandArray power = BandArray::Zero(facets, 3);
  Eigen::ArrayXf area = Eigen::ArrayXf::Zero(facets);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int facet = mesh.facet[e];
    if (drawn.of(facet) < 0 || !mesh.textures->has_emission(facet)) continue;
    const auto weight = static_cast<float>(mesh.element_area[e]);
    power.row(facet) += weight * mean_emission(mesh, *mesh.textures, e).transpose();
    area[facet] += weight;
  }
  return power.colwise() / area.max(1e-30f);
}

}  // namespace

DrawnPictures::DrawnPictures(const Scene& scene, int longest) {
  if (scene.bands.count() != 3 || !scene.bands.wavelengths_nm.empty()) return;
  std::vector<int> picture_of_material(scene.materials.size(), -1);
  bool any = false;
  for (const Surface& surface : scene.surfaces) {
    const auto m = static_cast<std::size_t>(surface.material);
    const Material& material = scene.materials[m];
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    const bool has_picture =
        shows_emission(material) || (!material.is_emitter() && (material.texture || material.mask));
    if (!mesh || !has_picture) {
      facet_map_.insert(facet_map_.end(), mesh ? mesh->facets.size() : 1, -1);
      continue;
    }
    if (!mesh->uv_maps.empty() && picture_of_material[m] < 0) {
      picture_of_material[m] = static_cast<int>(pictures_.size());
      pictures_.push_back(draw(material, longest));
    }
    const SurfaceTexture& image = image_of(material);
    const int first = static_cast<int>(maps_.size());
    for (const UvMap& uv : mesh->uv_maps) {
      maps_.push_back(
          {.picture = picture_of_material[m],
           .gradient = image.placement.leftCols<2>() * uv.gradient,
           .offset = image.placement.leftCols<2>() * uv.offset + image.placement.col(2)});
    }
    for (const Facet& facet : mesh->facets) {
      facet_map_.push_back(facet.uv_map >= 0 ? first + facet.uv_map : -1);
      any = any || facet.uv_map >= 0;
    }
  }
  if (!any) facet_map_.clear();
}

int DrawnPictures::of(int facet) const {
  const auto f = static_cast<std::size_t>(facet);
  if (f >= facet_map_.size() || facet_map_[f] < 0) return -1;
  return maps_[static_cast<std::size_t>(facet_map_[f])].picture;
}

Eigen::Vector2f DrawnPictures::place(int facet, const Eigen::Vector3d& point) const {
  const Map& map = maps_[static_cast<std::size_t>(map_of(facet))];
  return (map.gradient * point + map.offset).cast<float>();
}

Eigen::Array<float, Eigen::Dynamic, 3, Eigen::RowMajor> picture_gains(const PatchMesh& mesh,
                                                                      const DrawnPictures& drawn) {
  Eigen::Array<float, Eigen::Dynamic, 3, Eigen::RowMajor> gain =
      Eigen::Array<float, Eigen::Dynamic, 3, Eigen::RowMajor>::Ones(mesh.vertex_count(), 3);
  if (drawn.all().empty()) return gain;
  const BandArray rho = vertex_reflectance(mesh), M = mean_emissions(mesh, drawn);
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int picture = drawn.of(mesh.facet[e]);
    if (picture < 0) continue;
    const Eigen::Array3f brightest = drawn.all()[static_cast<std::size_t>(picture)].brightest;
    const int facet = mesh.facet[e];
    const bool shines = mesh.textures && mesh.textures->has_emission(facet);
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      const int v = mesh.corners[e][c];
      for (int k = 0; k < 3; ++k) {
        const float mean = shines ? M(facet, k) : rho(v, k);
        if (mean > 0.0f) gain(v, k) = brightest[k] / mean;
      }
    }
  }
  return gain;
}

}  // namespace lightwell
