#pragma once

#include "mesh/patches/patch_outline.h"

namespace lightwell {

/// Exchange area S = A_1 F_12 = A_2 F_21 of two unoccluded polygons, square metres, >= 0. Each
/// polygon is clipped to the half-space before the other's plane. Then
///
///   S = 1/(2 pi) sum over edges p of 1, q of 2 of  (p . q) / (|p| |q|)  int int ln r ds dt
///
/// (double contour integral, Sparrow 1963; Schroeder & Hanrahan 1993). The inner integral is in
/// closed form. The outer integral is by quadrature, of an order that follows the distance of the
/// edges: Gauss-Legendre for distant edges, double-exponential (Takahasi & Mori 1974) for touching
/// edges. Relative error about 1e-9, and 1e-9 of the smaller area; 0 for polygons that do not face
/// each other.
double polygon_exchange(const PatchOutline& first, const PatchOutline& second);

}  // namespace lightwell
