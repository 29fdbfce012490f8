#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Where a camera was when.
struct CameraPath {
  std::vector<double> seconds{};  ///< rising, from 0
  std::vector<Camera> cameras{};

  bool empty() const { return cameras.empty(); }
  double duration() const { return seconds.empty() ? 0.0 : seconds.back(); }
  /// Positions and angle of view by cubic Hermite curves through the cameras (Catmull & Rom 1974,
  /// for uneven times), directions turned evenly in between. Before and after it: its ends.
  Camera at(double second) const;
};

/// `count` cameras evenly in time, the first and the last at its ends.
std::vector<Camera> frames_along(const CameraPath& path, int count);

/// `count` cameras around a centre, evenly; the first is `start`.
std::vector<Camera> turntable(const Camera& start, const Eigen::Vector3d& center,
                              const Eigen::Vector3d& up_axis, int count);

/// Views that someone kept of a scene: bookmarks 1 to 9, and a path.
struct KeptViews {
  std::array<std::optional<Camera>, 9> bookmarks{};
  CameraPath path{};
};

/// From a JSON file: {"bookmarks": {"1": CAMERA, ...}, "path": [{"seconds": 0, CAMERA}, ...]}, with
/// CAMERA position (m), direction, up, fov_degrees (of the width) and size (of the picture, for its
/// shape); without them up is +z, and a picture is 60 degrees wide and 4:3. Throws
/// InputError naming file and place.
KeptViews read_views(const std::filesystem::path& file);
/// Temporary name, then renamed; throws std::runtime_error naming the file.
void write_views(const std::filesystem::path& file, const KeptViews& views);

/// The name of frame `index` by a pattern such as "out-%04d.png". Throws InputError unless there is
/// one place for the number.
std::filesystem::path frame_name(const std::string& pattern, int index);

}  // namespace lightwell
