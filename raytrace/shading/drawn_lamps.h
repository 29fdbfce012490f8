#pragma once

#include <string>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "scene/lamp_faces.h"
#include "scene/scene.h"

namespace lightwell {

/// The luminaires of a scene as pictures, the window, pages and models draw them: the faces of the
/// lamps that are `visible`. Openings have their mean radiance to all sides, but in pictures their
/// radiance towards the eye (see VisibleLamps). The body of a luminaire reflects half of the light
/// that surfaces send to it, and ends at the surface that it is let into.
class DrawnLamps {
 public:
  /// Diffuse reflectance of bodies in all bands.
  static constexpr float body_reflectance = 0.5f;

  struct Face {
    int lamp = 0;                            ///< index into Scene::lamps
    std::vector<Eigen::Vector3d> outline{};  ///< see LampFace
    bool shines = false;                     ///< of an opening
    Spectrum emitted{};                      ///< of an opening, W/(m^2 sr) as the scene has it
    double place = 0.0;                      ///< of an opening, see LampFace
    std::vector<ElementHit> seen{};          ///< by rays from a face of the body
  };

  DrawnLamps() = default;
  /// Keeps no reference.
  DrawnLamps(const Scene& scene, const ElementCaster& caster);

  const std::vector<Face>& faces() const { return faces_; }

  /// Radiance of each face, W/(m^2 sr), faces x bands, for that of the vertices of `mesh` (see
  /// shown_radiance) and factors of sources (PatchMesh::source_scale; empty: 1). Faces of bodies
  /// without light have 0.
  BandArray radiance(const PatchMesh& mesh, const BandArray& vertex_radiance,
                     const BandArray& source_scale) const;

 private:
  std::vector<Face> faces_{};
};

}  // namespace lightwell
