#include "scene/io/mgf/mgf_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "scene/io/placed_mesh.h"

namespace lightwell {

MgfShape mgf_bubble() {
  MgfShape shape{.loops = sphere_loops(), .is_inward = true};
  shape.normals = shape.loops;  // the corners of a unit sphere about the origin
  return shape;
}

MgfShape mgf_torus(double inner, double outer, bool is_inward) {
  constexpr int around = 32, across = 16;
  const double tube = 0.5 * (outer - inner), middle = 0.5 * (outer + inner);
  const auto angle = [](int i, int of) { return 2.0 * std::numbers::pi * (i % of) / of; };
  const auto corner = [&](int i, int k, double radius, double far) {
    const double u = angle(i, around), v = angle(k, across);
    const double r = far + radius * std::cos(v);
    return Eigen::Vector3d(r * std::cos(u), r * std::sin(u), radius * std::sin(v));
  };
  MgfShape shape{.is_inward = is_inward};
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < across; ++k) {
      Loop& loop = shape.loops.emplace_back();
      NormalLoop& of_loop = shape.normals.emplace_back();
      for (const auto& [a, b] : {std::pair{i, k}, {i + 1, k}, {i + 1, k + 1}, {i, k + 1}}) {
        loop.push_back(corner(a, b, tube, middle));
        of_loop.push_back(corner(a, b, 1.0, 0.0));
      }
    }
  }
  return shape;
}

std::optional<MgfShape> mgf_prism(Loop base, double length) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < base.size(); ++i) {
    normal += (base[i] - base[0]).cross(base[i + 1] - base[0]);
  }
  if (!(normal.stableNorm() > 0.0) || length == 0.0) return std::nullopt;
  if (length > 0.0) std::ranges::reverse(base);
  Loop top = base;
  for (Eigen::Vector3d& p : top) p -= length * normal.stableNormalized();
  MgfShape shape{.loops = {Loop(base.rbegin(), base.rend()), top}};
  for (std::size_t i = 0; i < base.size(); ++i) {
    const std::size_t next = (i + 1) % base.size();
    shape.loops.push_back({base[i], base[next], top[next], top[i]});
  }
  return shape;
}

}  // namespace lightwell
