#pragma once

#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// Columns of picture_base_gains().
enum class BaseGain { of_indirect, of_dome };

/// Light of the mesh that coated bases get over the irradiance it makes, vertices x 2: of the
/// solution's indirect light, see indirect_base_gains(), and of the dome's, by rays to what each
/// vertex sees of the sky. 1 without a coat and without such light; empty if no surface has a coat.
BandArray picture_base_gains(const LitScene& lit, const RadiositySolution& solution);

}  // namespace lightwell
