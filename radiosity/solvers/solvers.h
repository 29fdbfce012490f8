#pragma once

#include "radiosity/solvers/solver_run.h"

namespace lightwell {

// One function per SolverMethod. Each iterates from run.start() until SolverRun::should_continue
// returns false, and returns B.

LightVector solve_by_jacobi(SolverRun& run);
LightVector solve_by_gauss_seidel(SolverRun& run);
LightVector solve_by_sor(SolverRun& run);
LightVector solve_by_southwell(SolverRun& run);
LightVector solve_by_conjugate_gradients(SolverRun& run);
LightVector solve_by_bicgstab(SolverRun& run);
LightVector solve_by_gmres(SolverRun& run);

}  // namespace lightwell
