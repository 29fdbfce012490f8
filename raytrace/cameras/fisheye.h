#pragma once

#include "scene/camera.h"

namespace lightwell {

/// Distance from the middle of a fisheye's picture at which the angle `theta`, radians from the
/// view direction, is shown: r(theta) of Projection.
double fisheye_radius(Projection projection, double theta);
/// Inverse of fisheye_radius(), radians; not a number beyond the largest radius.
double fisheye_angle(Projection projection, double radius);

}  // namespace lightwell
