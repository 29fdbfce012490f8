#pragma once

namespace lightwell {

/// Cone of a pixel about a ray (Amanatides 1984).
struct PixelCone {
  double start = 0.0;   ///< m, width at the ray's origin
  double spread = 0.0;  ///< m by which the width grows over one metre
};

}  // namespace lightwell
