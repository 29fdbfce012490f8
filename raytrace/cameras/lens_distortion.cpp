#include "raytrace/cameras/lens_distortion.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace lightwell {
namespace {

double radial_factor(const LensDistortion& lens, double r2) {
  return 1.0 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3));
}

// Derivative of r radial_factor(r^2) by r.
double radial_slope(const LensDistortion& lens, double r2) {
  return 1.0 + r2 * (3.0 * lens.k1 + r2 * (5.0 * lens.k2 + r2 * 7.0 * lens.k3));
}

// Root of a function between `low`, where it is negative, and `high`, where it is not.
template <class Function>
double bisect(double low, double high, Function&& f) {
  constexpr int halvings = 200;
  for (int i = 0; i < halvings && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (f(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// True if the picture is nowhere mirrored on the way from its middle to a point before distortion.
bool is_unfolded(const LensDistortion& lens, const Eigen::Vector2d& p) {
  constexpr int places = 16;
  for (int i = 1; i <= places; ++i) {
    const double share = static_cast<double>(i) / places;
    if (!(distortion_slope(lens, share * p).determinant() > 0.0)) return false;
  }
  return true;
}

// Radius before distortion of a point at the radius `shown` after it, by the radial terms alone.
std::optional<double> undistorted_radius(const LensDistortion& lens, double shown, double fold) {
  const auto excess = [&](double r) { return r * radial_factor(lens, r * r) - shown; };
  double high = fold;
  if (!std::isfinite(high)) {
    // The polynomial rises everywhere, but where 1 is its largest term it may do so slowly.
    constexpr double farthest = 1e6;
    for (high = 1.0 + shown; excess(high) < 0.0 && high < farthest;) high *= 2.0;
  }
  if (excess(high) < 0.0) return std::nullopt;
  return bisect(0.0, high, excess);
}

}  // namespace

Eigen::Vector2d distorted(const LensDistortion& lens, const Eigen::Vector2d& p) {
  const double r2 = p.squaredNorm(), xy2 = 2.0 * p.x() * p.y();
  return radial_factor(lens, r2) * p +
         Eigen::Vector2d(lens.p1 * xy2 + lens.p2 * (r2 + 2.0 * p.x() * p.x()),
                         lens.p1 * (r2 + 2.0 * p.y() * p.y()) + lens.p2 * xy2);
}

Eigen::Matrix2d distortion_slope(const LensDistortion& lens, const Eigen::Vector2d& p) {
  const double r2 = p.squaredNorm(), x = p.x(), y = p.y();
  // d radial_factor / d r^2, twice, for the derivative by x is 2 x times it.
  const double steep = 2.0 * (lens.k1 + r2 * (2.0 * lens.k2 + r2 * 3.0 * lens.k3));
  Eigen::Matrix2d slope =
      radial_factor(lens, r2) * Eigen::Matrix2d::Identity() + steep * p * p.transpose();
  const double cross = 2.0 * (lens.p1 * x + lens.p2 * y);
  slope(0, 0) += 2.0 * lens.p1 * y + 6.0 * lens.p2 * x;
  slope(0, 1) += cross;
  slope(1, 0) += cross;
  slope(1, 1) += 6.0 * lens.p1 * y + 2.0 * lens.p2 * x;
  return slope;
}

double fold_radius(const LensDistortion& lens) {
  // The slope of the radius falls to zero at the least positive root of a cubic in r^2. Between the
  // cubic's extremes it is monotone, so the root is on the first piece at whose end it is negative.
  const double a = 21.0 * lens.k3, b = 10.0 * lens.k2, c = 3.0 * lens.k1;  // of the derivative
  std::vector<double> ends;
  if (a == 0.0) {
    if (b != 0.0) ends = {-c / b};
  } else if (const double under = b * b - 4.0 * a * c; under >= 0.0) {
    const double q = -0.5 * (b + std::copysign(std::sqrt(under), b));
    ends = {q / a};
    if (q != 0.0) ends.push_back(c / q);
    std::ranges::sort(ends);
  }
  constexpr double farthest = 1e12;
  ends.push_back(farthest);
  double low = 0.0;
  for (const double end : ends) {
    if (!(end > low)) continue;
    if (!(radial_slope(lens, end) > 0.0)) {
      return std::sqrt(bisect(low, end, [&](double r2) { return -radial_slope(lens, r2); }));
    }
    low = end;
  }
  return std::numeric_limits<double>::infinity();
}

std::optional<Eigen::Vector2d> undistorted(const LensDistortion& lens, const Eigen::Vector2d& q,
                                           double fold) {
  const double shown = q.norm();
  if (lens.is_none() || shown == 0.0) return q;
  const auto radius = undistorted_radius(lens, shown, fold);
  if (lens.p1 == 0.0 && lens.p2 == 0.0) {
    if (!radius) return std::nullopt;
    return *radius / shown * q;
  }
  constexpr double near_fold = 0.9;
  Eigen::Vector2d p = radius.value_or(near_fold * fold) / shown * q;
  constexpr int most_steps = 50;
  constexpr double rounding = 1e-13;
  for (int step = 0; step < most_steps; ++step) {
    const Eigen::Vector2d miss = q - distorted(lens, p);
    if (miss.norm() <= rounding * (1.0 + shown)) {
      if (p.norm() <= fold && is_unfolded(lens, p)) return p;
      return std::nullopt;
    }
    const Eigen::Vector2d way = distortion_slope(lens, p).inverse() * miss;
    // A step is halved until it comes closer.
    constexpr double least_share = 1e-4;
    double share = 1.0;
    while (share > least_share && !((q - distorted(lens, p + share * way)).norm() < miss.norm())) {
      share *= 0.5;
    }
    if (!(share > least_share)) return std::nullopt;
    p += share * way;
  }
  return std::nullopt;
}

}  // namespace lightwell
