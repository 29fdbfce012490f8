#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <vector>

#include "scene/bands.h"
#include "scene/picture_sums.h"
#include "scene/rgb_basis.h"

namespace lightwell {

/// How a lamp projects a picture.
struct ProjectorOptics {
  double beam = 0.5;  ///< rad, full angle across the picture's width; (0, widest_beam]
  /// m along the axis, to the plane where the picture is sharp; infinity: sharp everywhere.
  double focus = std::numeric_limits<double>::infinity();
  double lens = 0.1;  ///< m, diameter of the lens, (0, focus]; without a focus it does nothing
  /// Shares of the picture that blades cut off, >= 0; opposite ones leave some of it.
  struct Shutters {
    double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;
  } shutters{};
};

/// The widest ProjectorOptics::beam: 170 degrees.
inline constexpr double widest_beam = 170.0 / 180.0 * 3.14159265358979323846;

/// A picture before a lamp: slide, gobo or video (Dorsey, Sillion & Greenberg 1991, "Design and
/// simulation of opera lighting and projection effects"). Directions are slopes (x, y) to the axis;
/// the picture is a rectangle of slopes whose texels are flat squares. In the lamp's own frame the
/// axis is -z, the picture's right is +x and its top +y. White lights a wall across the axis
/// evenly,
///
///     I(x, y) = T(x, y) / cos^3,    E = I cos / r^2 = T(x, y) / d^2,    Phi = int T dx dy
///
/// with d along the axis. A thin lens of diameter D focused at f spreads each point of the picture
/// over an image of the lens, which has the slope diameter D |1/f - 1/d| at depth d. T is then the
/// mean over that image, so that Phi is the same at every depth. The lens is eight strips of a
/// disc, whose means are exact (see PictureSums). Rays leave points of the lens towards the plane
/// in focus: they bring the same light to planes across the axis, and to other planes but for terms
/// of (D / d)^2. Nearer than D to the lens, T is that of the depth D.
class ProjectedPicture {
 public:
  /// `slide` has values in [0,1]. Throws std::invalid_argument if a number of the optics is out
  /// of its range.
  ProjectedPicture(std::shared_ptr<const PictureSums> slide, const ProjectorOptics& optics,
                   const RgbBasis& basis);

  const PictureSums& slide() const { return *slide_; }
  const ProjectorOptics& optics() const { return optics_; }

  /// Intensity r, g, b over that on the axis through white, in a unit direction of the lamp's frame
  /// at `distance` metres.
  Eigen::Array3d towards(const Eigen::Vector3d& direction, double distance) const;
  /// The same of a ray that leaves a lens_point().
  Eigen::Array3d along(const Eigen::Vector3d& lens_point, const Eigen::Vector3d& direction) const;
  /// Random point of the lens in the lamp's frame, m; the middle if all is sharp.
  Eigen::Vector3d lens_point(double u, double v) const;
  /// A direction from a lens_point() in proportion to the light, about.
  struct Drawn {
    Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ();  ///< unit
    Eigen::Array3d weight = Eigen::Array3d::Zero();         ///< r, g, b, sr; the mean is flux()
  };
  Drawn draw(const Eigen::Vector3d& lens_point, double u, double v) const;

  /// Integral of towards() over all directions, sr, at any distance.
  const Eigen::Array3d& flux() const { return flux_; }
  /// The flux without picture and shutters, sr.
  double open_flux() const { return 4.0 * half_width_ * half_height_; }
  /// The least upper bounds that are known of towards(), at all distances, for directions within
  /// each of `steps` equal steps of the angle to the axis from 0 to pi.
  std::vector<Eigen::Array3d> greatest_by_angle(int steps) const;

  /// r, g, b of towards() in the bands of the scene.
  Spectrum in_bands(const Eigen::Array3d& rgb) const {
    return basis_.reflectance(rgb.cast<float>());
  }

 private:
  Eigen::Vector2d texel_at(const Eigen::Vector2d& slope) const;
  Eigen::Vector2d slope_at(double x, double y) const;
  Eigen::Array3d sharp(const Eigen::Vector2d& slope) const;
  Eigen::Array3d blurred(const Eigen::Vector2d& slope, double radius) const;
  double blur_radius(double depth) const;
  double corner_slope() const;
  Eigen::Array3d brightest(int left, int top, int size) const;
  std::vector<Eigen::Array3d> greatest_if_sharp(int steps) const;
  std::vector<Eigen::Array3d> greatest_if_blurred(int steps) const;
  void tabulate();

  std::shared_ptr<const PictureSums> slide_;
  ProjectorOptics optics_;
  RgbBasis basis_;
  double half_width_ = 0.0, half_height_ = 0.0;  // slopes
  TexelRect window_{};                           // that shutters leave
  double texel_ = 0.0;                           // slopes across one texel
  Eigen::Array3d flux_ = Eigen::Array3d::Zero();
  // Cumulative light of the rows of cells of the window, and of the cells of each row, for draw().
  int columns_ = 1, rows_ = 1;
  std::vector<double> row_cdf_{}, cell_cdf_{};
};

}  // namespace lightwell
