#pragma once

#include <optional>

#include "radiosity/visibility/shaft.h"

namespace lightwell {

/// More convex pieces between two patches are left to rays, which are quicker then.
inline constexpr std::size_t most_pieces_between = 16;

struct VisibleExchange {
  double value = 0.0;  ///< S_ij, m^2
  double error = 0.0;  ///< estimated, m^2; above the tolerance where the work ran out
};

/// Exchange area S = A_i F_ij of two polygons with others between them,
///
///   S = S_unoccluded - int_{A_i} F_hidden(x) dA,
///
/// F_hidden exact (ShadowedPolygon) and the integral over `from` adaptive (HiddenIntegral), until
/// its estimated error is at most `tolerance` (m^2). Only the part of `from` is integrated over
/// from which anything is hidden; it is cut first where the integrand may jump, along the planes of
/// occluders, and, if it takes that, where it bends most, along the lines on which an edge of an
/// occluder covers a parallel edge of `to`. 0 without an integral where one occluder hides all.
///
/// `pieces` of shafts.occluders() are what shafts.find() found. Nothing if they are more than this
/// does quicker than rays.
std::optional<VisibleExchange> visible_exchange(const Shafts& shafts, const ShaftEnd& from,
                                                const ShaftEnd& to, std::span<const int> pieces,
                                                double unoccluded, double tolerance);

}  // namespace lightwell
