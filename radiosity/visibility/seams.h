#pragma once

#include <cstdint>
#include <span>

#include "mesh/elements/element_caster.h"

namespace lightwell {

/// Sets the flags of rays that slip through seams of at most `width`, metres. `is_stopped` has one
/// flag for each ray. Nothing is sought where more than a sixteenth of the rays pass: much light
/// comes by an opening, beside which that of seams is small.
///
/// A ray passes a seam if of two rays beside it, on opposite sides and sqrt(2) widths away, both
/// are stopped. Two such pairs stand square to each other, so that one of them reaches across a
/// seam of any direction.
void stop_in_seams(const ElementCaster& caster, std::span<const Ray> rays, double width,
                   std::span<std::uint8_t> is_stopped);

}  // namespace lightwell
