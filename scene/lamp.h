#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>

#include "scene/bands.h"
#include "scene/photometric_web.h"

namespace lightwell {

/// The same intensity in all directions.
struct EvenIntensity {};

/// A cone of light about the lamp's axis: full intensity up to `inner`, none from `outer` on.
struct SpotCone {
  /// Between the two: ((cos - cos outer) / (cos inner - cos outer))^2 (KHR_lights_punctual), or
  /// straight in the angle (Mitsuba).
  enum class Edge { smooth, straight };
  double inner = 0.0;  ///< radians from the axis, 0 <= inner <= outer
  double outer = 0.0;  ///< 0 < outer <= pi
  Edge edge = Edge::smooth;
};

/// Measured; shared by all lamps of one kind. Never null in a scene.
using SharedWeb = std::shared_ptr<const PhotometricWeb>;

using IntensityShape = std::variant<EvenIntensity, SpotCone, SharedWeb>;

/// Where the light of a lamp comes out: a rectangle or an ellipse about its position, across its
/// axis. Every point of it gives the same share of the intensity, whatever the direction. 0 x 0 is
/// a point.
struct LampOpening {
  double along_c0 = 0.0, along_c90 = 0.0;  ///< m, the full sizes
  bool is_round = false;

  bool is_point() const { return !(along_c0 > 0.0 || along_c90 > 0.0); }
};

/// A source of light that is no surface: rays do not meet it, and it is not seen in pictures. Its
/// intensity in a direction is `intensity` times what `shape` says of that direction.
struct Lamp {
  std::string name{};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, the middle of the opening
  /// Columns are the directions of C0, C90 and of the zenith (gamma = 180) in the scene: a
  /// rotation. The axis of a spot is that of gamma = 0, opposite to the last.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Spectrum intensity{};  ///< W/sr, >= 0; with a web, W/sr for each unit of its values
  IntensityShape shape{};
  LampOpening opening{};

  Eigen::Vector3d aim() const { return -axes.col(2); }
};

/// Axes whose gamma = 0 points along `aim` and whose C0 is `c0` made perpendicular to it; where
/// `c0` is along `aim`, or has no length, +x is taken instead, or +z if the lamp is aimed along x.
Eigen::Matrix3d lamp_axes(const Eigen::Vector3d& aim,
                          const Eigen::Vector3d& c0 = Eigen::Vector3d::Zero());

/// What the shape says of a unit direction of the scene: I over `intensity`.
double relative_intensity(const Lamp& lamp, const Eigen::Vector3d& direction);

/// Its integral over all directions, sr: flux is `intensity` times this.
double relative_flux(const Lamp& lamp);

/// Flux, W per band.
Spectrum lamp_flux(const Lamp& lamp);

/// A direction of the scene with a density that follows the intensity, by two numbers in [0,1).
DrawnDirection draw_direction(const Lamp& lamp, double u, double v);

/// A place of the opening, evenly spread over it, by two numbers in [0,1).
Eigen::Vector3d opening_point(const Lamp& lamp, double u, double v);

}  // namespace lightwell
