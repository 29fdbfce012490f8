#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "raytrace/shading/render_options.h"

namespace lightwell {

/// Options that a picture's quality stands for.
struct PictureQuality {
  const char* name;
  int shadow_rays;  ///< most per emitter and point
  int photons;      ///< for caustics
  double noise;     ///< relative standard error at which the sampling of a pixel ends
};

/// "draft", "good" and "final".
std::vector<std::string> picture_quality_names();

/// The quality of that name. Throws std::invalid_argument that lists all names for any other name.
PictureQuality picture_quality(std::string_view name);

/// "auto", "interpolate", "direct", "gather" and "virtual-lights".
std::vector<std::string> pass_names();

/// Options of a picture by the name of its pass, the name of its quality, and the numbers of the
/// quality, which may be changed. A "draft" by virtual lights takes all light from the mesh. Throws
/// std::invalid_argument that lists the names for an unknown pass.
RenderOptions picture_options(std::string_view pass, std::string_view quality,
                              const PictureQuality& numbers);

}  // namespace lightwell
