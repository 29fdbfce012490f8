#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/io/radiance/radiance_materials.h"
#include "scene/io/radiance/text/radiance_primitive.h"
#include "scene/scene.h"

namespace lightwell {

/// Luminous surfaces of a RADIANCE scene whose radiance depends on direction, which become lamps: a
/// luminaire with the distribution of an IES file (brightdata), a spotlight, a window that an illum
/// stands for.
class RadianceLamps {
 public:
  explicit RadianceLamps(Scene& scene) : scene_(scene) {}

  /// Adds a lamp for a polygon, ring, sphere, bubble or cylinder whose light depends on direction;
  /// false for other shapes and for light that is the same in all directions. Throws InputError for
  /// arguments that are missing or out of range.
  bool add(const RadiancePrimitive& surface, const RadianceLight& light);
  /// Removes the lamps of illums, which stand for light from outside.
  void remove_illums();

 private:
  // A luminous surface, as a lamp sees it.
  struct Face {
    enum class Shape { plane, sphere, cylinder };
    Shape shape = Shape::plane;
    Eigen::Vector3d middle, aim, along;  // aim: the normal, or an axis
    double area = 0.0;                   // m^2; of spheres and cylinders, the largest outline
    LampOpening opening{};               // across `aim`

    // The part of `area` that is seen from a unit direction, [0,1]; with the sign of the side.
    double seen_from(const Eigen::Vector3d& direction) const;
  };
  static std::optional<Face> face_of(const RadiancePrimitive& surface);
  SharedWeb web_of(const RadianceLight& light, const Face& face, const Eigen::Matrix3d& axes);

  // A distribution, in the frame of its lamp, that lamps of one kind share.
  struct Known {
    std::string light{};  // what decides the light but its colour
    SharedWeb web{};
  };

  Scene& scene_;
  std::vector<Known> known_;
  std::vector<std::size_t> illums_;  // indices of lamps
  NumberedNames names_;
};

}  // namespace lightwell
