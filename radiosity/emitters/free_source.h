#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>
#include <vector>

#include "scene/rays/ray_caster.h"
#include "scene/scene.h"
#include "scene/surface_point.h"

namespace lightwell {

struct ShadowSample;

/// A lamp as a source of rays.
struct LampLight {
  Lamp lamp{};
  /// m; rays begin and end at this distance, so that rounding does not let a ceiling hide the lamp
  /// that hangs from it.
  double clearance = 0.0;
};

/// The sun as a source of rays; FreeSource::light is its irradiance across the rays.
struct SunLight {
  Sun sun{};
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< of a ball about the scene
  double radius = 1.0;
};

/// The dome of the sky, whose light arrives from all around: SkyLight computes it at a point, and
/// rays that leave the scene through mirrors and glass read it. FreeSource::light are its factors.
/// Only is_distant() of the functions below takes the dome; the others return nothing for it.
struct DomeLight {};

/// A point of a surface that sends on diffuse light (Keller 1997, "Instant radiosity"). `light` of
/// the source is its flux, W: the intensity is light / pi times the cosine to the normal.
struct VirtualLight {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< unit
  int facet = -1;                                      ///< that holds the point
  /// Limit of cos cos' / r^2, 1/m^2, which grows without bound near the point.
  double most = 0.0;
};

/// A source without surface, for both passes: a kernel gives the irradiance of a point, and rays
/// carry the flux. A new kind of source is an alternative of `shape` with its cases in
/// free_source.cpp.
struct FreeSource {
  int number = 0;    ///< as free_source_count numbers them
  int channel = 0;   ///< of EmitterChannels
  Spectrum light{};  ///< factor of kernels and weights, scaled as relight() asks; for a lamp W/sr
  std::variant<LampLight, SunLight, DomeLight, VirtualLight> shape{};

  bool is_on() const { return (light > 0.0f).any(); }
  bool is_dome() const { return std::holds_alternative<DomeLight>(shape); }
  /// True for sky and sun: light that misses the scene was never part of its energy.
  bool is_distant() const { return is_dome() || std::holds_alternative<SunLight>(shape); }
};

/// The scene's free sources in order, scaled by `scale` (see PatchMesh::source_scale). `channel_of`
/// has a channel for each; empty: all in channel 0. Throws std::invalid_argument if `scale` has
/// another number of sources.
std::vector<FreeSource> free_sources(const Scene& scene, const BandArray& scale,
                                     const std::vector<int>& channel_of);

/// True if light arrives at a point from one direction only, so that one shadow ray suffices.
bool has_sharp_shadows(const FreeSource& source);

/// The kernel of E = light_towards() * kernel at an unobstructed point: shape(omega) cos / r^2 for
/// a point lamp; for an opening the mean over the opening, to about 1e-4 by Gauss's rule on parts
/// that are small against their distance.
double unoccluded_kernel(const FreeSource& source, const Eigen::Vector3d& point,
                         const Eigen::Vector3d& normal);

/// A shadow ray from a point to a sample point of the source, for (u, v) in [0,1)^2; its weight is
/// the kernel of that sample point.
ShadowSample shadow_sample(const FreeSource& source, const SurfacePoint& at, double u, double v);

/// A ray that leaves the source with `light * weight * color` watts, in the mean over its random
/// numbers.
struct SourceRay {
  Ray ray{};
  double weight = 0.0;
  Spectrum color{};  ///< empty: 1 in every band
};

/// The light that kernels and sample points of the source multiply at a point: FreeSource::light
/// times the colour that the source sends there.
Spectrum light_towards(const FreeSource& source, const Eigen::Vector3d& point);

/// A ray in proportion to all of the source's light; the mean weight is total_weight().
SourceRay source_ray(const FreeSource& source, const Eigen::Array4f& u);

/// A ray in proportion to the light that the source sends towards a sphere; empty if these random
/// numbers give none.
std::optional<SourceRay> source_ray_towards(const FreeSource& source, const Eigen::Vector3d& center,
                                            double radius, const Eigen::Array4f& u);

/// The flux of the source over mean_light(); for a lamp in sr.
double total_weight(const FreeSource& source);

/// FreeSource::light times the mean colour of the source.
Spectrum mean_light(const FreeSource& source);

/// Light that arrives from one sample point of a source, for reflection at a rough surface.
struct SourceSample {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit, towards the source
  double distance = 0.0;                                 ///< m, to the source
  double irradiance = 0.0;  ///< across the direction: light_towards() times this, W/m^2
};
SourceSample sample_source(const FreeSource& source, const Eigen::Vector3d& from, double u,
                           double v);

}  // namespace lightwell
