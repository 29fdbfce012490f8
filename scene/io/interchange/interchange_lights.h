#pragma once

#include "scene/io/interchange/imported_file.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// Adds the lights of a COLLADA or FBX file. Point and spot lights become lamps of the intensity
/// color in relative units, W/sr; a directional light becomes the scene's sun of the irradiance
/// color. Ambient light, areas and volumes are left out with a remark, and so are laws of distance
/// other than the inverse square.
void add_interchange_lights(const ImportedFile& file, Scene& scene, Remarks& remarks);

/// Adds the cameras of a COLLADA or FBX file, 512 pixels high since the formats name no size.
void add_interchange_cameras(const ImportedFile& file, Scene& scene, Remarks& remarks);

}  // namespace lightwell
