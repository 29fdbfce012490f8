#include "scene/io/torus_loops.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "scene/io/placed_mesh.h"

namespace lightwell {

TorusLoops torus_loops(double inner, double outer) {
  constexpr int across = 16;
  const double tube = 0.5 * (outer - inner), middle = 0.5 * (outer + inner);
  const auto angle = [](int i, int of) { return 2.0 * std::numbers::pi * (i % of) / of; };
  const auto corner = [&](int i, int k, double radius, double far) {
    const double u = angle(i, round_sides), v = angle(k, across);
    const double r = far + radius * std::cos(v);
    return Eigen::Vector3d(r * std::cos(u), r * std::sin(u), radius * std::sin(v));
  };
  TorusLoops torus;
  for (int i = 0; i < round_sides; ++i) {
    for (int k = 0; k < across; ++k) {
      Loop& loop = torus.loops.emplace_back();
      NormalLoop& of_loop = torus.normals.emplace_back();
      for (const auto& [a, b] : {std::pair{i, k}, {i + 1, k}, {i + 1, k + 1}, {i, k + 1}}) {
        loop.push_back(corner(a, b, tube, middle));
        of_loop.push_back(corner(a, b, 1.0, 0.0));
      }
    }
  }
  return torus;
}

}  // namespace lightwell
