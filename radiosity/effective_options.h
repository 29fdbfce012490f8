#pragma once

#include "radiosity/solve.h"

namespace lightwell {

/// What solve_scene takes of options: as asked for, or less for a loose accuracy (see
/// form_factor_rays and patch_count_for).
int rays_per_patch(const SolveOptions& options);
int auto_patch_count(const SolveOptions& options);

}  // namespace lightwell
