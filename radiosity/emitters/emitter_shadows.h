#pragma once

#include "radiosity/emitters/emission_tree.h"
#include "radiosity/emitters/emitter.h"
#include "radiosity/emitters/solid_angle_sampler.h"
#include "radiosity/visibility/shadow_rays.h"
#include "scene/surface_point.h"

namespace lightwell {

/// A shadow ray from a point to a sample point of an emitter, for (u, v) in [0,1)^2, with the
/// weight of the sample's kernel. Samples are uniform
/// - over the cone of a sphere,
/// - in solid angle over a polygon that `sampler` holds, else in area.
///
/// `view`: of an emitter that shines by a picture, for samples that weigh its light; null: for
/// samples of the emitter's form factor.
ShadowSample emitter_shadow_sample(const Emitter& emitter, const SolidAngleSampler& sampler,
                                   const SurfacePoint& at, double u, double v,
                                   const EmissionTree::View* view = nullptr);

/// The mean weight of the samples of an emitter whose form factor from `point` is F: pi F over the
/// solid angle or the area that samples are uniform in. Samples are not those of a picture.
double expected_emitter_weight(const Emitter& emitter, const SolidAngleSampler& sampler,
                               const Eigen::Vector3d& point, double F);

}  // namespace lightwell
