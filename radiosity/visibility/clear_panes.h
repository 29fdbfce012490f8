#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "scene/scene.h"

namespace lightwell {

/// Thin panes without roughness, such as windows, which shadow rays go straight through: light that
/// a lamp sends through them is direct light, as sharp as any, and no caustic.
class ClearPanes {
 public:
  explicit ClearPanes(const Scene& scene);

  bool empty() const { return panes_.empty(); }

  /// The share of light that gets to the ray's t_max, or to its target group, which something is
  /// in the way of: what all panes between pass, (1 - R) tint of each (see smooth_scattering); 0 in
  /// all bands if anything else is.
  Spectrum passed(const ElementCaster& caster, const Ray& ray) const;

 private:
  struct Pane {
    Material material{};
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // zero for a sphere
    Eigen::Vector3d center = Eigen::Vector3d::Zero();  // of a sphere
  };
  std::vector<Pane> panes_{};
  std::vector<int> of_facet_{};  // -1: it is none
  int bands_ = 0;
};

}  // namespace lightwell
