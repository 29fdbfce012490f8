#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "viewer/window/visible_hits.h"

namespace lightwell {

class JoinedSurfaces;

/// What there is to know of a point of a solved scene.
struct PointReading {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< unit, on the side that was met
  Spectrum irradiance{};                               ///< W/m^2 per band, by the mesh
  Spectrum reflectance{};  ///< rho there; of a picture that of the texel
  double lux = 0.0;
  double luminance = 0.0;  ///< cd/m^2 of the diffuse light, emission included
  std::string surface{}, material{};
  int patch = 0, element = 0;
};

/// Interpolates as `lightwell probe --interpolate` does. `irradiance` is vertices x bands. Without
/// a scene surface and material go by their numbers; `names` are of the scene's polygons that
/// several surfaces share (null: there are none).
PointReading read_point(const PatchMesh& mesh, const Bands& bands, const BandArray& irradiance,
                        const Scene* scene, const VisibleHit& seen,
                        const JoinedSurfaces* names = nullptr);

/// How the numbers of a scene are shown to people.
struct ShownUnits {
  double metres_per_unit = 1.0;
  std::string unit_name = "m";
  bool relative = false;  ///< light is in no known unit
};

/// All of it, a line each.
std::string full_text(const PointReading& reading, const Bands& bands, const ShownUnits& units);
/// Lux and the surface: what fits beside a cursor.
std::string short_text(const PointReading& reading, const ShownUnits& units);

}  // namespace lightwell
