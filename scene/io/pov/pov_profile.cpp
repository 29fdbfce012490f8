#include "scene/io/pov/pov_profile.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace lightwell {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Point of a piece at the place t, [0,1].
using Piece = std::function<Eigen::Vector2d(double t)>;

Piece parabola(const Eigen::Vector2d& before, const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  return [=](double t) -> Eigen::Vector2d {
    const Eigen::Vector2d slope = 0.5 * (q - before);
    return p + t * slope + t * t * (q - p - slope);
  };
}

/// Cubic from p to q with these derivatives (Hermite).
double hermite(double p, double slope_p, double q, double slope_q, double t) {
  const double u = 1.0 - t;
  return u * u * ((1.0 + 2.0 * t) * p + t * slope_p) + t * t * ((1.0 + 2.0 * u) * q - u * slope_q);
}

Piece catmull_rom(const Eigen::Vector2d& before, const Eigen::Vector2d& p, const Eigen::Vector2d& q,
                  const Eigen::Vector2d& after) {
  return [=](double t) -> Eigen::Vector2d {
    const Eigen::Vector2d at_p = 0.5 * (q - before), at_q = 0.5 * (after - p);
    return {hermite(p.x(), at_p.x(), q.x(), at_q.x(), t),
            hermite(p.y(), at_p.y(), q.y(), at_q.y(), t)};
  };
}

Piece bezier(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
             const Eigen::Vector2d& d) {
  return [=](double t) -> Eigen::Vector2d {
    const double u = 1.0 - t;
    return u * u * u * a + 3.0 * u * u * t * b + 3.0 * u * t * t * c + t * t * t * d;
  };
}

/// r^2 is a cubic of y whose slopes are 2 r dr/dy, dr/dy by the neighbours of a point.
Piece squared_radius(const Eigen::Vector2d& before, const Eigen::Vector2d& p,
                     const Eigen::Vector2d& q, const Eigen::Vector2d& after) {
  return [=](double t) -> Eigen::Vector2d {
    const double height = q.y() - p.y();
    const auto slope = [&](const Eigen::Vector2d& from, double r, const Eigen::Vector2d& to) {
      const double dy = to.y() - from.y();
      return dy != 0.0 ? height * 2.0 * r * (to.x() - from.x()) / dy : 0.0;
    };
    const double square =
        hermite(p.x() * p.x(), slope(before, p.x(), q), q.x() * q.x(), slope(p, q.x(), after), t);
    return {std::sqrt(std::max(square, 0.0)), p.y() + t * height};
  };
}

std::vector<Piece> pieces_of(PovCurve curve, const Points& points) {
  std::vector<Piece> pieces;
  const std::size_t n = points.size();
  if (curve == PovCurve::bezier) {
    for (std::size_t i = 0; i + 3 < n; i += 4) {
      pieces.push_back(bezier(points[i], points[i + 1], points[i + 2], points[i + 3]));
    }
  } else if (curve == PovCurve::quadratic) {
    for (std::size_t i = 1; i + 1 < n; ++i) {
      pieces.push_back(parabola(points[i - 1], points[i], points[i + 1]));
    }
  } else {
    const auto& piece = curve == PovCurve::cubic ? catmull_rom : squared_radius;
    for (std::size_t i = 1; i + 2 < n; ++i) {
      pieces.push_back(piece(points[i - 1], points[i], points[i + 1], points[i + 2]));
    }
  }
  return pieces;
}

}  // namespace

std::vector<Eigen::Vector2d> pov_profile(PovCurve curve, const Points& points) {
  if (curve == PovCurve::linear) return points;
  constexpr int steps = 8;
  Points profile;
  for (const Piece& piece : pieces_of(curve, points)) {
    if (profile.empty()) profile.push_back(piece(0.0));
    for (int i = 1; i <= steps; ++i) profile.push_back(piece(static_cast<double>(i) / steps));
  }
  return profile;
}

}  // namespace lightwell
