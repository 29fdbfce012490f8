#pragma once

#include <filesystem>

#include "scene/io/radiance/text/radiance_primitive.h"

namespace lightwell {

/// Passes the polygons of the OBJ file that a primitive of type mesh was compiled from to `sink`,
/// in the coordinates of the file. Their modifier is that of the mesh or, if that is void, the name
/// of the file without its extension. Throws InputError if the file cannot be read.
void pass_mesh_source(const RadiancePrimitive& mesh, const std::filesystem::path& obj,
                      const RadianceSink& sink);

}  // namespace lightwell
