#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Cameras at times: a recorded walk.
struct CameraPath {
  std::vector<double> seconds{};  ///< one a camera, strictly rising, the first >= 0
  std::vector<Camera> cameras{};

  bool empty() const { return cameras.empty(); }
  double duration() const { return seconds.empty() ? 0.0 : seconds.back(); }
  /// Returns the camera at a time (s) of a path that is not empty. Before the first time: the first
  /// camera; after the last: the last. In between:
  /// - the position follows a cubic Hermite curve through the cameras (Catmull & Rom 1974, for
  ///   uneven times);
  /// - the orientation turns evenly from one camera to the next (slerp);
  /// - the angle of view is linear in time.
  Camera at(double second) const;
};

/// Returns `count` cameras of a path, evenly spaced in time. The first and the last are the ends of
/// the path; a single one is its beginning.
std::vector<Camera> frames_along(const CameraPath& path, int count);

/// Returns `count` cameras at even angles of a full turn about the axis through `center` along
/// `up_axis` (unit). The first is `start`.
std::vector<Camera> turntable(const Camera& start, const Eigen::Vector3d& center,
                              const Eigen::Vector3d& up_axis, int count);

/// Views of a scene that a user has saved: bookmarks 1 to 9, and a path.
struct KeptViews {
  std::array<std::optional<Camera>, 9> bookmarks{};
  CameraPath path{};
};

/// Reads views from a JSON file:
///   {"bookmarks": {"1": CAMERA, ...}, "path": [{"seconds": 0, CAMERA}, ...]}
/// A CAMERA has:
/// - position (m) and direction;
/// - up: +z by default;
/// - fov_degrees: the horizontal angle, in (0, 180), 60 by default;
/// - size: width and height of the picture, [4, 3] by default.
/// Throws InputError naming the file and the entry.
KeptViews read_views(const std::filesystem::path& file);
/// Writes views as read_views() reads them, under a temporary name that is then renamed. Throws
/// std::runtime_error naming the file.
void write_views(const std::filesystem::path& file, const KeptViews& views);

/// Returns the name of frame `index` by a pattern such as "out-%04d.png". Throws InputError unless
/// the pattern has one %d, with at most two digits of width, and no other percent sign.
std::filesystem::path frame_name(const std::string& pattern, int index);

}  // namespace lightwell
