#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/light_list.h"
#include "radiosity/many_lights/light_choice.h"
#include "radiosity/visibility/shadow_rays.h"
#include "scene/surface_point.h"

namespace lightwell {

/// The light of a member of a cluster, by one of its points and one shadow ray: chance has drawn
/// the member, so that a closed form would be more exact than the sum it is a term of.
struct MemberLight {
  int light = 0;    ///< of LightList
  int cluster = 0;  ///< see LightSample
  /// Form factor by the point's kernel, or the kernel of a source, unobstructed, over the chance.
  double F = 0.0;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< towards the point, any length
  std::uint8_t blocked = 0;                              ///< 1: not all light arrives
  Spectrum passed{};  ///< transmittance of a way that panes or a body dim; empty: none

  /// The share that arrives, mean of the bands.
  double arriving() const {
    if (blocked == 0) return 1.0;
    return passed.size() > 0 ? static_cast<double>(passed.mean()) : 0.0;
  }
};

/// True if a drawn light is asked as a MemberLight. The light of a picture is not: it differs from
/// point to point.
bool is_member(const LightSample& sample, const LightList& lights);

/// The members that may give a point light.
std::vector<MemberLight> member_lights(std::span<const LightSample> members,
                                       const LightList& lights, const ElementCaster& caster,
                                       const SurfacePoint& at, std::uint64_t key,
                                       const ShadowMedium& medium);

}  // namespace lightwell
