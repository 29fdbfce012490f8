#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <variant>

#include "scene/bands.h"
#include "scene/photometric_web.h"

namespace lightwell {

class ProjectedPicture;

/// The same intensity in all directions.
struct EvenIntensity {};

/// A cone of light about the lamp's axis: full intensity up to `inner`, none from `outer` on.
struct SpotCone {
  /// Intensity between the two angles. smooth: ((cos - cos outer) / (cos inner - cos outer))^2
  /// (KHR_lights_punctual). straight: linear in the angle (Mitsuba).
  enum class Edge { smooth, straight };
  double inner = 0.0;  ///< radians from the axis, 0 <= inner <= outer
  double outer = 0.0;  ///< 0 < outer <= pi
  Edge edge = Edge::smooth;
};

/// A measured distribution, shared by all lamps of one kind. Never null in a scene.
using SharedWeb = std::shared_ptr<const PhotometricWeb>;

/// A picture that lamps project; of lamps without opening. Never null in a scene.
using SharedPicture = std::shared_ptr<const ProjectedPicture>;

using IntensityShape = std::variant<EvenIntensity, SpotCone, SharedWeb, SharedPicture>;

/// Luminous opening of a lamp: a rectangle or an ellipse about the lamp's position, across its
/// axis. Every point of the opening emits the same share of the intensity, whatever the direction.
/// 0 x 0 is a point.
struct LampOpening {
  double along_c0 = 0.0, along_c90 = 0.0;  ///< m, the full sizes
  bool is_round = false;

  bool is_point() const { return !(along_c0 > 0.0 || along_c90 > 0.0); }
};

/// Housing of a lamp, for the eye alone: light neither meets it nor leaves it. A box, or a cylinder
/// about the axis, as lamp_faces() places it. 0 high: unknown.
struct LampBody {
  double along_c0 = 0.0, along_c90 = 0.0, height = 0.0;  ///< m
  bool is_round = false;

  bool is_known() const { return along_c0 > 0.0 && along_c90 > 0.0 && height > 0.0; }
};

/// A light source that is no surface: rays of light do not meet a lamp. Pictures show the opening
/// of a lamp. The intensity in a direction is `intensity` times relative_intensity().
struct Lamp {
  std::string name{};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, the middle of the opening
  /// Rotation whose columns are the directions of C0, of C90 and of the zenith (gamma = 180) in the
  /// scene. A spot's axis is gamma = 0, opposite to the last column.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  /// W/sr, >= 0; with a web, W/sr for each unit of its values; with a picture, on the axis through
  /// white.
  Spectrum intensity{};
  IntensityShape shape{};
  LampOpening opening{};
  LampBody body{};
  bool visible = true;  ///< pictures show the opening

  Eigen::Vector3d aim() const { return -axes.col(2); }
};

/// Axes whose gamma = 0 points along `aim` and whose C0 is `c0` made perpendicular to `aim`. Where
/// `c0` is parallel to `aim` or has no length, C0 is taken from +x, or from +z if the lamp is aimed
/// along x.
Eigen::Matrix3d lamp_axes(const Eigen::Vector3d& aim,
                          const Eigen::Vector3d& c0 = Eigen::Vector3d::Zero());

/// Value of the lamp's shape in a unit direction of the scene, at `distance` metres from the lamp:
/// intensity over `intensity`, mean of red, green and blue.
double relative_intensity(const Lamp& lamp, const Eigen::Vector3d& direction,
                          double distance = std::numeric_limits<double>::infinity());

/// Colour of the light that leaves in a direction: the intensity of a band is `intensity` times
/// relative_intensity() times the colour. Empty: 1 in every band.
Spectrum relative_color(const Lamp& lamp, const Eigen::Vector3d& direction,
                        double distance = std::numeric_limits<double>::infinity());

/// Mean of relative_color() over all light of the lamp. Empty: 1 in every band.
Spectrum mean_color(const Lamp& lamp);

/// `light` times a colour, of which an empty one is 1 in every band.
inline Spectrum with_color(const Spectrum& light, const Spectrum& color) {
  return color.size() > 0 ? Spectrum(light * color) : light;
}

/// Integral of relative_intensity() over all directions, sr. Flux is `intensity` times the
/// integral.
double relative_flux(const Lamp& lamp);

/// Flux of a lamp, W per band.
Spectrum lamp_flux(const Lamp& lamp);

/// A ray that leaves a lamp. The ray carries `intensity` times weight times colour, in the mean
/// over its random numbers.
struct LampRay {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< m
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
  double weight = 0.0;                                   ///< sr
  Spectrum color{};                                      ///< empty: 1 in every band
};

/// A ray in proportion to all of the lamp's light, from numbers in [0,1): two for its direction and
/// two for its origin. The density of directions follows the values of a web or a picture; it is
/// even over cones and even lamps.
LampRay draw_ray(const Lamp& lamp, const Eigen::Array4f& u);

/// Random origin of rays, m, as draw_ray() has it for the last two of its numbers.
Eigen::Vector3d ray_origin(const Lamp& lamp, double u, double v);

/// The ray from a ray_origin() in a unit direction that stands for `solid_angle`, sr.
LampRay ray_along(const Lamp& lamp, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                  double solid_angle);

/// Uniform random point of the opening, metres, from numbers `u`, `v` in [0,1).
Eigen::Vector3d opening_point(const Lamp& lamp, double u, double v);

}  // namespace lightwell
