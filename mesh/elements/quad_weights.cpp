#include "mesh/elements/quad_weights.h"

#include <algorithm>
#include <cmath>

namespace lightwell {

Eigen::Vector2d bilinear_coordinates(double alpha, double beta, double a, double b,
                                     const Eigen::Vector2d& guess) {
  constexpr int most_steps = 8;
  constexpr double converged = 1e-7;  // of the element; the next step would square the error
  double s = guess.x(), t = guess.y();
  for (int step = 0; step < most_steps; ++step) {
    const double fs = s + (alpha - 1.0) * s * t - a, ft = t + (beta - 1.0) * s * t - b;
    if (std::abs(fs) + std::abs(ft) < converged) break;
    const double ss = 1.0 + (alpha - 1.0) * t, st = (alpha - 1.0) * s;
    const double ts = (beta - 1.0) * t, tt = 1.0 + (beta - 1.0) * s;
    const double det = ss * tt - st * ts;
    s -= (tt * fs - st * ft) / det;
    t -= (ss * ft - ts * fs) / det;
  }
  return {std::clamp(s, 0.0, 1.0), std::clamp(t, 0.0, 1.0)};
}

Eigen::Vector2d bilinear_coordinates(const QuadShape& shape, double u, double v) {
  const Eigen::Vector2d of_parallelogram(u, v);
  if (shape.is_parallelogram()) return of_parallelogram;
  const double alpha = shape.alpha, beta = shape.beta;
  double a = u, b = v;
  if (u + v > 1.0) {
    const double w1 = 1.0 - v, w3 = 1.0 - u, w2 = 1.0 - w1 - w3;
    a = w1 + alpha * w2;
    b = w3 + beta * w2;
  }
  return bilinear_coordinates(alpha, beta, a, b, of_parallelogram);
}

}  // namespace lightwell
