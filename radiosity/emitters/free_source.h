#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>
#include <vector>

#include "radiosity/visibility/shadow_rays.h"
#include "scene/scene.h"
#include "scene/surface_point.h"

namespace lightwell {

/// A lamp as rays see it.
struct LampLight {
  Lamp lamp{};
  /// m: rays begin and end this far from the lamp, so that one that hangs at a ceiling is not
  /// hidden by it through rounding.
  double clearance = 0.0;
};

/// The sun as rays see it; `light` is its irradiance across the rays.
struct SunLight {
  Sun sun{};
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of a ball about the scene
  double radius = 1.0;
};

/// The dome of the sky. Its light comes from all around, so that SkyLight finds it for a point, and
/// rays that leave the scene find it by way of mirrors and glass; `light` are factors of it, and of
/// what is declared below only is_distant() speaks of it: the others give nothing.
struct DomeLight {};

/// Light of a source that is no surface, as the solve and both passes take it: a kernel says what
/// reaches a point, rays say where it goes. To add a kind of source, add an alternative of `shape`
/// and its cases in free_source.cpp.
struct FreeSource {
  int number = 0;    ///< as free_source_count numbers them
  int channel = 0;   ///< whose light this is
  Spectrum light{};  ///< in force, what kernels and weights are multiplied with; of a lamp W/sr
  std::variant<LampLight, SunLight, DomeLight> shape{};

  bool is_on() const { return (light > 0.0f).any(); }
  bool is_dome() const { return std::holds_alternative<DomeLight>(shape); }
  /// Beyond the scene: what misses it never belonged to it.
  bool is_distant() const { return !std::holds_alternative<LampLight>(shape); }
};

/// The scene's free sources in order, with the factors `scale` (see PatchMesh::source_scale) in
/// force. `channel_of` has a channel for each, or is empty: all in channel 0. Throws
/// std::invalid_argument if there are factors for another number of sources.
std::vector<FreeSource> free_sources(const Scene& scene, const BandArray& scale,
                                     const std::vector<int>& channel_of);

/// Whether its light comes to a point from one direction only, so that one shadow ray tells all.
bool has_sharp_shadows(const FreeSource& source);

/// E = light * kernel at a point with nothing in the way. Of a point lamp, shape(omega) cos / r^2;
/// of an opening the mean of that over it, to about 1e-4 by Gauss's rule on parts that are small
/// against their distance.
double unoccluded_kernel(const FreeSource& source, const Eigen::Vector3d& point,
                         const Eigen::Vector3d& normal);

/// A ray from the point to a place of the source, by two numbers in [0,1); its weight is the kernel
/// of that place alone.
ShadowSample shadow_sample(const FreeSource& source, const SurfacePoint& at, double u, double v);

/// A ray that the source sends out: it carries `light * weight` watts, in the mean over all
/// numbers.
struct SourceRay {
  Ray ray{};
  double weight = 0.0;
};

/// Over all its light: the mean weight is total_weight().
SourceRay source_ray(const FreeSource& source, const Eigen::Array4f& u);

/// Over the light it sends at a ball. Nothing where that draw would send none.
std::optional<SourceRay> source_ray_towards(const FreeSource& source, const Eigen::Vector3d& center,
                                            double radius, const Eigen::Array4f& u);

/// Flux of the source is `light` times this; of a lamp it is in sr.
double total_weight(const FreeSource& source);

/// Light that comes to a place from one direction of a source, as a rough surface reflects it.
struct SourceSample {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit, towards the source
  double distance = 0.0;                                 ///< m that must be clear
  double irradiance = 0.0;  ///< across the direction: `light` times this, W/m^2
};
SourceSample sample_source(const FreeSource& source, const Eigen::Vector3d& from, double u,
                           double v);

}  // namespace lightwell
