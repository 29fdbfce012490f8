#include "scene/projected_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>

#include "scene/sampling.h"

namespace lightwell {
namespace {

// The strips of a disc of radius 1 across y, from -1 to 1, as rectangles of the strips' areas.
constexpr int strips = 8;

struct LensStrips {
  std::array<double, strips> half_length{};
  std::array<double, strips> cdf{};  // running sum of the areas
  double reach = 0.0;                // farthest corner of a rectangle from the middle
};

const LensStrips& lens_strips() {
  static const LensStrips all = [] {
    // Area of the disc below y.
    const auto below = [](double y) { return y * std::sqrt(1.0 - y * y) + std::asin(y); };
    constexpr double thickness = 2.0 / strips;
    LensStrips result;
    double sum = 0.0;
    for (int k = 0; k < strips; ++k) {
      const double area = below(-1.0 + (k + 1) * thickness) - below(-1.0 + k * thickness);
      const double half_length = 0.5 * area / thickness;
      result.half_length[static_cast<std::size_t>(k)] = half_length;
      result.cdf[static_cast<std::size_t>(k)] = sum += area;
      const double outside = std::max(1.0 - k * thickness, (k + 1) * thickness - 1.0);
      result.reach = std::max(result.reach, std::hypot(half_length, outside));
    }
    return result;
  }();
  return all;
}

// Lower end of strip `k` of the disc of radius 1.
double strip_start(int k) {
  return -1.0 + 2.0 * k / strips;
}

double inverse_cube_of_cosine(double slope) {
  return std::pow(1.0 + slope * slope, 1.5);
}

// The slope of the end of step `k` of `steps` steps of the angle from 0 to pi.
double end_of_step(int k, int steps) {
  if (2 * (k + 1) >= steps) return std::numeric_limits<double>::infinity();
  return std::tan((k + 1) * std::numbers::pi / steps);
}

// 1 / cos^3 of a unit direction.
double inverse_cube(const Eigen::Vector3d& direction) {
  return 1.0 / std::pow(-direction.z(), 3);
}

Eigen::Vector2d slope_of(const Eigen::Vector3d& direction) {
  return direction.head<2>() / -direction.z();
}

void check(const ProjectorOptics& optics) {
  const auto& [left, right, top, bottom] = optics.shutters;
  const bool is_sharp = std::isinf(optics.focus);
  const bool is_sound = optics.beam > 0.0 && optics.beam <= widest_beam && optics.focus > 0.0 &&
                        (is_sharp || (optics.lens > 0.0 && optics.lens <= optics.focus)) &&
                        std::min({left, right, top, bottom}) >= 0.0 && left + right < 1.0 &&
                        top + bottom < 1.0;
  if (!is_sound) throw std::invalid_argument("ProjectedPicture: optics out of range");
}

}  // namespace

ProjectedPicture::ProjectedPicture(std::shared_ptr<const PictureSums> slide,
                                   const ProjectorOptics& optics, const RgbBasis& basis)
    : slide_(std::move(slide)), optics_(optics), basis_(basis) {
  check(optics_);
  const TexelRect whole = slide_->whole();
  half_width_ = std::tan(0.5 * optics_.beam);
  half_height_ = half_width_ * whole.bottom / whole.right;
  texel_ = 2.0 * half_width_ / whole.right;
  const auto& shutters = optics_.shutters;
  window_ = {.left = shutters.left * whole.right,
             .right = (1.0 - shutters.right) * whole.right,
             .top = shutters.top * whole.bottom,
             .bottom = (1.0 - shutters.bottom) * whole.bottom};
  flux_ = slide_->over(window_) * texel_ * texel_;
  tabulate();
}

// Position in the picture, in texels from its top left corner.
Eigen::Vector2d ProjectedPicture::texel_at(const Eigen::Vector2d& slope) const {
  return {(slope.x() + half_width_) / texel_, (half_height_ - slope.y()) / texel_};
}

Eigen::Vector2d ProjectedPicture::slope_at(double x, double y) const {
  return {x * texel_ - half_width_, half_height_ - y * texel_};
}

Eigen::Array3d ProjectedPicture::sharp(const Eigen::Vector2d& slope) const {
  const Eigen::Vector2d at = texel_at(slope);
  if (!window_.contains(at.x(), at.y())) return Eigen::Array3d::Zero();
  return slide_->picture()
      .texel(0, static_cast<int>(at.x()), static_cast<int>(at.y()))
      .cast<double>();
}

// Mean of the picture over the image of the lens, of `radius` in slopes.
Eigen::Array3d ProjectedPicture::blurred(const Eigen::Vector2d& slope, double radius) const {
  const Eigen::Vector2d at = texel_at(slope);
  const double r = radius / texel_;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int k = 0; k < strips; ++k) {
    const double half = r * lens_strips().half_length[static_cast<std::size_t>(k)];
    const TexelRect strip{.left = at.x() - half,
                          .right = at.x() + half,
                          .top = at.y() + r * strip_start(k),
                          .bottom = at.y() + r * strip_start(k + 1)};
    const TexelRect seen = strip.within(window_);
    if (!seen.is_empty()) sum += slide_->over(seen);
  }
  return sum / (std::numbers::pi * r * r);
}

