#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "scene/round_shape.h"
#include "scene/scene.h"

namespace lightwell {

/// Thin panes without roughness, such as windows, which shadow rays cross undeviated. Light of a
/// luminaire through such panes counts as direct light, not as a caustic.
class ClearPanes {
 public:
  explicit ClearPanes(const Scene& scene);

  bool empty() const { return panes_.empty(); }

  /// Transmittance per band from the ray's origin to its t_max or its target group: the product of
  /// what each pane crossed passes at its angle of the light that the panes before it polarised. 0
  /// in all bands where anything but a pane blocks the ray, and behind 64 panes.
  Spectrum passed(const ElementCaster& caster, const Ray& ray) const;

 private:
  struct Pane {
    Material material{};
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // zero for a round shape
    std::optional<RoundShape> round{};
  };
  std::vector<Pane> panes_{};
  std::vector<int> of_facet_{};  // pane of each facet; -1: the facet is no clear pane
  int bands_ = 0;
};

}  // namespace lightwell
