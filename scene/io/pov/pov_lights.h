#pragma once

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/io/numbered_names.h"
#include "scene/io/pov/pov_value.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

struct PovLight;

/// Light sources as lamps of a scene, and parallel light as its sun.
///
/// A light of colour c gives a surface that faces it the irradiance E = pi c, so that a white
/// surface has the radiance c. A light that fades by the square of the distance has the intensity
/// I = 2 pi c d^2 of its fade_distance d, which is its own law far from the light. Other lights
/// would not fade at all: they get the intensity that gives E at the distance of one point.
class PovLights {
 public:
  /// Adds a block light_source. Throws InputError for a light without place or colour.
  void add(const PovNode& node, const Eigen::Affine3d& to_world, const std::string& name,
           double gamma, Scene& scene, Remarks& remarks);
  /// Sets the intensity of the lights that do not fade, for the point at which they aim, or
  /// `middle` if they do not aim.
  void finish(const Eigen::Vector3d& middle, Scene& scene) const;

 private:
  struct Unfading {
    std::size_t lamp = 0;
    std::optional<Eigen::Vector3d> aimed_at{};
  };
  void set_beam(const PovLight& light, double distance, const PovNode& node, Lamp& lamp,
                Remarks& remarks);

  NumberedNames names_{};
  std::map<std::array<double, 3>, SharedWeb> beams_{};  // by radius, falloff and tightness
  std::vector<Unfading> unfading_{};
};

}  // namespace lightwell