double ProjectedPicture::blur_radius(double depth) const {
  if (std::isinf(optics_.focus)) return 0.0;
  return 0.5 * optics_.lens * std::abs(1.0 / optics_.focus - 1.0 / std::max(depth, optics_.lens));
}

Eigen::Array3d ProjectedPicture::towards(const Eigen::Vector3d& direction, double distance) const {
  if (!(direction.z() < 0.0)) return Eigen::Array3d::Zero();
  const double radius = blur_radius(-direction.z() * distance);
  // A smaller image of the lens than this share of a texel blurs nothing.
  constexpr double least = 1e-6;
  const Eigen::Vector2d slope = slope_of(direction);
  const Eigen::Array3d T = radius > least * texel_ ? blurred(slope, radius) : sharp(slope);
  return T * inverse_cube(direction);
}

Eigen::Array3d ProjectedPicture::along(const Eigen::Vector3d& lens_point,
                                       const Eigen::Vector3d& direction) const {
  if (!(direction.z() < 0.0)) return Eigen::Array3d::Zero();
  const Eigen::Vector2d in_focus = slope_of(direction) + lens_point.head<2>() / optics_.focus;
  return sharp(in_focus) * inverse_cube(direction);
}

Eigen::Vector3d ProjectedPicture::lens_point(double u, double v) const {
  if (std::isinf(optics_.focus)) return Eigen::Vector3d::Zero();
  const auto [k, within, area] = draw_from_table(lens_strips().cdf, u);
  const double half = lens_strips().half_length[static_cast<std::size_t>(k)];
  const double x = (2.0 * v - 1.0) * half;
  const double y = strip_start(k) + within * (2.0 / strips);
  return 0.5 * optics_.lens * Eigen::Vector3d(x, y, 0.0);
}

void ProjectedPicture::tabulate() {
  // Cells are as large as texels where these are few.
  constexpr double most = 64.0;
  columns_ = static_cast<int>(std::clamp(std::ceil(window_.right - window_.left), 1.0, most));
  rows_ = static_cast<int>(std::clamp(std::ceil(window_.bottom - window_.top), 1.0, most));
  const double width = (window_.right - window_.left) / columns_,
               height = (window_.bottom - window_.top) / rows_;
  double sum = 0.0;
  for (int j = 0; j < rows_; ++j) {
    double of_row = 0.0;
    for (int i = 0; i < columns_; ++i) {
      const TexelRect cell{.left = window_.left + i * width,
                           .right = window_.left + (i + 1) * width,
                           .top = window_.top + j * height,
                           .bottom = window_.top + (j + 1) * height};
      cell_cdf_.push_back(of_row += slide_->over(cell.within(window_)).mean());
    }
    row_cdf_.push_back(sum += of_row);
  }
}

ProjectedPicture::Drawn ProjectedPicture::draw(const Eigen::Vector3d& lens_point, double u,
                                               double v) const {
  if (!(row_cdf_.back() > 0.0)) return {};
  const auto [j, down, of_row] = draw_from_table(row_cdf_, v);
  const auto columns = static_cast<std::size_t>(columns_);
  const auto [i, along, of_cell] = draw_from_table(
      std::span(cell_cdf_).subspan(static_cast<std::size_t>(j) * columns, columns), u);
  const double width = (window_.right - window_.left) / columns_,
               height = (window_.bottom - window_.top) / rows_;
  const Eigen::Vector2d in_focus =
      slope_at(window_.left + (i + along) * width, window_.top + (j + down) * height);
  const Eigen::Vector2d slope = in_focus - lens_point.head<2>() / optics_.focus;
  const double area = width * height * texel_ * texel_;
  return {.direction = Eigen::Vector3d(slope.x(), slope.y(), -1.0).normalized(),
          .weight = sharp(in_focus) * (area * row_cdf_.back() / of_cell)};
}

