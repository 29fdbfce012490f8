#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// A grey picture, rows from the top.
inline SurfaceTexture picture_of(int width, int height, const std::vector<float>& shares) {
  std::vector<Texture::Code> texels;
  for (const float share : shares) texels.push_back(Texture::encode(share));
  return {.picture = std::make_shared<const Texture>(width, height, 1, std::move(texels)),
          .is_smooth = false};
}

/// Lays texture coordinates over a surface's one polygon: u along its first edge and v across, both
/// from 0 to 1 over the bounds of a rectangle.
inline void lay_uv(Surface& surface) {
  auto& mesh = std::get<PolygonMesh>(surface.shape);
  const std::vector<int>& loop = mesh.facets.at(0).boundary;
  const Eigen::Vector3d from = mesh.vertices[static_cast<std::size_t>(loop[0])];
  const Eigen::Vector3d u = mesh.vertices[static_cast<std::size_t>(loop[1])] - from;
  const Eigen::Vector3d v = mesh.vertices[static_cast<std::size_t>(loop.back())] - from;
  UvMap map;
  map.gradient << u.transpose() / u.squaredNorm(), v.transpose() / v.squaredNorm();
  map.offset = -map.gradient * from;
  mesh.uv_maps = {map};
  mesh.facets[0].uv_map = 0;
}

/// Gives a surface of one polygon a material of its own that shows a picture.
inline void put_picture(Scene& scene, std::size_t surface, const SurfaceTexture& picture) {
  Material material = scene.materials[static_cast<std::size_t>(scene.surfaces[surface].material)];
  const Spectrum ones = Spectrum::Ones(scene.bands.count());
  material.name += " with a picture";
  material.texture = {.image = picture, .factor = ones};
  const Eigen::Array3f mean = picture.picture->mean();
  for (int c = 0; c < 3; ++c) material.reflectance[c] = mean[c];
  scene.surfaces[surface].material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(std::move(material));
  lay_uv(scene.surfaces[surface]);
}

/// The same for holes: where the picture is below a half.
inline void put_mask(Scene& scene, std::size_t surface, const SurfaceTexture& picture) {
  Material material = scene.materials[static_cast<std::size_t>(scene.surfaces[surface].material)];
  material.name += " with holes";
  material.mask = Mask{.image = picture};
  scene.surfaces[surface].material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(std::move(material));
  lay_uv(scene.surfaces[surface]);
}

/// A picture of colours, rows from the top.
inline SurfaceTexture coloured_picture(int width, int height,
                                       const std::vector<Eigen::Array3f>& colours) {
  std::vector<Texture::Code> texels;
  for (const Eigen::Array3f& colour : colours) {
    for (const float share : colour) texels.push_back(Texture::encode(share));
  }
  return {.picture = std::make_shared<const Texture>(width, height, 3, std::move(texels)),
          .is_smooth = false};
}

/// Gives a surface of one polygon a material of its own that shines by `factor` times a picture.
inline void put_light(Scene& scene, std::size_t surface, const SurfaceTexture& picture,
                      float factor = 1.0f) {
  Material material = scene.materials[static_cast<std::size_t>(scene.surfaces[surface].material)];
  material.name += " with a picture of light";
  material.emission_texture =
      EmissionTexture{.image = picture, .factor = constant_spectrum(scene.bands, factor)};
  material.emission = factor * picture.picture->mean();
  scene.surfaces[surface].material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(std::move(material));
  lay_uv(scene.surfaces[surface]);
}

}  // namespace lightwell
