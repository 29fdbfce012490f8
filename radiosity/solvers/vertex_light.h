#pragma once

#include <span>
#include <vector>

#include "radiosity/emitters/direct_light.h"
#include "radiosity/solvers/progressive.h"
#include "radiosity/visibility/point_form_factor.h"

namespace lightwell {

/// Light that reaches the vertices of elements while patches shoot (patches shoot, elements
/// receive: Cohen, Greenberg, Immel & Brock 1986; at vertices: Wallace, Elmquist & Haines 1989), so
/// that a picture can be shown after every round. Form factors are closed forms, visibility exact
/// where little stands between and else by shadow rays: many for the emitters that DirectLight
/// owns, one for all others. Free sources are there from the start. Light by way of mirrors and
/// glass is left to the patches. Keeps references to caster and direct_light.
class VertexLight {
 public:
  /// The shots have the columns of `direct_light`.
  VertexLight(const ElementCaster& caster, const DirectLight& direct_light);

  void receive(std::span<const ProgressiveRadiosity::Shot> shots);

  /// vertices x columns, W/m^2.
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
