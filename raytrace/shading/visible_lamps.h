#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "radiosity/direct_light/direct_light.h"
#include "radiosity/solution/solution.h"
#include "raytrace/shading/drawn_lamps.h"
#include "scene/rays/ray_caster.h"
#include "scene/scene.h"

namespace lightwell {

/// Luminaires as an eye sees them: the bodies of DrawnLamps, and the openings before them. Lamps
/// are no surfaces: rays of the first pass do not meet them, their light is direct light, and
/// neither opening nor body blocks light. In a picture the opening of a lamp is a flat face of even
/// luminance, I over its area projected towards the eye, from either side, as for UGR. An opening
/// that sends no light towards the eye is not seen. Bodies have the radiance of DrawnLamps.
class VisibleLamps {
 public:
  /// No lamps.
  VisibleLamps() = default;
  /// The lamps of a scene that are `visible`, as bright as in `direct_light`; an opening is seen if
  /// it has an area. Bodies reflect the light of the solution, whose mesh is the caster's. Keeps a
  /// reference to the scene.
  VisibleLamps(const Scene& scene, const ElementCaster& caster, const DirectLight& direct_light,
               const RadiositySolution& solution);

  bool empty() const { return !openings_ && !bodies_; }

  struct Seen {
    int lamp = 0;          ///< index into Scene::lamps
    int face = 0;          ///< number, different for each opening and body face
    bool is_body = false;  ///< else an opening
    double t = 0.0;        ///< m along the ray
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of the face, towards the ray's origin
    Spectrum radiance{};                                ///< towards the ray's origin, W/(m^2 sr)
  };
  /// The first face along a ray before `end`, m, the distance of the first surface: an opening in
  /// the plane of that surface or of its body is seen (see way_before_opening). The ray's direction
  /// has unit length.
  std::optional<Seen> first(const Ray& ray, double end) const;
  /// The first face of a body along a ray before `end`, m. The ray's direction has unit length.
  std::optional<Seen> first_body(const Ray& ray, double end) const;

 private:
  struct Face {
    int lamp = 0;
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    Spectrum radiance{};  ///< of a body
  };
  /// The first opening before `end`, m, that sends light towards the ray's origin.
  std::optional<Seen> first_opening(const Ray& ray, double end) const;
  static Seen seen(const Face& face, std::size_t number, const Ray& ray, double t);

  const Scene* scene_ = nullptr;
  std::vector<Spectrum> intensity_{};  ///< W/sr for relative_intensity() 1, per lamp of the scene
  std::vector<Face> opening_{}, body_{};         ///< of each group of the casters
  std::unique_ptr<const RayCaster> openings_{};  ///< null: no opening is seen
  std::unique_ptr<const RayCaster> bodies_{};    ///< null: no body is seen
};

}  // namespace lightwell
