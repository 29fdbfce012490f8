#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/io/radiance/radiance_primitive.h"
#include "scene/io/remarks.h"
#include "scene/io/text_file.h"
#include "scene/scene.h"

namespace lightwell {

/// A view as RADIANCE's options say it, beginning with its defaults.
struct RadianceView {
  char type = 'v';  ///< v: perspective
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitY();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double horizontal = 45.0, vertical = 45.0;  ///< full angles, degrees
  double fore = 0.0, aft = 0.0;               ///< clipping planes
  double shift = 0.0, lift = 0.0;
  double width = 512.0, height = 512.0;  ///< pixels that the picture has at most
  int line = 1;                          ///< of the view file
};

/// Changes a view by the options among the words (-vp x y z, ..., and -x, -y for the picture's
/// size); other words are passed over. Throws InputError naming the place where an option lacks its
/// numbers.
void apply_view_options(std::span<const std::string> words, const RadianceLocation& location,
                        RadianceView& view);

/// Lines of a view file: those that begin with VIEW= or the name of a program that takes views.
/// Each goes on from the view before it, the first from `view`.
std::vector<RadianceView> read_radiance_views(const TextFile& file, RadianceView view);

/// Adds a camera to the scene; views that are no perspectives are remarked upon and left out.
void add_radiance_camera(const RadianceView& view, const std::string& name,
                         const RadianceLocation& location, Scene& scene, Remarks& remarks);

/// Words parted by blanks.
std::vector<std::string> words_of(std::string_view text);

}  // namespace lightwell
