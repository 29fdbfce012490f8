#pragma once

#include <Eigen/Core>
#include <cmath>

namespace lightwell {

/// The shape of a convex quadrilateral v0..v3: v2 - v0 = alpha (v1 - v0) + beta (v3 - v0), with
/// alpha = beta = 1 in a parallelogram. A place v0 + a (v1 - v0) + b (v3 - v0) is bilinear in (s,
/// t), each in [0, 1]:
///    a = s + (alpha - 1) s t,  b = t + (beta - 1) s t.
struct QuadShape {
  float alpha = 1.0f, beta = 1.0f;

  bool is_parallelogram() const {
    constexpr double rounding = 1e-6;
    return std::abs(double{alpha} - 1.0) + std::abs(double{beta} - 1.0) < rounding;
  }
};

/// The coefficients (a, b) for which a x + b y is nearest to d, for vectors in space or in a plane.
template <class Vector>
Eigen::Vector2d in_terms_of(const Vector& x, const Vector& y, const Vector& d) {
  const double xx = x.squaredNorm(), xy = x.dot(y), yy = y.squaredNorm();
  const double determinant = xx * yy - xy * xy;
  return {(yy * d.dot(x) - xy * d.dot(y)) / determinant,
          (xx * d.dot(y) - xy * d.dot(x)) / determinant};
}

/// (s, t) of (a, b) by Newton's method from a first guess. A convex quadrilateral has one root in
/// the unit square.
Eigen::Vector2d bilinear_coordinates(double alpha, double beta, double a, double b,
                                     const Eigen::Vector2d& guess);

/// (s, t) of a place met by a ray caster that treats the quadrilateral as the triangles (0,1,3) and
/// (2,3,1), with u and v linear in each.
Eigen::Vector2d bilinear_coordinates(const QuadShape& shape, double u, double v);

/// Bilinear weights of the four corners at the place (s, t).
inline Eigen::Array4f bilinear_weights(const Eigen::Vector2d& place) {
  const double s = place.x(), t = place.y();
  return Eigen::Array4d((1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t).cast<float>();
}

}  // namespace lightwell
