#pragma once

#include "radiosity/solve.h"

namespace lightwell {

/// Form-factor rays per patch that solve_scene uses: the given number, or fewer for a loose
/// accuracy (see form_factor_rays).
int rays_per_patch(const SolveOptions& options);
/// Number of patches that solve_scene aims at: the given number, or fewer for a loose accuracy (see
/// patch_count_for).
int auto_patch_count(const SolveOptions& options);

}  // namespace lightwell
