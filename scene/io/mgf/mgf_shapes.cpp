#include "scene/io/mgf/mgf_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "scene/io/placed_mesh.h"
#include "scene/io/torus_loops.h"

namespace lightwell {

MgfShape mgf_bubble() {
  MgfShape shape{.loops = sphere_loops(), .is_inward = true};
  shape.normals = shape.loops;  // the corners of a unit sphere about the origin
  return shape;
}

MgfShape mgf_torus(double inner, double outer, bool is_inward) {
  TorusLoops torus = torus_loops(inner, outer);
  return {
      .loops = std::move(torus.loops), .normals = std::move(torus.normals), .is_inward = is_inward};
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
