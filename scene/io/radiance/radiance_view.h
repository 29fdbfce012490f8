#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/io/radiance/text/radiance_primitive.h"
#include "scene/io/remarks.h"
#include "scene/io/text_file.h"
#include "scene/scene.h"

namespace lightwell {

/// A view by RADIANCE's view options; initial values are RADIANCE's defaults.
struct RadianceView {
  char type = 'v';  ///< v: perspective, l: parallel, a, h and s: fisheyes, c: cylindrical
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitY();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double horizontal = 45.0, vertical = 45.0;  ///< full angles, degrees; l: width and height
  double fore = 0.0, aft = 0.0;               ///< clipping planes
  double shift = 0.0, lift = 0.0;
  double width = 512.0, height = 512.0;  ///< largest size of the picture in pixels
  int line = 1;                          ///< line of the view file
};

/// Applies the view options among the words to a view (-vp x y z, ..., and -x, -y for the picture's
/// size); other words are skipped. Throws InputError naming the place of an option without its
/// numbers.
void apply_view_options(std::span<const std::string> words, const RadianceLocation& location,
                        RadianceView& view);

/// Views of a view file: its lines that begin with VIEW= or the name of a program that accepts
/// views. Each view starts from the previous one, the first from `view`.
std::vector<RadianceView> read_radiance_views(const TextFile& file, RadianceView view);

/// Adds a camera to the scene. Throws InputError naming view, place and value for a view that no
/// camera can have.
void add_radiance_camera(const RadianceView& view, const std::string& name,
                         const RadianceLocation& location, Scene& scene, Remarks& remarks);

/// View options of a camera, from -vt to -vl, lengths in the scene file's unit; empty for
/// projections and lenses that RADIANCE has no view of. A camera that shows part of a picture has
/// the shifted view of that part.
std::string radiance_view_options(const Camera& camera, double metres_per_unit);

/// Splits text at blanks.
std::vector<std::string> words_of(std::string_view text);

}  // namespace lightwell
