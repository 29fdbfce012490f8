#pragma once

#include <Eigen/Core>

#include "mesh/elements/element_caster.h"
#include "scene/scene.h"

namespace lightwell {

/// n_i^2 per patch: squared index of refraction of the clear body in front of the patch, relative
/// to the air around all bodies, as under water or within solid glass (see MediumWalks). Empty if
/// no patch lies in a body whose index differs from 1.
Eigen::ArrayXd squared_indices(const Scene& scene, const ElementCaster& caster);

}  // namespace lightwell
