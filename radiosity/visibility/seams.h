#pragma once

#include "mesh/elements/element_caster.h"

namespace lightwell {

/// True if a ray that meets nothing slips through a seam of at most `width`, metres: of two rays
/// beside it, on opposite sides and sqrt(2) widths away, both are stopped. Two such pairs stand
/// square to each other, so that one of them reaches across a seam of any direction.
bool passes_seam(const ElementCaster& caster, const Ray& ray, double width);

}  // namespace lightwell
