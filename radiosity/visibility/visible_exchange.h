#pragma once

#include <optional>

#include "radiosity/visibility/shaft.h"

namespace lightwell {

/// Most convex pieces between two patches for exact visibility. With more, rays are faster.
inline constexpr std::size_t most_pieces_between = 16;

struct VisibleExchange {
  double value = 0.0;  ///< S_ij, m^2
  /// estimated, m^2; above the tolerance where the triangles ran out
  double error = 0.0;
};

/// Exchange area S = A_i F_ij of two polygons behind occluders,
///
///   S = S_unoccluded - int_{A_i} F_hidden(x) dA.
///
/// F_hidden is exact (ShadowedPolygon). The integral over `from` is adaptive (HiddenIntegral), to
/// an estimated error of at most `tolerance`, m^2. The domain is the part of `from` from which
/// anything is hidden, cut along the planes of occluders, at which the integrand may jump. Where
/// that misses the tolerance, the domain is also cut where the integrand bends most: along the
/// lines on which an edge of an occluder covers a parallel edge of `to`. If one occluder hides
/// everything, S = 0 without an integral.
///
/// `pieces`: indices of shafts.occluders().pieces, as shafts.find() returns them. `unoccluded`:
/// S_unoccluded, m^2. Empty if `pieces` are more than most_pieces_between or an end has no parts.
std::optional<VisibleExchange> visible_exchange(const Shafts& shafts, const ShaftEnd& from,
                                                const ShaftEnd& to, std::span<const int> pieces,
                                                double unoccluded, double tolerance);

}  // namespace lightwell
