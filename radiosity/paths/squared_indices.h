#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "scene/scene.h"

namespace lightwell {

/// n_i^2 per patch: squared index of refraction of the clear body in front of the patch, relative
/// to the air around all bodies, as under water or within solid glass. Empty if no patch lies in a
/// body whose index differs from 1.
///
/// Walks from each patch decide: straight on through clear bodies, and on in a random direction
/// where something opaque is met before a clear body. A surface that a walk leaves without having
/// entered bounds a body around the patch; the indices of bodies within bodies multiply. The result
/// of most walks counts, since rays pass between the polygons of imperfect models.
Eigen::ArrayXd squared_indices(const Scene& scene, const ElementCaster& caster);

/// Materials of absorbing bodies in which patches lie, ascending, by the same walks. Light on its
/// way from patch to patch within such a body meets no surface of the body, and is not dimmed.
std::vector<int> absorbing_bodies_around(const Scene& scene, const ElementCaster& caster);

}  // namespace lightwell
