#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "viewer/window/visible_hits.h"

namespace lightwell {

class JoinedSurfaces;

/// Light and material at a point of a solved scene.
struct PointReading {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< unit, on the side that was hit
  Spectrum irradiance{};                               ///< W/m^2 per band, interpolated on the mesh
  Spectrum reflectance{};  ///< rho per band; with a texture that of the texel
  double lux = 0.0;
  double lux_within = -1.0;  ///< bound of the error of `lux`, odds of 19 to 1; < 0: not known
  double luminance = 0.0;    ///< cd/m^2 of the diffuse light, emission included
  std::string surface{}, material{};
  int patch = 0, element = 0;
};

/// Reads the point that a ray of sight hit, interpolated as `lightwell probe --interpolate` does.
/// - `irradiance`: W/m^2, vertices x bands.
/// - `scene`: gives names to surface and material; null: numbers instead.
/// - `names`: surfaces of polygons that several surfaces share; null: there are none.
PointReading read_point(const PatchMesh& mesh, const Bands& bands, const BandArray& irradiance,
                        const Scene* scene, const VisibleHit& seen,
                        const JoinedSurfaces* names = nullptr);

/// Units in which numbers of a scene are shown.
struct ShownUnits {
  double metres_per_unit = 1.0;
  std::string unit_name = "m";
  bool relative = false;  ///< light has no known unit
};

/// The whole reading, a line for each quantity. Lengths are in `units`.
std::string full_text(const PointReading& reading, const Bands& bands, const ShownUnits& units);
/// Illuminance, luminance and surface, on two lines that fit beside a cursor.
std::string short_text(const PointReading& reading, const ShownUnits& units);

}  // namespace lightwell
