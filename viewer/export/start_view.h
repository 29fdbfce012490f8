#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "scene/scene.h"
#include "viewer/export/appearance.h"

namespace lightwell {

/// Axis-aligned bounds of the mesh's vertices.

/// The coordinate axis most cameras' up leans to; without cameras the one of y and z in which the
/// scene is lower, as rooms are wider than high.
Eigen::Vector3d guess_up_axis(const std::vector<Camera>& cameras, const Bounds& bounds);

/// From outside along `direction` (unit), the whole scene in the picture of width : height.
Camera frame_all(const Bounds& bounds, const Eigen::Vector3d& direction,
                 const Eigen::Vector3d& up_axis, int width, int height);

/// The same camera with as wide an angle as a window of width : height needs to show all of the
/// camera's own picture.
Camera fit_to_window(const Camera& camera, int width, int height);

/// Where to start when no camera is given: the whole scene from outside if light is seen from
/// there, else inside, looking across the room.
Camera find_start(const ElementCaster& caster, const std::vector<ElementKind>& kinds,
                  const BandArray& radiance, const Eigen::Vector3d& up_axis, int width, int height);

}  // namespace lightwell
