#include "radiosity/closed_forms/pair_exchange.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "radiosity/closed_forms/polygon_exchange.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

// Distance between centres, in units of the sum of both radii, beyond which the rule of 2 x 2 (far)
// or 3 x 3 (middle) points has a relative error below 1e-5. The errors fall with the fourth and the
// sixth power of the distance.
constexpr double far_from = 8.0, middle_from = 3.0;

bool is_convex_outline(const std::vector<Vector3d>& loop, const Vector3d& normal) {
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d in = loop[(i + 1) % n] - loop[i], out = loop[(i + 2) % n] - loop[(i + 1) % n];
    if (!(in.cross(out).dot(normal) > 0.0)) return false;
  }
  return true;
}

}  // namespace

// Gauss points of the unit square (s, t), mapped bilinearly to the quadrilateral. A triangle is a
// quadrilateral whose last two corners coincide.
template <int N>
PairExchange::Points<N> PairExchange::gauss_points(const std::vector<Vector3d>& loop) {
  constexpr int side = N == few ? 2 : 3;
  // Nodes of the Gauss-Legendre rules: 1 / sqrt(3) and sqrt(3 / 5).
  constexpr double two = 0.57735026918962576, three = 0.77459666924148338;
  const std::array<double, 3> node =
      side == 2 ? std::array{-two, two, 0.0} : std::array{-three, 0.0, three};
  const std::array<double, 3> weight =
      side == 2 ? std::array{1.0, 1.0, 0.0} : std::array{5.0 / 9, 8.0 / 9, 5.0 / 9};
  const Vector3d &a = loop[0], &b = loop[1], &c = loop[2],
                 &d = loop.size() == 3 ? loop[2] : loop[3];
  Points<N> points;
  for (int p = 0; p < side; ++p) {
    for (int q = 0; q < side; ++q) {
      const double s = 0.5 * (1.0 + node[p]), t = 0.5 * (1.0 + node[q]);
      const Vector3d at = (1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * c + (1 - s) * t * d;
      const Vector3d along_s = (1 - t) * (b - a) + t * (c - d);
      const Vector3d along_t = (1 - s) * (d - a) + s * (c - b);
      const auto k = static_cast<std::size_t>(p * side + q);
      points.x[k] = at.x();
      points.y[k] = at.y();
      points.z[k] = at.z();
      points.weight[k] = 0.25 * weight[p] * weight[q] * along_s.cross(along_t).norm();
    }
  }
  return points;
}

PairExchange::PairExchange(const std::vector<PatchOutline>& outlines, double relative_error)
    : outlines_(outlines),
      relative_error_(std::min(relative_error, usual_error)),
      far_from_(far_from * far_from * std::sqrt(usual_error / relative_error_)),
      middle_from_(middle_from * middle_from * std::cbrt(usual_error / relative_error_)),
      offset_(outlines.size(), 0.0),
      patches_(outlines.size()) {
  parallel_for(static_cast<int>(outlines.size()), 256, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const PatchOutline& outline = outlines[i];
      if (!outline.is_polygon()) continue;
      const auto& loop = outline.loops.front();
      offset_[i] = outline.normal.dot(loop[0]);
      Patch& patch = patches_[i];
      patch.has_points =
          outline.loops.size() == 1 && loop.size() <= 4 && is_convex_outline(loop, outline.normal);
      if (!patch.has_points) continue;
      patch.far = gauss_points<few>(loop);
      patch.middle = gauss_points<more>(loop);
    }
  });
}

int PairExchange::side(int plane, int other) const {
  const Vector3d& normal = outlines_[plane].normal;
  const double height = normal.dot(outlines_[other].center) - offset_[plane];
  const double radius = outlines_[other].radius;
  if (height >= radius) return 1;
  if (height <= -radius) return -1;
  bool before = false, behind = false;
  const double tolerance = 1e-9 * radius;
  for (const auto& loop : outlines_[other].loops) {
    for (const Vector3d& v : loop) {
      const double h = normal.dot(v) - offset_[plane];
      before = before || h > tolerance;
      behind = behind || h < -tolerance;
    }
  }
  return !before ? -1 : behind ? 0 : 1;
}

bool PairExchange::face_each_other(int i, int j) const {
  if (!outlines_[i].is_polygon() || !outlines_[j].is_polygon()) return false;
  return side(i, j) >= 0 && side(j, i) >= 0;
}

template <int N>
double PairExchange::area_integral(int i, int j, const Points<N>& from, const Points<N>& to) const {
  const Vector3d &n = outlines_[i].normal, &m = outlines_[j].normal;
  double sum = 0.0;
  for (int p = 0; p < N; ++p) {
    double row = 0.0;
    for (int q = 0; q < N; ++q) {
      const double x = to.x[q] - from.x[p], y = to.y[q] - from.y[p], z = to.z[q] - from.z[p];
      const double squared = x * x + y * y + z * z;
      const double cosines =
          (n.x() * x + n.y() * y + n.z() * z) * -(m.x() * x + m.y() * y + m.z() * z);
      row += to.weight[q] * cosines / (squared * squared);
    }
    sum += from.weight[p] * row;
  }
  return sum / std::numbers::pi;
}

PairExchange::Bounded PairExchange::bounded(int i, int j) const {
  const PatchOutline &a = outlines_[i], &b = outlines_[j];
  if (!a.is_polygon() || !b.is_polygon()) return {};
  const int sees_j = side(i, j), sees_i = side(j, i);
  if (sees_j < 0 || sees_i < 0) return {};
  const auto by_area = [&](double S) { return Bounded{S, relative_error_ * S}; };
  const double size = a.radius + b.radius;
  const double distance = (a.center - b.center).squaredNorm() / (size * size);
  const bool smooth = sees_j > 0 && sees_i > 0 && patches_[i].has_points && patches_[j].has_points;
  if (smooth && distance > far_from_) {
    return by_area(area_integral(i, j, patches_[i].far, patches_[j].far));
  }
  if (smooth && distance > middle_from_) {
    return by_area(area_integral(i, j, patches_[i].middle, patches_[j].middle));
  }
  constexpr double error = 1e-9;  // polygon_exchange()
  const double S = polygon_exchange(a, b);
  return {S, error * S};
}

}  // namespace lightwell
