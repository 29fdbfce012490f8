#pragma once

#include "mesh/patches/patch_outline.h"

namespace lightwell {

/// Exchange area S = A_1 F_12 = A_2 F_21 of two unoccluded polygons, square metres, >= 0. Each is
/// clipped to what lies before the other's plane; then
///
///   S = 1/(2 pi) sum over edges p of 1, q of 2 of  (p . q) / (|p| |q|)  int int ln r ds dt
///
/// (double contour integral, Sparrow 1963; Schroeder & Hanrahan 1993). The inner integral is in
/// closed form. The outer one is by quadrature whose order follows the distance of the edges: Gauss
/// and Legendre's far off, double-exponential (Takahasi & Mori 1974) where edges touch. Relative
/// error about 1e-9, and 1e-9 of the smaller area; 0 for polygons that do not face each other.
double polygon_exchange(const PatchOutline& first, const PatchOutline& second);

}  // namespace lightwell
