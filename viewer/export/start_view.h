#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "scene/scene.h"
#include "viewer/export/appearance.h"

namespace lightwell {

/// Upwards direction: the coordinate axis, or its opposite, nearest to the sum of the cameras' up
/// vectors, without orthographic cameras and fisheyes, which may look along it. Without any other
/// +y or +z, along which the scene is shorter, as rooms are wider than high; +y if equal.
Eigen::Vector3d guess_up_axis(const std::vector<Camera>& cameras, const Bounds& bounds);

/// Camera outside of the scene along `direction`, with the bounding sphere in a picture of
/// width x height pixels.
Camera frame_all(const Bounds& bounds, const Eigen::Vector3d& direction,
                 const Eigen::Vector3d& up_axis, int width, int height);

/// Camera with a field of view wide enough that a window of width x height pixels shows all of the
/// given camera's picture.
Camera fit_to_window(const Camera& camera, int width, int height);

/// Start camera of a scene without cameras: the whole scene from outside if enough light is visible
/// from there, else a view inside across the room.
Camera find_start(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                  const BandArray& radiance, const Eigen::Vector3d& up_axis, int width, int height);

}  // namespace lightwell
