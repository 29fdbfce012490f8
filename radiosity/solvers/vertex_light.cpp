#include "radiosity/solvers/vertex_light.h"

#include <algorithm>

#include "radiosity/emitters/free_source.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

/// Vertices between two reports of progress; in a room of 30 000 triangles a tenth of a second.
constexpr int slice = 1024;

}  // namespace

VertexLight::VertexLight(const ElementCaster& caster, const DirectLight& direct_light,
                         const Progress& progress)
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
  const int count = mesh_.vertex_count();
  for (int first = 0; first < count; first += slice) {
    report(progress, "lamps", static_cast<double>(first) / count);
    parallel_for(std::min(slice, count - first), grain, [&](int begin, int end) {
      for (int v = first + begin; v < first + end; ++v) {
        const ReceivingPoint& at = points_[static_cast<std::size_t>(v)];
        direct_light.add_irradiance(caster,
                                    {.at = {at.position, at.normal, at.facet},
                                     .key = static_cast<std::uint64_t>(v),
                                     .lights = Lights::free},
                                    irradiance_.row(v).data());
      }
    });
  }
}

void VertexLight::receive(std::span<const ProgressiveRadiosity::Shot> shots,
                          const Progress& progress) {
  const std::span<const ReceivingPoint> points(points_);
  const std::span<double> F(F_);
  std::size_t done = 0;
  for (const auto& shot : shots) {
    // Lamps cast the visible shadows; the light that a single patch reflects is one of very many
    // terms.
    const bool is_lamp = direct_light_.owns(mesh_.facet[mesh_.first_element[shot.patch]],
                                            mesh_.is_back[shot.patch] != 0);
    const PointFormFactorOptions options =
        is_lamp ? PointFormFactorOptions{} : PointFormFactorOptions{.min_rays = 1, .max_rays = 1};
    for (std::size_t first = 0; first < points.size(); first += slice, done += slice) {
      report(progress, "shots",
             static_cast<double>(done) / static_cast<double>(points.size() * shots.size()));
      const std::size_t count = std::min<std::size_t>(slice, points.size() - first);
      form_factors_.by_closed_form(shot.patch, points.subspan(first, count),
                                   F.subspan(first, count), options);
    }
    done = static_cast<std::size_t>(&shot - shots.data() + 1) * points.size();
    for (std::size_t v = 0; v < F_.size(); ++v) {
      if (!(F_[v] > 0.0)) continue;
      irradiance_.row(static_cast<Eigen::Index>(v)) +=
          (shot.radiosity * static_cast<float>(F_[v])).transpose();
    }
  }
}

}  // namespace lightwell
