#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace lightwell {

/// The spread of directions, or of parallel rays, over a picture. Theta is the angle from the view
/// direction; a fisheye shows a direction at the distance f r(theta) from the picture's middle.
enum class Projection {
  perspective,      ///< straight lines stay straight
  orthographic,     ///< parallel rays: plans, elevations, sections
  equidistant,      ///< fisheye, r = theta
  equisolid,        ///< fisheye of equal solid angles, r = 2 sin(theta / 2)
  hemispherical,    ///< fisheye of equal projected solid angles, r = sin theta
  stereographic,    ///< fisheye that keeps angles, r = 2 tan(theta / 2)
  cylindrical,      ///< x is longitude, y the tangent of elevation
  equirectangular,  ///< x is longitude, y elevation: 360 by 180 degrees and parts of it
  stereo_panorama,  ///< two equirectangular pictures, of the left eye above that of the right
  cube_map,         ///< six square faces, see docs/cameras.md
};

/// A projection by the name that files and the command line call it.
struct NamedProjection {
  Projection projection;
  std::string_view name;
  /// Widest full angle, degrees; of `perspective` and `stereographic` all angles below.
  double widest;
  double usual;  ///< angle of a camera that gives none, degrees
};

inline constexpr std::array<NamedProjection, 10> named_projections = {{
    {Projection::perspective, "perspective", 180.0, 40.0},
    {Projection::orthographic, "orthographic", 180.0, 40.0},
    {Projection::equidistant, "fisheye", 360.0, 180.0},
    {Projection::equisolid, "equisolid", 360.0, 180.0},
    {Projection::hemispherical, "hemispherical", 180.0, 180.0},
    {Projection::stereographic, "stereographic", 360.0, 180.0},
    {Projection::cylindrical, "cylindrical", 360.0, 180.0},
    {Projection::equirectangular, "equirectangular", 360.0, 360.0},
    {Projection::stereo_panorama, "stereo", 360.0, 360.0},
    {Projection::cube_map, "cube", 360.0, 360.0},
}};

/// Coefficients of lens distortion (Brown 1966, 1971). The lens shows what a pinhole shows at
/// (x, y), at distance 1 and with r^2 = x^2 + y^2, at
///
///     x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2),
///     y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y,
///
/// where x grows to the right and y downwards.
struct LensDistortion {
  double k1 = 0.0, k2 = 0.0, k3 = 0.0;  ///< radial
  double p1 = 0.0, p2 = 0.0;            ///< tangential

  bool is_none() const { return k1 == 0.0 && k2 == 0.0 && k3 == 0.0 && p1 == 0.0 && p2 == 0.0; }
};

/// Part of a picture that is rendered, in shares of its width from the left and of its height from
/// the top.
struct PictureWindow {
  double left = 0.0, top = 0.0, right = 1.0, bottom = 1.0;

  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

/// A place to look from, and a picture of what is seen there. The picture's x axis is direction x
/// up: with direction +z and up +y, world +x is on the left. Row 0 is the top.
struct Camera {
  std::string name{};
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit length
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();  ///< unit length, perpendicular to direction
  double fov_degrees = 40.0;                      ///< full horizontal angle, see named_projections
  int width = 512, height = 512;                  ///< pixels of `window`
  double lens_radius = 0.0;     ///< m; 0: a pinhole, whose pictures are sharp everywhere
  double focus_distance = 1.0;  ///< m along `direction` to the plane that is sharp, > 0
  int blades = 0;               ///< of the aperture, 3 to max_blades; 0: round
  /// Times in s; a picture is the mean over the time in which the shutter is open. Equal times: an
  /// instant.
  double shutter_open = 0.0, shutter_close = 0.0;
  int motion = -1;  ///< index into Scene::motions; -1: the camera stands still
  Projection projection = Projection::perspective;
  double view_width = 1.0;  ///< m that an orthographic picture is wide
  /// m from the position: nothing nearer and nothing farther is seen. Of perspective and
  /// orthographic cameras, planes at right angles to `direction`; else spheres.
  double near_distance = 0.0, far_distance = std::numeric_limits<double>::infinity();
  /// Shift of the lens: the picture is moved this far to the right and upwards in its own plane, in
  /// shares of its width and height. Verticals stay upright where tilting would make them converge.
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  PictureWindow window{};       ///< part of the whole picture that is rendered
  LensDistortion distortion{};  ///< of perspective cameras
  /// Full angle of the circle beyond which a fisheye is black, degrees; 0: fov_degrees.
  double circle_degrees = 0.0;
  double eye_separation = 0.063;  ///< m between the eyes of a stereo panorama

  bool is_open_for_a_while() const { return shutter_close > shutter_open; }
  double shutter_middle() const { return 0.5 * (shutter_open + shutter_close); }
};

/// Most blades of an aperture.
inline constexpr int max_blades = 64;

/// Greatest magnitude of a coefficient of LensDistortion, and of a share of Camera::shift.
inline constexpr double most_distortion = 1e3, most_shift = 100.0;

const NamedProjection& named(Projection projection);
/// Returns the projection of a name; empty if the name is unknown.
std::optional<Projection> projection_named(std::string_view name);
bool is_fisheye(Projection projection);
/// True of perspective and orthographic cameras, whose pictures lie in a plane.
bool is_flat(Projection projection);
/// True of the projections that show all directions, or a band around the eye: x is longitude.
bool is_panorama(Projection projection);

/// Returns what is wrong with a camera's projection, angle, window, shift, circle, distortion or
/// the shape of its picture, and what to do, for a message that begins with the camera's name.
/// Empty: nothing.
std::string projection_fault(const Camera& camera);

/// Checks a camera: finite places and times of at most 1e9, direction and up unit vectors at right
/// angles, within 1e-6, a projection without fault, an aperture and a distance of focus that rays
/// can be computed with. Throws InputError naming camera and value.
void validate(const Camera& camera);

/// Sets the size of the whole picture, of which `window` is rendered: its edges move to whole
/// pixels, of which there is at least one.
void set_picture_size(int width, int height, Camera& camera);
/// Returns a camera of the same view with a picture about `width` pixels wide, of the same shape.
Camera resized(const Camera& camera, int width);
/// Returns a camera at the same place with another projection: with the projection's usual angle,
/// and a picture of the shape that the projection needs. Lens, shift, window, circle and distortion
/// are dropped where the projection has none. An orthographic camera keeps `view_width`.
Camera with_projection(const Camera& camera, Projection projection);
/// Returns the perspective nearest to a camera: from the same place in the same direction, without
/// window or distortion. Of other projections at most 90 degrees wide, and without shift.
Camera as_perspective(const Camera& camera);
/// Returns the camera nearest to one for windows, which draw perspective and orthographic pictures
/// alone: as_perspective() of other projections.
Camera for_window(const Camera& camera);
/// Returns what for_window() leaves out, as a sentence about several such cameras; empty: nothing.
std::string loss_in_window(const Camera& camera);

}  // namespace lightwell
