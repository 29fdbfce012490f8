#pragma once

#include <span>
#include <vector>

#include "radiosity/direct_light/direct_light.h"
#include "radiosity/solvers/progressive.h"
#include "radiosity/visibility/point_form_factor.h"

namespace lightwell {

/// Light that reaches the vertices of elements while patches shoot, for a picture after every
/// round. Patches shoot, elements receive (Cohen, Greenberg, Immel & Brock 1986), at vertices
/// (Wallace, Elmquist & Haines 1989).
///   - Form factors are closed forms.
///   - Visibility is exact behind few occluders, otherwise by shadow rays: many for the emitters
///     that DirectLight owns, one for all others.
///   - Free sources are included from the start.
///   - Light through mirrors and glass is left to the patches.
///
/// Keeps references to caster and direct_light.
class VertexLight {
 public:
  /// Precondition: shots have the columns of `direct_light`. Reports "lamps" where there are free
  /// sources. Throws Interrupted when progress says stop.
  VertexLight(const ElementCaster& caster, const DirectLight& direct_light,
              const Progress& progress = {});

  /// Adds the irradiance that the shots bring to every vertex. Reports "shots". Throws Interrupted
  /// when progress says stop; irradiance() then has part of the shots.
  void receive(std::span<const ProgressiveRadiosity::Shot> shots, const Progress& progress = {});

  /// Irradiance so far: vertices x columns, W/m^2.
  const BandArray& irradiance() const { return irradiance_; }

 private:
  const PatchMesh& mesh_;
  const DirectLight& direct_light_;
  PointFormFactors form_factors_;
  std::vector<ReceivingPoint> points_;
  std::vector<double> F_;
  BandArray irradiance_;
};

}  // namespace lightwell