// The greatest slope of a corner that shutters leave.
double ProjectedPicture::corner_slope() const {
  const Eigen::Vector2d a = slope_at(window_.left, window_.top).cwiseAbs(),
                        b = slope_at(window_.right, window_.bottom).cwiseAbs();
  return a.cwiseMax(b).norm();
}

std::vector<Eigen::Array3d> ProjectedPicture::greatest_by_angle(int steps) const {
  return std::isinf(optics_.focus) ? greatest_if_sharp(steps) : greatest_if_blurred(steps);
}

// The brightest texel of a block of at most `size` x `size` texels.
Eigen::Array3d ProjectedPicture::brightest(int left, int top, int size) const {
  const Texture& picture = slide_->picture();
  Eigen::Array3d most = Eigen::Array3d::Zero();
  for (int y = top; y < std::min(top + size, picture.height()); ++y) {
    for (int x = left; x < std::min(left + size, picture.width()); ++x) {
      most = most.max(picture.texel(0, x, y).cast<double>());
    }
  }
  return most;
}

// Blocks of texels count as if they were as bright all over as their brightest texel.
std::vector<Eigen::Array3d> ProjectedPicture::greatest_if_sharp(int steps) const {
  std::vector<Eigen::Array3d> greatest(static_cast<std::size_t>(steps), Eigen::Array3d::Zero());
  constexpr int blocks = 128;
  const Texture& picture = slide_->picture();
  const int size = (std::max(picture.width(), picture.height()) + blocks - 1) / blocks;
  for (int y = 0; y < picture.height(); y += size) {
    for (int x = 0; x < picture.width(); x += size) {
      const TexelRect block = TexelRect{.left = static_cast<double>(x),
                                        .right = static_cast<double>(x + size),
                                        .top = static_cast<double>(y),
                                        .bottom = static_cast<double>(y + size)}
                                  .within(window_);
      if (block.is_empty()) continue;
      const Eigen::Vector2d low = slope_at(block.left, block.bottom),
                            high = slope_at(block.right, block.top);
      const double nearest = Eigen::Vector2d::Zero().cwiseMax(low).cwiseMin(high).norm();
      const double farthest = low.cwiseAbs().cwiseMax(high.cwiseAbs()).norm();
      const Eigen::Array3d most = brightest(x, y, size);
      for (int k = 0; 2 * k < steps; ++k) {
        // Directions come with rounding.
        constexpr double rounding = 1e-9;
        if (end_of_step(k, steps) < nearest - rounding) continue;
        if (end_of_step(k - 1, steps) > farthest + rounding) break;
        const double slope = std::min(farthest, end_of_step(k, steps));
        Eigen::Array3d& known = greatest[static_cast<std::size_t>(k)];
        known = known.max(most * inverse_cube_of_cosine(slope));
      }
    }
  }
  return greatest;
}

// The mean over the image of the lens is at most the brightest texel, and all the picture's light
// over the area of the image, which reaches from the direction to the picture.
std::vector<Eigen::Array3d> ProjectedPicture::greatest_if_blurred(int steps) const {
  std::vector<Eigen::Array3d> greatest(static_cast<std::size_t>(steps), Eigen::Array3d::Zero());
  const Eigen::Array3d most = slide_->picture().largest().cast<double>();
  const double reach = lens_strips().reach, corner = corner_slope();
  const double end = corner + reach * std::max(blur_radius(0.0), blur_radius(1e300));
  for (int k = 0; 2 * k < steps && end_of_step(k - 1, steps) <= end; ++k) {
    const double radius = std::max(0.0, end_of_step(k - 1, steps) - corner) / reach;
    const Eigen::Array3d spread = flux_ / std::max(std::numbers::pi * radius * radius, 1e-300);
    greatest[static_cast<std::size_t>(k)] =
        most.min(spread) * inverse_cube_of_cosine(std::min(end, end_of_step(k, steps)));
  }
  return greatest;
}

}  // namespace lightwell
