#include "radiosity/solvers/vertex_light.h"

#include "scene/parallel.h"

namespace lightwell {

VertexLight::VertexLight(const ElementCaster& caster, const DirectLight& direct_light)
    : mesh_(caster.mesh()),
      direct_light_(direct_light),
      form_factors_(caster),
      points_(static_cast<std::size_t>(mesh_.vertex_count())),
      F_(points_.size()),
      irradiance_(BandArray::Zero(mesh_.vertex_count(), direct_light.column_count())) {
  for (int e = 0; e < mesh_.element_count(); ++e) {
    for (int c = 0; c < mesh_.corner_count(e); ++c) {
      points_[static_cast<std::size_t>(mesh_.corners[e][c])] = receiving_corner(mesh_, e, c);
    }
  }
  if (direct_light.free_sources().empty()) return;
  constexpr int grain = 64;
  parallel_for(mesh_.vertex_count(), grain, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      const ReceivingPoint& at = points_[static_cast<std::size_t>(v)];
      direct_light.add_irradiance(caster,
                                  {.at = {at.position, at.normal, at.facet},
                                   .key = static_cast<std::uint64_t>(v),
                                   .lights = Lights::free},
                                  irradiance_.row(v).data());
    }
  });
}

void VertexLight::receive(std::span<const ProgressiveRadiosity::Shot> shots) {
  for (const auto& shot : shots) {
    // Lamps cast the visible shadows; the light that a single patch reflects is one of very many
    // terms.
    const bool is_lamp = direct_light_.owns(mesh_.facet[mesh_.first_element[shot.patch]],
                                            mesh_.is_back[shot.patch] != 0);
    form_factors_.by_closed_form(
        shot.patch, points_, F_,
        is_lamp ? PointFormFactorOptions{} : PointFormFactorOptions{.min_rays = 1, .max_rays = 1});
    for (std::size_t v = 0; v < F_.size(); ++v) {
      if (!(F_[v] > 0.0)) continue;
      irradiance_.row(static_cast<Eigen::Index>(v)) +=
          (shot.radiosity * static_cast<float>(F_[v])).transpose();
    }
  }
}

}  // namespace lightwell
