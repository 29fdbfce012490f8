#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene/rgb_basis.h"
#include "scene/scene.h"

namespace lightwell {

/// Values of a pattern's pictures at a place, or their means. A picture that is absent has the
/// value that SurfacePattern names.
struct PatternValues {
  Spectrum color{};  ///< of Material::texture's picture, per band; empty: white
  float roughness = 0.0f;
  float metal = 0.0f, coat = 1.0f, opacity = 1.0f, translucency = 1.0f;  ///< [0,1]
};

/// Values of the pictures of `material`, which has a pattern, at (u, v).
/// `basis`: of the scene's bands.
PatternValues values_at(const Material& material, const Eigen::Vector2d& uv,
                        const RgbBasis& basis = {});
/// Mean values about (u, v) over the parallelogram with sides `footprint` (see
/// SurfaceTexture::over).
PatternValues values_over(const Material& material, const Eigen::Vector2d& uv,
                          const Eigen::Matrix2d& footprint, const RgbBasis& basis = {});
/// Means over whole pictures.
PatternValues mean_values(const Material& material, const RgbBasis& basis = {});

/// The numbers of `material`, which has a pattern, where its pictures have `values`. The result has
/// shares, roughness, coat, metal and dielectric, and neither name nor emission nor pictures.
Material material_at(const Material& material, const PatternValues& values);

/// GGX alpha of a material that has a pattern at (u, v), as material_at() gives it for values_at().
float roughness_at(const Material& material, const Eigen::Vector2d& uv);

/// The pictures that a pattern has, in the order of its members.
std::vector<const ShareTexture*> pictures_of(const SurfacePattern& pattern);

/// Pattern without pictures that makes the material what it is: the numbers of its base, mirror and
/// coat where pictures of metal are black and all others white.
SurfacePattern pattern_of(const Material& material);

/// Gives a material a pattern, whose pictures have fixed roughness and shares. The material becomes
/// what it is at the means of the pictures, and so does the factor of its texture, by which viewers
/// draw it.
void set_pattern(Material& material, SurfacePattern pattern, const RgbBasis& basis = {});

}  // namespace lightwell
