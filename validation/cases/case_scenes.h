#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/direct_light.h"
#include "scene/scene.h"

namespace lightwell {

/// A grey, diffuse, two-sided material that emits from its front.
struct GreyPaint {
  float reflectance = 0.0f;
  float exitance = 0.0f;  ///< W/m^2 in every band
};

/// Adds a material; returns its index.
int add_paint(Scene& scene, const GreyPaint& paint);

void add_case_polygon(Scene& scene, const std::string& name, int material,
                      const std::vector<Eigen::Vector3d>& points);

/// A box with the faces x0 x1 y0 y1 z0 z1.
struct CaseBox {
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Ones();
  std::array<int, 6> materials{};
  bool inwards = true;  ///< the faces face the inside
};

/// The four corners of a face, counter-clockwise seen from the side that the face faces.
std::vector<Eigen::Vector3d> box_face(const CaseBox& box, int face);

/// Adds a surface for each face, named as the face.
void add_case_box(Scene& scene, const CaseBox& box);

inline constexpr std::array<const char*, 6> box_face_names = {"x0", "x1", "y0", "y1", "z0", "z1"};

/// The number of a face by its name. Throws std::invalid_argument for other names.
int box_face_number(const std::string& name);

/// A polygon with one hole; `hole` has the winding of the boundary.
void add_holed_polygon(Scene& scene, const std::string& name, int material,
                       const std::vector<Eigen::Vector3d>& points,
                       const std::vector<Eigen::Vector3d>& hole);

/// A scene with its mesh, rays and direct light.
class LitCase {
 public:
  explicit LitCase(Scene built, double max_patch_size = 0.0);
  LitCase(const LitCase&) = delete;
  LitCase& operator=(const LitCase&) = delete;

  /// Direct irradiance in the first band at a point on a surface or in the air, W/m^2. Where the
  /// scene has a sky, its dome gets the rays that bring the standard error to `sky_error` of the
  /// dome's light, 2^16 at most.
  double direct(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                double sky_error = 1e-3) const;

  const Scene scene;
  const PatchMesh mesh;
  const ElementCaster caster;
  const DirectLight direct_light;
};

}  // namespace lightwell
