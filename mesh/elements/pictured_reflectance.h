#pragma once

#include "mesh/elements/element_caster.h"
#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Reflectance where rays end on surfaces whose reflectance varies by a picture. The radiosity of
/// vertices, B = rho E, has the mean rho of the patches around them, so near a surface B is that of
/// a blurred picture. Keeps a reference to the mesh.
class PicturedReflectance {
 public:
  explicit PicturedReflectance(const PatchMesh& mesh);

  /// True if the light of an element is rho E alone, with a rho that varies over its surface.
  bool varies(int element) const;
  /// True if the light of an element is rho E and what its sheet passes, with a rho that varies.
  bool varies_on_sheet(int element) const;
  /// Factor, per band, of the light rho E interpolated at a hit on an element that varies, for a
  /// ray that stands for `solid_angle`, sr: the mean rho over what the ray covers there, over the
  /// rho in the interpolated light. A ray that covers a quarter of a patch or more has the mean
  /// over the patch. So has every ray that ends on a pattern, since paths pass or mirror the rest
  /// of the light by the patch's mean.
  Spectrum factor(const Ray& ray, const ElementHit& hit, double solid_angle) const;

 private:
  bool is_pictured(int element) const;
  Spectrum reflectance(const Ray& ray, const ElementHit& hit, double solid_angle) const;

  const PatchMesh& mesh_;
  BandArray at_vertices_{};  // empty: no reflectance varies
};

}  // namespace lightwell
