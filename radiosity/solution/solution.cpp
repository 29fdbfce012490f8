#include "radiosity/solution/solution.h"

#include "mesh/patches/pictured_emission.h"
#include "mesh/patches/translucency.h"

namespace lightwell {

EnergyBalance total(const BandEnergy& by_band, const FreeEnergy& free) {
  return {.emitted = by_band.row(0).sum(),
          .absorbed = by_band.row(1).sum(),
          .escaped = by_band.row(2).sum(),
          .unshot = by_band.row(3).sum(),
          .from_lamps = free.size() > 0 ? free.row(0).sum() : 0.0,
          .missed = free.size() > 0 ? free.row(1).sum() : 0.0};
}

Eigen::ArrayXf error_bound(const RadiositySolution& solution) {
  const Eigen::ArrayXf &a = solution.interpolation_error, &b = solution.gather_noise;
  if (a.size() == 0 || a.size() != b.size()) return {};
  return 2.0f * (a.square() + b.square()).sqrt();
}

BandArray vertex_radiosity(const PatchMesh& mesh, const RadiositySolution& solution) {
  BandArray B = scattered_at_vertices(mesh, solution.irradiance());
  B += vertex_emission(mesh);
  return B;
}

BandArray element_mean(const PatchMesh& mesh, const BandArray& vertex_values) {
  BandArray mean = BandArray::Zero(mesh.element_count(), vertex_values.cols());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int count = mesh.corner_count(e);
    for (int c = 0; c < count; ++c) mean.row(e) += vertex_values.row(mesh.corners[e][c]);
    mean.row(e) /= static_cast<float>(count);
  }
  return mean;
}

}  // namespace lightwell
